#include <octafront/quality.h>

#include "geometry/measures.h"

#include <numbers>
#include <vector>

#include <oneapi/tbb/parallel_for.h>

namespace octafront {

namespace {

// Corners seen from a in units of the longest edge, so that no power of a length overflows or underflows.
std::array<Vec3, 4> normalized_corners(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  std::array<Vec3, 4> q{Vec3{}, b - a, c - a, d - a};
  double size = 0;
  for (const Vec3& v : q) size = std::max({size, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (size > 0)
    for (Vec3& v : q) v = v / size;
  return q;
}

// Angles from one determinant and the products of face normals: atan2 keeps the digits of needles and slivers.
std::array<double, 6> angles_of(const std::array<Vec3, 4>& q) {
  const Vec3 u = q[1] - q[0], v = q[2] - q[0], w = q[3] - q[0];
  const Vec3 nb = cross(v, w), nc = cross(w, u), nd = cross(u, v), na = -(nb + nc + nd);
  const double det = std::abs(dot(u, nb));
  const auto angle = [&](Vec3 edge, Vec3 m, Vec3 n) {
    return std::atan2(length(edge) * det, -dot(m, n)) * (180 / std::numbers::pi);
  };
  return {angle(u, nc, nd),     angle(v, nb, nd),     angle(w, nb, nc),
          angle(v - u, na, nd), angle(w - u, na, nc), angle(w - v, na, nb)};
}

void add_tet(QualitySummary& s, TetIndex tet, const std::array<Vec3, 4>& q) {
  const double beta = std::min(1.0, tet_radius_ratio(q[0], q[1], q[2], q[3]));
  ++s.elements;
  s.beta_mean += beta;
  ++s.beta_classes[static_cast<std::size_t>(std::clamp(static_cast<int>(beta * 5), 0, 4))];
  if (s.beta_min_tet == kNone || beta < s.beta_min) {
    s.beta_min = beta;
    s.beta_min_tet = tet;
  }
  for (const double angle : angles_of(q)) {
    s.dihedral_min = std::min(s.dihedral_min, angle);
    s.dihedral_max = std::max(s.dihedral_max, angle);
    ++s.dihedral_histogram[static_cast<std::size_t>(std::clamp(static_cast<int>(angle / 10), 0, 17))];
  }
}

// beta_mean holds the sum until the end; `part` follows `whole` in the order of elements.
void add_summary(QualitySummary& whole, const QualitySummary& part) {
  whole.elements += part.elements;
  whole.beta_mean += part.beta_mean;
  for (std::size_t i = 0; i < whole.beta_classes.size(); ++i) whole.beta_classes[i] += part.beta_classes[i];
  for (std::size_t i = 0; i < whole.dihedral_histogram.size(); ++i)
    whole.dihedral_histogram[i] += part.dihedral_histogram[i];
  if (whole.beta_min_tet == kNone || part.beta_min < whole.beta_min) {
    whole.beta_min = part.beta_min;
    whole.beta_min_tet = part.beta_min_tet;
  }
  whole.dihedral_min = std::min(whole.dihedral_min, part.dihedral_min);
  whole.dihedral_max = std::max(whole.dihedral_max, part.dihedral_max);
}

QualitySummary empty_summary() {
  QualitySummary s;
  s.dihedral_min = 180;
  return s;
}

}  // namespace

double radius_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto q = normalized_corners(a, b, c, d);
  return std::clamp(tet_radius_ratio(q[0], q[1], q[2], q[3]), -1.0, 1.0);
}

double radius_ratio(Vec3 a, Vec3 b, Vec3 c) {
  const auto q = normalized_corners(a, b, c, a);
  return std::min(1.0, triangle_radius_ratio(q[0], q[1], q[2]));
}

std::array<double, 6> dihedral_angles(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return angles_of(normalized_corners(a, b, c, d));
}

QualitySummary summarize_quality(const TetMesh& mesh) {
  // Blocks of fixed size, added in order: the sums do not depend on the number of threads.
  constexpr std::size_t kBlock = 8192;
  const std::size_t n = mesh.tets.size();
  if (n == 0) return {};
  std::vector<QualitySummary> parts((n + kBlock - 1) / kBlock, empty_summary());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t block) {
    for (std::size_t t = block * kBlock; t < std::min(n, (block + 1) * kBlock); ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      const auto& p = mesh.points;
      add_tet(parts[block], static_cast<TetIndex>(t), normalized_corners(p[a], p[b], p[c], p[d]));
    }
  });
  QualitySummary whole = empty_summary();
  for (const QualitySummary& part : parts) add_summary(whole, part);
  whole.beta_mean /= static_cast<double>(n);
  return whole;
}

}  // namespace octafront
