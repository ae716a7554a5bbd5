#pragma once

#include <octafront/error.h>
#include <octafront/open_cavity_error.h>

#include <filesystem>

namespace octafront::cli {

/// Where the cavity of a run that writes `output` goes: NAME.cavity.off beside it.
std::filesystem::path cavity_file(std::filesystem::path output);

/// Writes the cavity that stayed open there: a small file that can be sent in the place of the whole model. Returns the
/// error to end with (exit status 4), which names the file and says how to report it. Throws OutputError.
MeshingError with_cavity_written(const OpenCavityError& error, const std::filesystem::path& output);

}  // namespace octafront::cli
