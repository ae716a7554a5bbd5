#pragma once

// A mesh in parts. Which part each element is in (division.h, a pure function of the mesh), and one
// part with the layer of elements around it, as a mesh of its own that knows its numbers in the whole (pieces.h).

#include <octafront/io.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <vector>

namespace octafront::io {

struct Division {
  std::uint32_t parts = 1;
  std::vector<std::uint32_t> part;  ///< per tetrahedron; those of a wedge or pyramid are in one
};

/// Each element in one of the parts, 0 < parts <= elements. The curve: consecutive stretches of a Hilbert curve through
/// the elements' centres, which differ by one element at most; O(n log n), 16 bytes an element, the same for every
/// number of threads. METIS: fewer faces between the parts (G. Karypis, V. Kumar, A fast and high quality multilevel
/// scheme for partitioning irregular graphs, 1998), parts that differ by 3 %; some 180 bytes an element. Throws
/// OptionError if there are more parts than elements, if METIS leaves parts empty, or is not in this build.
Division divide(const TetMesh& mesh, std::uint32_t parts, Partitioner partitioner);

/// What a division is worth.
struct DivisionCost {
  std::size_t least = 0, most = 0;  ///< elements in a part
  std::size_t cut = 0;              ///< triangles between tetrahedra of different parts
};
DivisionCost cost_of(const TetMesh& mesh, const Division& division);

/// The graph of elements that share faces, divided by METIS: neighbours of element i are next[first[i]] to
/// next[first[i + 1] - 1]. 1 < parts < elements. Throws OptionError where there is none.
std::vector<std::uint32_t> divide_graph(std::vector<std::int32_t> first, std::vector<std::int32_t> next,
                                        std::uint32_t parts);

}  // namespace octafront::io
