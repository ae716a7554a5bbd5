#pragma once

// How far the nodes of the boundary may go towards the smooth surface: as far as every element stays valid. What an
// element needs is looked at for all of them at once, then what must gives way, again and again; so threads change
// nothing.

#include <octafront/run_context.h>
#include <octafront/second_order.h>

#include "base/core/parallel.h"
#include "improve/curved/bends.h"
#include "improve/curved/mid_nodes.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::curved {

/// The least coefficient of the Jacobian over that of the straight element: positive is valid, a little more is safe in
/// files with fewer digits and kinder to solvers.
inline constexpr double kLeastScaledJacobian = 0.1;
/// So often a node, edge or face goes halfway back before it goes back altogether.
inline constexpr int kMostHalvings = 8;

/// Until is_good(t) holds for all suspects, or nothing is left to give way: choose(t, back) says what must for a bad
/// one, and go_back(back), each once and ascending, which tets that changes. In parallel but for these two.
template <class IsGood, class Choose, class GoBack>
void settle_tets(std::vector<TetIndex> suspects, const IsGood& is_good, const Choose& choose, const GoBack& go_back,
                 const RunContext& context) {
  while (!suspects.empty()) {
    context.check();
    std::vector<char> good(suspects.size());
    parallel_for(suspects.size(), [&](std::size_t i) { good[i] = is_good(suspects[i]); });
    std::vector<std::uint32_t> back;
    for (std::size_t i = 0; i < suspects.size(); ++i)
      if (!good[i]) choose(suspects[i], back);
    std::ranges::sort(back);
    back.erase(std::unique(back.begin(), back.end()), back.end());
    suspects = go_back(back);
  }
}

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
