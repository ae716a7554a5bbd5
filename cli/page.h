#pragma once

#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "session.h"

namespace octafront::cli {

/// Refuses a page that could not be written, before any work.
void check_page_target(const std::filesystem::path& page);

/// What repair changes of a surface, with places, into what the session found.
void find_repairs(Session& session, const SurfaceMesh& input);

/// The page of a session whose findings are complete; `sizes` may be null.
void write_page(const std::filesystem::path& file, const Session& session, const TetMesh& mesh, const SizeField* sizes);

}  // namespace octafront::cli
