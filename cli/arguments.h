#pragma once

#include <octafront/options.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace octafront::cli {

/// What the user typed, as the commands need it.
struct Arguments {
  std::filesystem::path input, output, json, surface;
  std::filesystem::path regions, size_field, size_grid;  ///< files with sizes; empty: none
  Options options;
  int threads = 0;
  bool quiet = false;
};

/// Declares what each command understands; names and defaults are those of Options.
void declare_input(CLI::App& command, Arguments& arguments);
void declare_mesh_input(CLI::App& command, Arguments& arguments);
void declare_output(CLI::App& command, Arguments& arguments, const std::string& what, bool required);
void declare_report(CLI::App& command, Arguments& arguments);
void declare_run(CLI::App& command, Arguments& arguments);
void declare_sizes(CLI::App& command, Arguments& arguments);
void declare_surface(CLI::App& command, Arguments& arguments);
void declare_volume(CLI::App& command, Arguments& arguments);
void declare_improvement(CLI::App& command, Arguments& arguments);
void declare_ground(CLI::App& command, Arguments& arguments);

}  // namespace octafront::cli
