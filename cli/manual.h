#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace octafront::cli {

/// The manual page octafront(1) in the language of man(7), made from the commands and options as they are declared.
std::string manual_page(const CLI::App& app);

}  // namespace octafront::cli
