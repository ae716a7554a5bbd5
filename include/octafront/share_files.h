#pragma once

#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include <string>
#include <vector>

namespace octafront {

/// Writes a mesh of which each of several ranks has a share (Result::is_share): NAME.pvtu, and a folder NAME with a
/// piece by each rank, with one layer of elements of the others around its own (vtkGhostType) and all numbers those of
/// the whole mesh. No rank holds more than its piece. Which elements are in which piece hangs on the number of ranks.
/// All ranks call it, and see the same folder; on the first one it returns what a user should know. Not of second
/// order. Throws OutputError; where it fails on one rank, all throw and nothing is left.
std::vector<std::string> write_shares(const std::string& file, const TetMesh& share, const RunContext& context);

}  // namespace octafront
