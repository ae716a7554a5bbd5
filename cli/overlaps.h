#pragma once

#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include <optional>
#include <string>

namespace octafront::cli {

/// Where elements of a valid mesh lie on each other, or the mesh is torn, as a sentence with places; else nullopt. All
/// elements being positive, that shows on the boundary: a mesh without such a place has one that neither meets itself
/// nor lies in what another part of it fills. Exact, O(n log n) in the boundary.
std::optional<std::string> first_overlap(const TetMesh& mesh, const RunContext& context);

}  // namespace octafront::cli
