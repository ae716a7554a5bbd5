#pragma once

#include <octafront/surface_mesh.h>

#include "session.h"

#include <filesystem>

namespace octafront::cli {

/// Mends a surface that was read, as the options ask; says what was done, and shows where if a file for that is wanted.
/// A clean one stays as it is. Throws InputError, OptionError.
void mend(Session& session, const std::filesystem::path& file, SurfaceMesh& surface);

/// Drops the walls of a complex that have one region on both sides, if the options say so.
void drop_sheets(Session& session, SurfaceMesh& complex);

}  // namespace octafront::cli
