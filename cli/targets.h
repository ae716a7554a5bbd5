#pragma once

#include <octafront/tet_mesh.h>

#include "session.h"

#include <string>

namespace octafront::cli {

/// Refuses outputs of meshes that cannot be written, before any work. Throws OptionError, OutputError.
void check_mesh_targets(const Arguments& arguments);

/// Adds the groups that were asked for, writes the mesh to all outputs, and says what was lost on the way.
void write_mesh_targets(Session& session, TetMesh mesh);

/// To a file, or to standard output if it is called "-". Throws OutputError.
void write_text_target(const std::filesystem::path& file, const std::string& text);

}  // namespace octafront::cli
