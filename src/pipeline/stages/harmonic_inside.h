#pragma once

// Displacements of a boundary, continued into the body.

#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include <vector>

namespace octafront {

/// The values at the boundary stay; those inside become harmonic, component by component, in linear elements: linear
/// motions, turns of any angle among them, are continued exactly. `values`: one per point; those inside have no say.
/// The same for any number of threads. Requires a valid linear mesh. Cost: some 150 products with the matrix.
std::vector<Vec3> harmonic_inside(const TetMesh& mesh, std::vector<Vec3> values, const RunContext& context);

}  // namespace octafront
