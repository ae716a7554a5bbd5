#pragma once

#include <octafront/complex.h>
#include <octafront/io.h>

#include "session.h"

#include <filesystem>

namespace octafront::cli {

/// Where a way through a leak is written to, beside the output.
std::filesystem::path leak_file(std::filesystem::path output);

/// Says what regions a complex has, and their volumes.
void tell_regions(Session& session, const Complex& complex);
/// What becomes of defects: mended as the options say, or left for whoever looks for them.
enum class Defects { kMended, kLeft };

/// Reads the input or inputs of a command, and makes a complex of them where their walls or the options say so. Says
/// what was read and done. Throws InputError; for leaks with the way written to leak_file(), if there is an output.
SurfaceFile read_domain(Session& session, Defects defects = Defects::kMended);

}  // namespace octafront::cli
