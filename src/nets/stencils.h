#pragma once

#include "core/groups.h"
#include "nets/net.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// Which vertices speak for the fairness of the surface at each vertex: its neighbours; on a curve, where other than
/// two labels meet or the surface reaches the image's box, those on the curve.
class Stencils {
 public:
  Stencils(const Net& net, const Groups<>& quads_at);

  std::size_t size() const { return first_.size() - 1; }
  /// Whether the vertex is on an edge of more than two quads, or one where the surface reaches the box.
  bool is_on_curve_edge(VertexIndex v) const { return curve_edges_[v] > 0; }
  /// Whether it is on a curve: a lone such edge is one in which a surface touches itself.
  bool is_on_curve(VertexIndex v) const { return curve_edges_[v] > 1; }

  /// The mean of the stencil less the vertex itself.
  Vec3 difference(std::span<const Vec3> x, VertexIndex v) const {
    Vec3 sum;
    for (const Link& l : links(v))
      if (counts(v, l)) sum += x[l.to];
    return sum * weight_[v] - x[v];
  }
  /// What the differences r make of a vertex: the transposed of the above.
  Vec3 transposed(std::span<const Vec3> r, VertexIndex v) const {
    Vec3 sum;
    for (const Link& l : links(v))
      if (counts(l.to, l)) sum += r[l.to] * weight_[l.to];
    return sum - r[v];
  }

 private:
  struct Link {
    VertexIndex to : 31;
    VertexIndex is_curve : 1;
  };
  std::span<const Link> links(VertexIndex v) const {
    return {links_.data() + first_[v], links_.data() + first_[v + 1]};
  }
  bool counts(VertexIndex of, const Link& l) const { return !is_on_curve(of) || l.is_curve != 0; }
  static void collect(const Net& net, const Groups<>& quads_at, VertexIndex v, std::vector<Link>& links);

  std::vector<std::uint32_t> first_;
  std::vector<Link> links_;
  std::vector<std::uint8_t> curve_edges_;  ///< how many, per vertex
  std::vector<double> weight_;             ///< one over the size of the stencil
};

}  // namespace octafront::nets
