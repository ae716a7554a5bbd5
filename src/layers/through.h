#pragma once

// Layers of flat elements through thin walls. Takes a mesh whose elements reach from one side of a
// wall to the other; leaves the same body with nodes on all edges that do.

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "base/mesh/features.h"

#include <cstdint>
#include <vector>

namespace octafront::layers {

/// An edge of the mesh from one side of a wall to the other.
struct Span {
  VertexIndex low, high;
};

/// The edges through walls: both ends lie on the boundary of the region that the edge runs through, on faces that look
/// away from each other (within about 45 degrees), and each end lies behind the other one's face (exact signs). Ends
/// are low on one side of a wall and high on the other, as far as it has two. Ascending.
std::vector<Span> spans_through_walls(const TetMesh& mesh, const RunContext& context);

/// What split_spans() did.
struct SplitSpans {
  std::uint64_t edges = 0;     ///< that have nodes now
  std::uint64_t elements = 0;  ///< that they were edges of
  std::uint64_t made = 0;      ///< elements in their place
  /// Per vertex of the new mesh the pass that put it on an edge, from 1 on; 0: it was there.
  std::vector<std::uint32_t> level;
};

/// Divides each of `spans` into `layers` equal parts, and with them the elements and faces around: each pass takes one
/// layer off the low side, longest edges first, so that neighbours divide their common face alike. No vertex moves, so
/// the body stays what it is. `surface` is what the mesh fills, whose vertices are the mesh's first ones, and
/// `features` its features: both follow, and `parent` gets the old triangle of each of its triangles. REQUIRES a linear
/// mesh without wide cells and curves, layers >= 2.
SplitSpans split_spans(TetMesh& mesh, std::vector<Span> spans, std::uint32_t layers, SurfaceMesh& surface,
                       Features& features, std::vector<std::uint32_t>& parent, const RunContext& context);

/// What thin_out() did.
struct ThinnedOut {
  std::uint64_t collapsed = 0;  ///< nodes that went onto others
  std::uint64_t moved = 0;      ///< nodes that moved
  std::vector<std::uint32_t> level;
};

/// Every edge through a wall has nodes now, several times as many as a layer needs: those inside, from `surface_points`
/// on, are collapsed onto others of their level where the dihedral angles around stay above 12 degrees and below 168,
/// or become better; then they move to where the worst of these angles is best. Edges join neighbouring levels as
/// before, all elements stay positive (exact signs), the boundary stays. One node after the other, the same on any
/// number of threads.
ThinnedOut thin_out(TetMesh& mesh, std::size_t surface_points, std::vector<std::uint32_t> level,
                    const RunContext& context);

}  // namespace octafront::layers
