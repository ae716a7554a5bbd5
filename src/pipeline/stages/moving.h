#pragma once

#include <octafront/domain.h>
#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include <vector>

namespace octafront {

// A mesh as what is to be meshed again.

/// The walls of a mesh (its boundary and interfaces, as they are now) with their patches, the regions on both sides,
/// and the sets of nodes, edges and faces. Curves, and sets of elements, have no place in it. Requires a valid linear
/// mesh.
Domain domain_of(const TetMesh& mesh);

/// The mesh that generate() makes of domain_of() a mesh: with the patches that this has, where generate() makes one of
/// each pair of regions. A wall between regions that was no interface is one of a patch of its own.
TetMesh meshed_anew(const TetMesh& mesh, const Options& options, const RunContext& context);

// Displacements of a boundary, continued into the body.

/// The values at the boundary stay; those inside become harmonic, component by component, in linear elements: linear
/// motions, turns of any angle among them, are continued exactly. `values`: one per point; those inside have no say.
/// The same for any number of threads. Requires a valid linear mesh. Cost: some 150 products with the matrix.
std::vector<Vec3> harmonic_inside(const TetMesh& mesh, std::vector<Vec3> values, const RunContext& context);

}  // namespace octafront
