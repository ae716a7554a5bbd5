#pragma once

#include <octafront/tet_mesh.h>

#include "base/mesh/adjacency.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace octafront::dual {

/// A cell of boundary layers: a wedge, or what is left of one where columns have ended (a pyramid, a tetrahedron).
struct LayerCell {
  Triangle bottom{}, top{};  ///< top[i] stands over bottom[i]; where that column has ended they are the same
  TetIndex first = 0;        ///< of its tetrahedra
  HalfFace floor = kNone, ceiling = kNone;

  bool is_ended(std::size_t i) const { return bottom[i] == top[i]; }
  /// Whether an edge is on its top, over another one below.
  bool has_on_top(VertexIndex a, VertexIndex b) const {
    int on_top = 0, ended = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (top[i] == a || top[i] == b) ++on_top, ended += is_ended(i);
    return on_top == 2 && ended < 2;
  }
};

/// The cells of boundary layers, by tetrahedron. Wedges tell which edges are upright; pyramids and tetrahedra that have
/// such an edge follow. A mesh whose wedges stand against each other has none: nobody knows which way is up.
class LayerCells {
 public:
  explicit LayerCells(const TetMesh& mesh);

  /// Null: it is part of none.
  const LayerCell* of(TetIndex t) const {
    return of_tet_.empty() || of_tet_[t] == kNone ? nullptr : &cells_[of_tet_[t]];
  }
  /// The face that the lowest layer below it stands on.
  HalfFace ground_of(std::span<const HalfFace> across, const LayerCell& cell) const;
  bool is_upright(VertexIndex lower, VertexIndex upper) const;
  /// From each vertex of a column to the one above it, sorted.
  std::span<const Edge> uprights() const { return uprights_; }
  /// Of a half-face that stands: where it ends above, an edge.
  std::optional<Edge> top_of_side(std::span<const Tet> tets, HalfFace h) const;

 private:
  void add_uprights(const TetMesh& mesh);
  bool add(const TetMesh& mesh, LayerCell cell, std::uint32_t tets);
  LayerCell of_wide(const WideCell& cell) const;

  std::vector<Edge> uprights_;  ///< lower and upper end, sorted
  std::vector<LayerCell> cells_;
  std::vector<std::uint32_t> of_tet_;
};

}  // namespace octafront::dual
