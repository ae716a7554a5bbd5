#include "base/mesh/quality_batch.h"

#include <cmath>
#include <limits>

// Arithmetic without branches, compiled once for each width of vector unit and chosen at run time.

namespace octafront {
namespace {

#if defined(__GNUC__)
#define OCTAFRONT_KERNEL inline __attribute__((always_inline))
#else
#define OCTAFRONT_KERNEL inline
#endif

OCTAFRONT_KERNEL double greater(double a, double b) {
  return a > b ? a : b;
}
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

/// Angles from one determinant and the products of face normals: y over x keeps the digits of needles and slivers.
OCTAFRONT_KERNEL void put_angle(QualityBatch& b, int e, int i, Vec3 edge, Vec3 m, Vec3 n, double det) {
  const double x = -dot(m, n), y = length(edge) * det;
  const double sum = std::abs(x) + y;
  const bool is_flat = sum == 0;
  b.x[e][i] = is_flat ? 1 : x;
  b.y[e][i] = y;
  // Grows with the angle, and needs one division.
  constexpr double kMost = QualityBatch::kSteps;
  const double step = (1 - b.x[e][i] / (is_flat ? 1 : sum)) * (0.5 * kMost);
  b.step[e][i] = static_cast<std::int32_t>(step < kMost ? step : kMost);
}

OCTAFRONT_KERNEL void put_beta_and_angles(QualityBatch& b, int i) {
  const auto [u, v, w] = edges_of(b, i);
  const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v), all = vw + wu + uv, na = -all;
  const double det = dot(u, vw), flatness = std::abs(det);
  const double areas = length(vw) + length(wu) + length(uv) + length(all);
  const double radius = length(squared_length(u) * vw + squared_length(v) * wu + squared_length(w) * uv);
  b.beta[i] = 6 * det * flatness / (areas * radius + std::numeric_limits<double>::min());
  put_angle(b, 0, i, u, wu, uv, flatness);
  put_angle(b, 1, i, v, vw, uv, flatness);
  put_angle(b, 2, i, w, vw, wu, flatness);
  put_angle(b, 3, i, v - u, na, uv, flatness);
  put_angle(b, 4, i, w - u, na, wu, flatness);
  put_angle(b, 5, i, w - v, na, vw, flatness);
}

OCTAFRONT_KERNEL void evaluate_all(QualityBatch& b) {
  for (int i = 0; i < QualityBatch::kSize; ++i) put_beta_and_angles(b, i);
}

void evaluate_plain(QualityBatch& b) {
  evaluate_all(b);
}

#if defined(__x86_64__) && defined(__GNUC__)
__attribute__((target("avx2"))) void evaluate_avx2(QualityBatch& b) {
  evaluate_all(b);
}

bool has_avx2() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2");
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
