#pragma once

#include <octafront/io.h>

#include "session.h"

#include <filesystem>

namespace octafront::cli {

/// The input of a session as a surface, and as a mesh; what reading has to say is said. Throws InputError.
SurfaceFile read_input(Session& session);
TetMesh read_mesh_input(Session& session);
/// The same with what the file says of it.
MeshFile read_mesh_file_input(Session& session);
/// Of another file.
MeshFile read_mesh_file_of(Session& session, const std::filesystem::path& file);

/// Tetrahedral meshes are told from surfaces by the ending: no surface format shares one with them.
bool is_tet_mesh_file(const std::filesystem::path& file);

}  // namespace octafront::cli
