#pragma once

#include "session.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace octafront::cli {

/// What `octafront compare` was asked for; `output` of the common arguments is a folder.
struct CompareArguments {
  Arguments common;
  std::vector<std::filesystem::path> inputs;
  std::vector<Method> methods{Method::kOctreeAft, Method::kAft, Method::kOctree};
  std::vector<std::int64_t> elements;
};

void declare_compare(CLI::App& command, CompareArguments& arguments);

/// Meshes every input with every method at every number of elements asked for; writes compare.csv, compare.json and
/// the charts into the folder; prints the table. A method that fails on an input is a line with its message, and makes
/// the whole a MeshingError in the end, when all is written.
void run_compare(const CompareArguments& arguments, Session& session);

}  // namespace octafront::cli
