#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <string>
#include <vector>

namespace octafront {

/// Opens a mesh along faces inside: patches between two regions, or sheets (cracks, faults), by name or number (from
/// 1). Each node there is doubled as often as the elements around it come apart: where patches cross there are more
/// than two, at the end of a sheet inside, the tip of a crack, it stays one. Coordinates stay the same, so the two
/// sides touch.
///
/// Of a patch `fault` the faces of the elements in front of it, where its triangles' normals point, become the patch
/// `fault_plus` of the boundary, those of the elements behind it `fault_minus`; `split_faces` tells which belong
/// together. Of a name that stands for patches in several regions, "fault (clay|clay)", all are opened. A face all of
/// whose corners lie at the end of a sheet stays closed. Sets and curves that have a doubled node or edge have its
/// copies, too; further sets of faces lose those that were split.
///
/// Returns sentences for the user: what was done. Throws OptionError, before any change, where a patch does not exist
/// or has no face inside. O(mesh).
std::vector<std::string> split_patches(TetMesh& mesh, const std::vector<std::string>& places);

/// Throws OptionError if a mesh of this complex would have nothing to split under one of these names.
void check_split(const SurfaceMesh& complex, const std::vector<std::string>& places);

}  // namespace octafront
