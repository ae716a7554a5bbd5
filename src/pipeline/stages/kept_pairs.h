#pragma once

// Pairs of nodes of a periodic mesh that is improved: their vertices stay, and mid-side nodes are paired anew.

#include "pipeline/stages/run.h"

#include <vector>

namespace octafront {

struct TetMesh;

/// The corners of elements that are copies or have some, ascending.
std::vector<VertexIndex> paired_vertices(const TetMesh& mesh);

/// The same vertices of `mesh`, into which `before` was improved: those at their places. Ascending.
std::vector<VertexIndex> paired_now(const TetMesh& before, const TetMesh& mesh);

/// Gives the mesh the pairs of `before`. Mid-side nodes of edges between copies go where their originals lead, or both
/// edges are straight where an element would not be valid. A note says how many pairs there are no more.
void keep_pairs(const TetMesh& before, TetMesh& mesh, Run& run);

}  // namespace octafront
