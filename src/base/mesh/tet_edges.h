#pragma once

// The edges and faces of tetrahedra by numbers.

#include <octafront/tet_mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// The edges of the tetrahedra, each once, sorted: edge e runs from low(e) to high[e].
struct TetEdges {
  std::vector<std::uint32_t> first;  ///< per vertex and one more: where the edges of which it is the lower end begin
  std::vector<VertexIndex> high;     ///< per edge, ascending for each lower end
  std::vector<VertexIndex> low;      ///< per edge

  std::size_t size() const { return high.size(); }
  /// The number of an edge; kNone if there is none between the two.
  std::uint32_t find(VertexIndex a, VertexIndex b) const;
};

/// And which ones each tet has, in the order of kTetEdges. Indices are below `vertices`. In parallel.
TetEdges edges_of_tets(std::span<const Tet> tets, std::size_t vertices,
                       std::vector<std::array<std::uint32_t, 6>>& of_tet);

/// The faces of the tetrahedra, each once, their corners ascending; and which ones each tet has, by the corner
/// opposite.
struct TetFaces {
  std::vector<Triangle> corners;  ///< ascending
  std::vector<std::array<std::uint32_t, 4>> of_tet;
};
TetFaces faces_of_tets(std::span<const Tet> tets, std::size_t vertices);

}  // namespace octafront
