#pragma once

// Edges and faces of tetrahedra by numbers, as programs count them that keep nodes with them.

#include <octafront/tet_mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::io {

struct NumberedParts {
  std::vector<std::uint32_t> of;     ///< per edge or face of each tetrahedron its number
  std::vector<std::uint32_t> first;  ///< per number the first edge or face of the list that has it
};

enum class PartOrder {
  kAsNamed,  ///< in the order in which tetrahedra name them
  kSorted,   ///< by their vertices, ascending
};

/// Edge e of tetrahedron t is 6 t + e, by kTetEdges; face f is 4 t + f, by kTetFaces. Indices are below `vertices`.
NumberedParts numbered_edges(std::span<const Tet> tets, std::size_t vertices, PartOrder order);
NumberedParts numbered_faces(std::span<const Tet> tets, std::size_t vertices, PartOrder order);

using SquareMatrix = std::vector<std::vector<double>>;
/// Gauss and Jordan's elimination, with the largest of a column as pivot. REQUIRES that there is an inverse.
SquareMatrix inverse_of(SquareMatrix a);

}  // namespace octafront::io
