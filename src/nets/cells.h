#pragma once

#include "nets/net.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// How much room a vertex has: a box around its corner, up to the middles of the voxels there, flat on the image's box.
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
  void keep_layers_apart(VertexIndex v);

  double farthest_;  ///< from the corner, in voxels
  const Lattice& lattice_;
  const Net& net_;
  /// Per axis, wall and side, lower ones first: a half over the signed way to the middles of the voxels there.
  std::array<std::vector<std::array<double, 2>>, 3> half_over_room_;
  /// Per vertex, axis and side, lower ones first: part of the way to the middles of the voxels there.
  std::vector<std::array<std::array<float, 2>, 3>> share_;
};

}  // namespace octafront::nets
