#pragma once

#include <octafront/domain.h>

#include "session.h"

#include <filesystem>

namespace octafront::cli {

/// Where a way through a leak is written to, beside the output.
std::filesystem::path leak_file(std::filesystem::path output);

/// Opens the input or inputs of a command; what is found and done is said, and shown where a file for that is wanted.
/// Throws InputError, OptionError; for leaks with the way written to leak_file(), if there is an output.
Domain open_input(Session& session, const IntakeOptions& options);

}  // namespace octafront::cli
