#pragma once

// A mesh as what is to be meshed again.

#include <octafront/domain.h>
#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

namespace octafront {

/// The walls of a mesh (its boundary and interfaces, as they are now) with their patches, the regions on both sides,
/// and the sets of nodes, edges and faces. Curves, and sets of elements, have no place in it. Requires a valid linear
/// mesh.
Domain domain_of(const TetMesh& mesh);

/// The mesh that generate() makes of domain_of() a mesh: with the patches that this has, where generate() makes one of
/// each pair of regions. A wall between regions that was no interface is one of a patch of its own.
TetMesh meshed_anew(const TetMesh& mesh, const Options& options, const RunContext& context);

}  // namespace octafront
