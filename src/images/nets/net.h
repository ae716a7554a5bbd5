#pragma once

#include <octafront/ids.h>

#include "base/core/groups.h"
#include "images/nets/lattice.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront::nets {

/// A face between two voxels. Its vertices run counter-clockwise as seen from the upper voxel.
struct Quad {
  std::array<VertexIndex, 4> v;
  Label lower, upper;    ///< labels of the voxels on its two sides
  std::uint8_t axis;     ///< it lies across this axis
  std::uint8_t box = 0;  ///< 1 ... 6: the side of the image's box on which it lies; 0: none
  bool turned = false;   ///< its diagonal runs from v[1] to v[3], else from v[0] to v[2]
};

/// The faces between voxels of different labels. Vertices lie at corners of voxels; where surfaces pass a corner
/// without touching there each has a vertex of its own, drawn a little towards its faces.
struct Net {
  std::vector<Corner> corner;  ///< per vertex
  std::vector<Vec3> start;     ///< per vertex: where it lies before smoothing; straight space
  std::vector<Quad> quads;     ///< in order of their least corners
  /// Per vertex: whether others lie at its corner.
  std::vector<std::uint8_t> shares_corner;
};

/// REQUIRES a lattice with labels. Cost: some nanoseconds a voxel, .2 microseconds a vertex, on one thread.
Net make_net(const Lattice& lattice);

/// The two triangles of a quad, facing the upper voxel.
inline std::array<Triangle, 2> triangles_of(const Quad& q) {
  const auto& v = q.v;
  if (q.turned) return {{{v[1], v[2], v[3]}, {v[3], v[0], v[1]}}};
  return {{{v[0], v[1], v[2]}, {v[2], v[3], v[0]}}};
}

/// The quads at each vertex.
Groups<> quads_at_vertices(const Net& net);

}  // namespace octafront::nets
