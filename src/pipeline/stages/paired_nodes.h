#pragma once

// Nodes behind corners of a periodic mesh of order 2 to 4: copies go where their originals lead.

#include <octafront/tet_mesh.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace octafront {

/// A node on a face that is repeated, and the one it is a copy of.
struct NodeLink {
  std::uint32_t period;
  VertexIndex copy, original;
};

/// How faces are repeated.
struct Repeats {
  std::uint32_t periods;                            ///< they are numbered below this
  std::function<Vec3(std::uint32_t, Vec3)> copied;  ///< where a period leads a place
  /// Where an original near this place lies, between these corners, so that it has an exact copy.
  std::function<Vec3(Vec3, std::span<const VertexIndex>)> settled;
};

/// `links`: of nodes behind corners. Where an element is not valid with the nodes in their places, those of it that are
/// linked become straight, and what is linked with them. Returns how many.
std::uint64_t pair_nodes_behind_corners(TetMesh& mesh, const std::vector<NodeLink>& links, const Repeats& repeats);

}  // namespace octafront
