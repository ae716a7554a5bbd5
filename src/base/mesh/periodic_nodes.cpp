#include "base/mesh/periodic_nodes.h"

#include <algorithm>

namespace octafront {

namespace {

/// Nodes that a rotation moves by less than this part of their coordinates lie on its axis.
constexpr double kStays = 1e-9;

bool is_own_copy(const TetMesh& mesh, std::uint32_t period, VertexIndex v) {
  if (mesh.period_rotations.empty()) return false;
  const Vec3 p = mesh.points[v];
  return distance(led_by_period(mesh, period, p), p) <= kStays * std::max(length(p), length(mesh.periods[period]));
}

}  // namespace

Vec3 turned_by_period(const TetMesh& mesh, std::uint32_t period, Vec3 v) {
  if (mesh.period_rotations.empty()) return v;
  const auto& r = mesh.period_rotations[period];
  return {dot(r[0], v), dot(r[1], v), dot(r[2], v)};
}

Vec3 led_by_period(const TetMesh& mesh, std::uint32_t period, Vec3 p) {
  return turned_by_period(mesh, period, p) + mesh.periods[period];
}

Originals::Originals(const TetMesh& mesh) : mesh_(mesh), original_(mesh.periods.size()) {
  for (const auto& [period, copy, original] : mesh.periodic_nodes) original_[period][copy] = original;
}

VertexIndex Originals::of(std::uint32_t period, VertexIndex v) const {
  if (const auto at = original_[period].find(v); at != original_[period].end()) return at->second;
  return is_own_copy(mesh_, period, v) ? v : kNone;
}

std::optional<Triangle> Originals::of(std::uint32_t period, const Triangle& face) const {
  Triangle original{};
  for (std::size_t i = 0; i < 3; ++i)
    if ((original[i] = of(period, face[i])) == kNone) return std::nullopt;
  return original == face ? std::nullopt : std::optional(original);
}

}  // namespace octafront
