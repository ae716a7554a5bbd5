
#include "images/nets/conflicts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace octafront::nets {

namespace {

// In voxels. An error of a coordinate changes a product of three differences, none above 3, by less than a hundred
// times of it; six of them are a volume.
constexpr double kMostError = 1e-9, kMargin = 1e-6, kLeastVolume = 1e-5;

/// Bounds how far a vertex in the world may lie from where it is in straight space, in `unit` along each axis.
double rounding_of_world(const Lattice& lattice, Vec3 unit) {
  const ImageGrid& grid = lattice.grid();
  const auto& axes = grid.axes;
  double far = length(grid.origin), growth = 0;
  const double volume = std::abs(dot(cross(axes[0], axes[1]), axes[2]));
  for (int a = 0; a < 3; ++a) {
    far += std::max(std::abs(lattice.wall(a, 0)), std::abs(lattice.wall(a, lattice.size(a)))) + unit[a];
    // From the world to indices, and from these to units.
    const double to_index = length(cross(axes[(a + 1) % 3], axes[(a + 2) % 3])) / volume;
    growth = std::max(growth, to_index * length(axes[a]) / unit[a]);
  }
  constexpr double kRoundings = 16;  // of multiplying, adding up, and the divisions before
  return kRoundings * std::numeric_limits<double>::epsilon() * far * growth;
}

}  // namespace

Shelters::Shelters(const Net& net, const Lattice& lattice, std::span<const Vec3> x)
    : net_(net), lattice_(lattice), x_(x) {
  for (int a = 0; a < 3; ++a)
    for (std::int32_t i = 0; i <= lattice.size(a); ++i)
      unit_[a] = std::max(unit_[a], lattice.middle(a, i) - lattice.middle(a, i - 1));
  const bool is_certain = rounding_of_world(lattice, unit_) < kMostError;
  least_ = is_certain ? kLeastVolume * unit_.x * unit_.y * unit_.z : HUGE_VAL;
}

bool Shelters::holds(std::uint32_t quad) const {
  const Quad& q = net_.quads[quad];
  for (const VertexIndex v : q.v)
    if (!is_home(v)) return false;
  const Corner voxel = net_.corner[q.v[0]];
  Corner lower = voxel;
  --lower[q.axis];
  const Vec3 below = lattice_.middle_of(lower), above = lattice_.middle_of(voxel);
  for (const Triangle& t : triangles_of(q)) {
    const Vec3 a = x_[t[0]], normal = cross(x_[t[1]] - a, x_[t[2]] - a);
    if (!(dot(above - a, normal) > least_ && dot(a - below, normal) > least_)) return false;
  }
  return true;
}

/// Alone in its cell, strictly within.
bool Shelters::is_home(VertexIndex v) const {
  if (net_.shares_corner[v] != 0) return false;
  const Corner& c = net_.corner[v];
  for (int a = 0; a < 3; ++a) {
    const double margin = kMargin * unit_[a], at = x_[v][a];
    if (!(at > lattice_.middle(a, c[a] - 1) + margin && at < lattice_.middle(a, c[a]) - margin)) return false;
  }
  return true;
}

}  // namespace octafront::nets
