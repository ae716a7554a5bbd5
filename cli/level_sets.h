#pragma once

#include <octafront/mesh_field.h>
#include <octafront/tet_mesh.h>

#include "session.h"

#include <vector>

namespace octafront::cli {

/// Cuts the mesh, which is the input, along the surfaces of --level-set, and brings its fields along. Throws
/// InputError, OptionError.
void cut_along_fields(Session& session, TetMesh& mesh, std::vector<MeshField>& fields);

}  // namespace octafront::cli
