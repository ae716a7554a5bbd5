#pragma once

#include "images/nets/net.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// How much room a vertex has: a box around its corner, up to the middles of the voxels there, flat on the image's box
/// and that of a cell.
/// Less at labels of few voxels, which smoothing would pull together to points, and toward voxels that are a layer by
/// themselves, whose two sides would come together.
class VertexCells {
 public:
  /// Of labels: without the corners of the boxes, which are middles of voxels. `voxels`: of each label.
  VertexCells(const Lattice& lattice, const Net& net, std::span<const std::uint64_t> voxels);
  /// Of grey values, which say where between middles the surface is.
  VertexCells(const Lattice& lattice, const Net& net);

  Vec3 clamped(VertexIndex v, Vec3 p) const;

 private:
  /// A wall between voxels, and the signed ways to the middles of those below and above.
  struct Wall {
    double at, to_below, to_above;
    double half_over_below, half_over_above;  ///< a half over each way
  };
  void keep_layers_apart(const Lattice& lattice, VertexIndex v);

  double farthest_;  ///< from the corner, in voxels
  const Net& net_;
  std::array<std::vector<Wall>, 3> walls_;  ///< per axis
  /// Per vertex, axis and side, lower ones first: part of the way to the middles of the voxels there.
  std::vector<std::array<std::array<float, 2>, 3>> share_;
};

}  // namespace octafront::nets
