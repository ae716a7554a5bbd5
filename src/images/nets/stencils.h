#pragma once

#include "base/core/groups.h"
#include "images/nets/net.h"

#include <array>
#include <span>

namespace octafront::nets {

/// Which vertices speak for the fairness of the surface at each vertex: its neighbours; on a curve, where other than
/// two labels meet or the surface reaches the image's box, those on the curve.
class Stencils {
 public:
  Stencils(const Net& net, const Groups<>& quads_at);

  /// The mean of the stencil less the vertex itself.
  Vec3 difference(std::span<const Vec3> x, VertexIndex v) const {
    Vec3 sum;
    for (const VertexIndex to : own_[v]) sum += x[to];
    return sum * kWeights[own_[v].size()] - x[v];
  }
  /// The stencil of a vertex.
  std::span<const VertexIndex> of(VertexIndex v) const { return own_[v]; }
  /// Those in whose stencils it is: in the order of its stencil if they are the same.
  std::span<const VertexIndex> users(VertexIndex v) const { return users_[v]; }

 private:
  /// By the size of a stencil: two for each of twelve quads at most.
  static constexpr auto kWeights = [] {
    std::array<double, 25> weights{};
    for (int k = 1; k < 25; ++k) weights[k] = 1.0 / k;
    return weights;
  }();

  Groups<VertexIndex> own_;    ///< the stencil of each vertex
  Groups<VertexIndex> users_;  ///< those in whose stencils it is
};

}  // namespace octafront::nets
