#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace octafront::cli {

/// A script that makes the shell ("bash", "zsh" or "fish") complete commands, options and values, made from the
/// commands and options as they are declared. Throws OptionError for another shell.
std::string completion_for(const std::string& shell, const CLI::App& app);

}  // namespace octafront::cli
