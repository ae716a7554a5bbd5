#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace octafront::cli {

/// Help of a command: what most people use, and the groups of the rest; with `topic` the options of a group, by its
/// key, or all. Throws OptionError for a group that there is not, with those that there are.
std::string help_of_command(const CLI::App& command, const std::string& topic = {});

}  // namespace octafront::cli
