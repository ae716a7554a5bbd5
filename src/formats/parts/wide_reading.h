#pragma once

#include "formats/parts/raw_mesh.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace octafront::io {

/// Divides quadrilaterals as the wedges, pyramids and hexahedra of the mesh are, from their lowest node; without any
/// they stay as they are, and are forgotten.
void divide_like_wide_cells(RawMesh& raw);

/// Mid-side nodes for the diagonals of wedges and pyramids of second order, which files have not: in the middle, moved
/// as far as the middle of the face is by the mid-side nodes around it.
void add_diagonals(RawMesh& raw);

void renumber_wide(RawMesh& raw, const std::vector<VertexIndex>& number);

/// Mirrors cells all of whose tetrahedra were turned, and returns how many. If all wedges were, but not all of the
/// mesh, that is what their file calls a wedge: their tetrahedra count as turned no more, and `wedges` is how many they
/// are.
std::size_t turn_wide_cells(std::vector<WideCell>& cells, std::vector<bool>& is_turned, std::size_t& wedges);

/// The quadrilaterals of the wedges and pyramids of a mesh, by their corners.
class SidesOfWideCells {
 public:
  explicit SidesOfWideCells(const TetMesh& mesh);

  /// The same nodes from the same first one, counter-clockwise seen from outside of their cell; empty if they are no
  /// side of one.
  std::optional<std::array<VertexIndex, 4>> outward(const std::array<VertexIndex, 4>& nodes) const;
  /// The quadrilateral that a triangle is half of, if `other_half` finds one.
  std::array<VertexIndex, 4> around(const Triangle& half) const;
  /// The place of the triangle that makes up a quadrilateral with number f; `faces` are sorted by their sorted corners.
  /// Without one the number of faces.
  std::size_t other_half(const std::vector<Triangle>& faces, std::size_t f) const;

 private:
  using Quad = std::array<VertexIndex, 4>;
  std::vector<std::pair<Quad, Quad>> sides_;       ///< corners sorted, and in order
  std::vector<std::pair<Triangle, Quad>> halves_;  ///< corners of either triangle, sorted, and the quadrilateral
};

}  // namespace octafront::io
