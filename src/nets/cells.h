#pragma once

#include "nets/net.h"

#include <span>
#include <vector>

namespace octafront::nets {

/// How much room a vertex has: a box around its corner, up to the middles of the voxels there, flat on the image's box.
/// Less at labels of few voxels, which smoothing would pull together to points.
class VertexCells {
 public:
  /// `voxels`: of each label.
  VertexCells(const Lattice& lattice, const Net& net, std::span<const std::uint64_t> voxels);

  Vec3 clamped(VertexIndex v, Vec3 p) const;

 private:
  const Lattice& lattice_;
  const Net& net_;
  std::vector<float> share_;  ///< of the room to the middles of voxels
};

}  // namespace octafront::nets
