#pragma once

// Pairs of nodes of a periodic mesh that is improved: their vertices stay, and nodes behind corners are paired anew.

#include "pipeline/stages/run.h"

#include <vector>

namespace octafront {

struct TetMesh;

/// The corners of elements that are copies or have some, ascending.
std::vector<VertexIndex> paired_vertices(const TetMesh& mesh);

/// Of orders 2 to 4: nodes behind corners of faces that are copies go where their originals lead, or both are straight
/// where an element would not be valid. They become pairs, too.
void pair_mid_nodes(TetMesh& mesh, Run& run);

}  // namespace octafront
