#pragma once

// stuffing: the octree method. Takes a triangle surface, clean or not, and sizes; leaves a mesh whose inside is the
// graded body-centred cubic lattice and whose boundary is near the surface, not on its triangles (F. Labelle and
// J. R. Shewchuk, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral Angles", 2007).
//
//   stuffing_octree -> lattice_graph (sides, cut edges; implicit_domain says what is inside) -> cut_lattice (warp, cut)
//     -> manifold (no parts that touch in an edge or a point) -> snap_features (corners and curves) -> patches, regions

#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "core/stage.h"
#include "mesh/features.h"
#include "stuffing/implicit_domain.h"

namespace octafront {

/// Fills `surface` by isosurface stuffing. Boundary faces get the patch of the input triangle nearest to them, and that
/// triangle as their source; the boundary's vertices come first; regions are numbered by connected parts of the mesh,
/// in order of their first tetrahedron. The mesh is valid (see first_defect), its boundary a closed 2-manifold that
/// does not meet itself; parts of the body thinner than an element may be lost. Throws MeshingError if nothing of the
/// body is as large as an element.
TetMesh stuff_surface(const SurfaceMesh& surface, const Features& features, SurfaceDomain::Defects defects,
                      const SizeField& sizes, const Stage& stage);

}  // namespace octafront
