#pragma once

// How far the nodes of the boundary may go towards the smooth surface: as far as every element stays valid. What an
// element needs is looked at for all of them at once, then what must gives way, again and again; so threads change
// nothing.

#include <octafront/second_order.h>

#include "improve/curved/bends.h"
#include "improve/curved/mid_nodes.h"

#include <span>

namespace octafront::curved {

/// Moves corners of a linear mesh as far as every tetrahedron stays positive and keeps half of its volume: the corners
/// of one that does not go halfway back, and after eight times altogether. Inner corners beside them go half of the way
/// with them. Counts those that were asked for.
void move_corners(TetMesh& mesh, std::span<const CornerMove> moves, SecondOrderSummary& summary,
                  const RunContext& context);

/// Bends edges of a mesh with straight mid-side nodes as far as every element stays valid: where the least coefficient
/// of its Jacobian is not positive by exact sign, or less than a tenth of the straight element's, the edge of it that
/// bends most goes halfway back, and after eight times is straight. Counts edges.
void bend_edges(TetMesh& mesh, const TetEdges& edges, std::span<const EdgeBend> bends, SecondOrderSummary& summary,
                const RunContext& context);

}  // namespace octafront::curved
