#pragma once

#include <octafront/io.h>
#include <octafront/mesh_field.h>
#include <octafront/tet_mesh.h>

#include "session.h"

#include <vector>

namespace octafront::cli {

/// Whether --sample, --field or --material-bins were given.
bool asks_for_fields(const Arguments& arguments);
/// Refuses what would fail once the mesh is made: formulas, files that are not there. Throws OptionError, InputError.
void check_asked_fields(const Arguments& arguments);

/// Adds the fields of --sample and --field, of elements and nodes.
void add_asked_fields(Session& session, const TetMesh& mesh, std::vector<MeshField>& fields);
/// Adds the sets of --material-bins by the last field of elements, and tells them.
std::vector<SetMaterial> bins_asked(Session& session, TetMesh& mesh, const std::vector<MeshField>& fields);

}  // namespace octafront::cli
