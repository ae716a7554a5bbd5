#pragma once

#include <octafront/error.h>

#include <filesystem>

namespace octafront::cli {

/// Writes the cavity that stayed open beside `output`, as NAME.cavity.off: a small file that can be sent in the place
/// of the whole model. Returns the error to end with (exit status 4), which names the file and says how to report it.
/// Throws OutputError.
MeshingError with_cavity_written(const OpenCavityError& error, std::filesystem::path output);

}  // namespace octafront::cli
