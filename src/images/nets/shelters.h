#pragma once

#include "images/nets/net.h"

#include <cstdint>
#include <span>

namespace octafront::nets {

/// Which quads certainly cross no other of these, so that exact tests are left to the rest.
///
/// Each corner's cell, the box between the middles of its eight voxels, has one vertex strictly within. The way between
/// the vertices of two cells side by side passes the face between them, since both cells together are convex. So the
/// four tetrahedra of the middles of two voxels and a side of the quad between these, for all quads, have no inner
/// point in common. A quad whose two triangles have both middles strictly on their right sides lies within its own four
/// tetrahedra, and touches their surface in its sides only (T. Ju, T. Udeshi, "Intersection-Free Contouring on an
/// Octree Grid", 2006). All of that for the vertices in the world too, which rounding puts a little elsewhere.
class Shelters {
 public:
  /// `x`: where the vertices are; straight space.
  Shelters(const Net& net, const Lattice& lattice, std::span<const Vec3> x);

  bool holds(std::uint32_t quad) const;

 private:
  bool is_home(VertexIndex v) const;

  const Net& net_;
  const Lattice& lattice_;
  std::span<const Vec3> x_;
  Vec3 unit_;     ///< the longest voxel along each axis
  double least_;  ///< six times the volume of a tetrahedron whose sign rounding does not change
};

}  // namespace octafront::nets
