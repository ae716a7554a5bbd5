#pragma once

#include <octafront/tet_mesh.h>

#include "base/geometry/tet_lattice.h"
#include "base/mesh/edge_table.h"
#include "improve/curved/mid_nodes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace octafront::curved {

/// How much each node inside an edge counts at a place where the barycentric coordinates of its ends are `low` and
/// `high`: low * high times the polynomial of high - low that is 1 / (low * high) at this node and 0 at the others.
std::array<double, 3> shares_of_edge(int order, double low, double high);

/// The same of the nodes inside a face: the product of its corners' coordinates, times a linear polynomial at order 4.
std::array<double, 3> shares_of_face(int order, const std::array<double, 3>& corners);

inline constexpr std::array<double, 3> kMiddleOfFace{1.0 / 3, 1.0 / 3, 1.0 / 3};

/// Which nodes of a mesh of order 3 or 4 the edges, faces and elements have, and how far they lie off straight ones.
class NumberedNodes {
 public:
  /// Makes a linear mesh one of this order, whose new nodes have no places yet.
  NumberedNodes(TetMesh& mesh, int order);

  int order() const { return order_; }
  const TetMesh& mesh() const { return mesh_; }
  const TetEdges& edges() const { return edges_; }
  const TetFaces& faces() const { return faces_; }
  const std::array<std::uint32_t, 6>& edges_of_tet(TetIndex t) const { return edge_of_[t]; }
  const std::array<std::uint32_t, 4>& faces_of_tet(TetIndex t) const { return faces_.of_tet[t]; }
  Edge edge(std::uint32_t e) const { return {edges_.low[e], edges_.high[e]}; }

  std::size_t corners() const { return corners_; }
  VertexIndex node_in_edge(std::uint32_t e, std::size_t k) const {
    return static_cast<VertexIndex>(corners_ + e * nodes_in_edge(order_) + k);
  }
  VertexIndex node_in_face(std::uint32_t f, std::size_t k) const {
    return static_cast<VertexIndex>(first_in_face_ + f * nodes_in_face(order_) + k);
  }
  VertexIndex node_in_tet(TetIndex t, std::size_t k) const {
    return static_cast<VertexIndex>(first_in_tet_ + t * nodes_in_tet(order_) + k);
  }

  /// Per point, those behind corners that lie on the boundary or an interface.
  std::vector<char> is_on_wall() const;

  /// What along(edge, i, j, low, high) says of the edges of a face, from its corner i to j, at a place of it, summed.
  template <class Along>
  Vec3 by_edges(std::uint32_t f, const std::array<double, 3>& at, const Along& along) const {
    const Triangle& c = faces_.corners[f];
    Vec3 sum;
    for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}})
      sum += along(edges_.find(c[i], c[j]), i, j, at[i], at[j]);
    return sum;
  }

  /// How far an edge and the middle of a face lie off straight ones; of the face but for what its edges do.
  Vec3 off_edge(std::uint32_t e, std::size_t k) const;
  Vec3 off_along(std::uint32_t e, double low, double high) const;
  Vec3 off_by_edges(std::uint32_t f, const std::array<double, 3>& at) const;
  Vec3 off_middle(std::uint32_t f) const;

 protected:
  TetMesh& mesh_;

 private:
  void number_nodes();

  int order_;
  std::size_t corners_, first_in_face_ = 0, first_in_tet_ = 0;
  TetFaces faces_;
  std::vector<std::array<std::uint32_t, 6>> edge_of_;  ///< per tet
  TetEdges edges_;
};

}  // namespace octafront::curved
