#include "base/mesh/quality_batch.h"

#include "base/core/vector_units.h"
#include "base/geometry/measures.h"
#include "base/mesh/dihedral.h"

#include <cmath>

namespace octafront {
namespace {

OCTAFRONT_KERNEL double largest_of(Vec3 v) {
  return greater(greater(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

struct Edges {
  Vec3 u, v, w;
};

OCTAFRONT_KERNEL Vec3 from_first(const QualityBatch& b, int k, int i) {
  return {b.corner[k][0][i] - b.corner[0][0][i], b.corner[k][1][i] - b.corner[0][1][i],
          b.corner[k][2][i] - b.corner[0][2][i]};
}

/// In units of the largest coordinate, so that no power of a length overflows or underflows.
OCTAFRONT_KERNEL Edges edges_of(const QualityBatch& b, int i) {
  const Vec3 u = from_first(b, 1, i), v = from_first(b, 2, i), w = from_first(b, 3, i);
  const double size = greater(greater(largest_of(u), largest_of(v)), largest_of(w)), by = size > 0 ? size : 1;
  return {u / by, v / by, w / by};
}

/// Grows with the angle, and needs one division.
OCTAFRONT_KERNEL std::int32_t step_of(const AngleDirection& angle) {
  constexpr double kMost = QualityBatch::kSteps;
  const double step = (1 - angle.x / (std::abs(angle.x) + angle.y)) * (0.5 * kMost);
  return static_cast<std::int32_t>(step < kMost ? step : kMost);
}

OCTAFRONT_KERNEL void put_beta_and_angles(QualityBatch& b, int i) {
  const auto [u, v, w] = edges_of(b, i);
  b.beta[i] = tet_radius_ratio(Vec3{}, u, v, w);
  const auto angles = dihedral_directions(u, v, w);
  for (int e = 0; e < 6; ++e) {
    b.x[e][i] = angles[e].x;
    b.y[e][i] = angles[e].y;
    b.step[e][i] = step_of(angles[e]);
  }
}

OCTAFRONT_KERNEL void evaluate_all(QualityBatch& b) {
  for (int i = 0; i < QualityBatch::kSize; ++i) put_beta_and_angles(b, i);
}

void evaluate_plain(QualityBatch& b) {
  evaluate_all(b);
}

#ifdef OCTAFRONT_HAS_AVX2_KERNELS
__attribute__((target("avx2"))) void evaluate_avx2(QualityBatch& b) {
  evaluate_all(b);
}

const auto evaluate_best = has_avx2() ? evaluate_avx2 : evaluate_plain;
#else
const auto evaluate_best = evaluate_plain;
#endif

}  // namespace

void QualityBatch::evaluate() {
  evaluate_best(*this);
}

}  // namespace octafront
