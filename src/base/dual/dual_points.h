#pragma once

#include "base/dual/dual_cells.h"
#include "base/dual/primal.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace octafront::dual {

/// What becomes of the middle of an edge.
enum class Middle : std::uint8_t {
  kLeftOut,  ///< faces go straight past it
  kPassed,   ///< faces go through it
  kCorner    ///< faces end there
};

/// The points of the dual, numbered: in tetrahedra, on faces at which cells end, on edges, and vertices. In layers they
/// move up: the point of a wedge is that of the triangle on its top, the one of a side of it that of the edge there.
class DualPoints {
 public:
  DualPoints(const Primal& primal, const DualCells& cells);

  std::uint32_t of_tet(TetIndex t) const;
  std::uint32_t of_face(HalfFace h) const;
  std::uint32_t of_edge(VertexIndex a, VertexIndex b) const;
  std::uint32_t of_vertex(VertexIndex v) const { return first_vertex() + v; }
  std::uint32_t size() const { return first_vertex() + static_cast<std::uint32_t>(primal_.mesh.points.size()); }
  Vec3 place(std::uint32_t point) const;
  bool is_movable(std::uint32_t point) const { return point < first_edge(); }
  /// Puts a point in the middle of its tetrahedron or face, where no face between two cells is turned over.
  void centre(std::uint32_t point) { is_centred_[point] = true; }

  Middle middle(VertexIndex a, VertexIndex b) const;
  /// Where a side of layers ends above; nullopt of other faces.
  std::optional<Edge> top_of(HalfFace h) const;

 private:
  struct MarkedEdge {
    Edge edge;
    Middle middle;

    friend bool operator<(const MarkedEdge& a, const MarkedEdge& b) { return a.edge < b.edge; }
  };

  std::uint32_t first_face() const { return static_cast<std::uint32_t>(primal_.mesh.tets.size()); }
  std::uint32_t first_edge() const { return first_face() + static_cast<std::uint32_t>(faces_.size()); }
  std::uint32_t first_vertex() const { return first_edge() + static_cast<std::uint32_t>(edges_.size()); }
  void find_edges();
  void find_faces();
  bool is_ceiling(HalfFace h) const;
  const MarkedEdge* find(VertexIndex a, VertexIndex b) const;
  Vec3 place_in(TetIndex t) const;

  const Primal& primal_;
  const DualCells& cells_;
  std::vector<HalfFace> faces_;    ///< with a point of their own, by their lower side; ascending
  std::vector<MarkedEdge> edges_;  ///< that have a point, or are passed; ascending
  std::vector<bool> is_centred_;   ///< per point
};

}  // namespace octafront::dual
