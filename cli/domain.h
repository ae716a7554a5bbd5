#pragma once

#include <octafront/domain.h>

#include "session.h"

#include <filesystem>
#include <optional>

namespace octafront::cli {

/// Where a way through a leak is written to, beside the output.
std::filesystem::path leak_file(std::filesystem::path output);

/// Opens the input or inputs of a command; what is found and done is said, and shown where a file for that is wanted.
/// Throws InputError, OptionError; for leaks with the way written to leak_file(), if there is an output.
Domain open_input(Session& session, const IntakeOptions& options);

/// What is wrong with a surface that was refused goes into the JSON file; whether something is.
bool tell_defects(Session& session, const SurfaceMesh& surface);

/// The surface of --surface, or what a CAD file stands for, as it is: it need not be closed. None if it is not given.
std::optional<Domain> open_ground(Session& session);

}  // namespace octafront::cli
