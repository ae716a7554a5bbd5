#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "base/shared/shared_tets.h"

namespace octafront {

struct SurfaceMesh;

/// Fills a clean surface with tetrahedra of the wanted size: the volume front, then the closing of what it leaves.
/// The boundary of the result is `surface`, triangle for triangle; the first points of the result are those of the
/// surface in their order; mesh.boundary lists the surface's triangles in their order, with their patches; regions
/// are numbered by body (outer shell and its cavities) in order of the first triangle.
/// Where the front leaks or a cavity stays open, recovery of the whole surface takes its place (a note in `report` says
/// so), with points added inside by the sizes. Throws MeshingError if that fails too.
/// `tets`: what of them each of several ranks gets. Shares are in no order.
TetMesh fill_volume(const SurfaceMesh& surface, const SizeField& sizes, const VolumeOptions& options,
                    const Stage& stage, Tets tets = Tets::kAll);

}  // namespace octafront
