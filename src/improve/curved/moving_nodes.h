#pragma once

#include <octafront/tet_mesh.h>

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace octafront {
struct RunContext;
}

namespace octafront::curved {

/// Whether nodes of walls may move, along these.
enum class Walls { kStay, kSlide };

/// A node of a wall that slid along it.
struct SlidNode {
  VertexIndex node;
  TetIndex tet;              ///< an element that has it
  std::array<double, 4> at;  ///< its place in this as it was before, in barycentric coordinates times the order
};

struct NodesMoved {
  std::vector<std::pair<VertexIndex, Vec3>> by;
  std::vector<SlidNode> slid;  ///< ascending by node
};

/// Moves nodes behind the corners of a mesh of order 3 or 4, at elements of `among` whose least Jacobian is less than
/// `wanted` (at least kLeastScaledJacobian) of the straight one; of those above kLeastScaledJacobian at the worst half
/// percent of the mesh alone. `is_on_wall`: per point. First those on no wall, by steps along the axes; then, for what
/// is below kLeastScaledJacobian, those on walls, along the curves and surfaces that the wall's nodes span now. No
/// element becomes worse by a move, as far as it is below what is wanted. Some milliseconds an element.
NodesMoved raise_worst_elements(TetMesh& mesh, std::span<const TetIndex> among, double wanted,
                                const std::vector<char>& is_on_wall, Walls walls, const RunContext& context);

}  // namespace octafront::curved
