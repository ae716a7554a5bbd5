#pragma once

// Elements of order 3 and 4. Where the nodes of an edge or face of the boundary leave the straight one, what is beside
// it follows by the polynomials that continue this into faces and elements: those of the edges and faces of
// p-version elements (B. Szabo, I. Babuska, "Finite Element Analysis", 1991), so that elements that share an edge or
// face agree, and no node moves that touches neither.

#include <octafront/second_order.h>

#include "improve/curved/bends.h"

#include <span>

namespace octafront::curved {

/// Gives a linear mesh the nodes of order 3 or 4: those of the boundary by `bends`, which were found for that order, as
/// far as every element stays valid; what lies over others goes along (`below` as in curved.h). First nodes move so
/// that poor elements get better (moving_nodes.h); where even then the least coefficient of a Jacobian is less than a
/// tenth of the straight element's, or it is not proven positive, the edge or face of it that bends most goes halfway
/// back, and after eight times altogether: to the straight one, of order 4 to where order 3 has it. Counts edges and
/// faces.
void add_high_order(TetMesh& mesh, int order, std::span<const VertexIndex> below, Bends bends,
                    SecondOrderSummary& summary, const RunContext& context);

}  // namespace octafront::curved
