#pragma once

#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "base/mesh/features.h"
#include "fill/lattice/implicit_domain.h"

namespace octafront {

struct SurfaceMesh;

/// Fills `surface` by isosurface stuffing. Boundary faces get the patch of the input triangle nearest to them, and that
/// triangle as their source; the boundary's vertices come first; regions are numbered by connected parts of the mesh,
/// in order of their first tetrahedron. The mesh is valid (see first_defect), its boundary a closed 2-manifold that
/// does not meet itself; parts of the body thinner than an element may be lost. Throws MeshingError if nothing of the
/// body is as large as an element.
TetMesh stuff_surface(const SurfaceMesh& surface, const Features& features, SurfaceDomain::Defects defects,
                      const SizeField& sizes, const Stage& stage);

}  // namespace octafront
