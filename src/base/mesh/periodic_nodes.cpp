#include "base/mesh/periodic_nodes.h"

#include <algorithm>

namespace octafront {

namespace {

/// Nodes that a rotation moves by less than this part of their coordinates lie on its axis.
constexpr double kStays = 1e-9;

}  // namespace

Vec3 led_by_period(const TetMesh& mesh, std::uint32_t period, Vec3 p) {
  const Vec3 t = mesh.periods[period];
  if (mesh.period_rotations.empty()) return p + t;
  const auto& r = mesh.period_rotations[period];
  return Vec3{dot(r[0], p), dot(r[1], p), dot(r[2], p)} + t;
}

bool is_own_copy(const TetMesh& mesh, std::uint32_t period, VertexIndex v) {
  if (mesh.period_rotations.empty()) return false;
  const Vec3 p = mesh.points[v];
  return distance(led_by_period(mesh, period, p), p) <= kStays * std::max(length(p), length(mesh.periods[period]));
}

}  // namespace octafront
