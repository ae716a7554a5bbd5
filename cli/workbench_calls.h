#pragma once

#include "mcp_tools.h"

#include <filesystem>
#include <string>
#include <vector>

namespace octafront::cli {

// What the page of the workbench asks for, the same whether a server answers or a module in the page itself.

/// What a request is refused with; `status` as HTTP has them.
struct RefusedRequest {
  int status;
  std::string code, message;
};
Json in_json(const RefusedRequest& refused);

/// What the page shows before there is a part: the version, the formats that meshes are written in, the options of
/// `octafront mesh`, and the file that is opened first, or null.
Json about_workbench(const CLI::App& app, const std::filesystem::path& file);

/// Its name, its path, its size in bytes.
Json file_in_json(const std::filesystem::path& file, const std::string& name);

/// A tool of the door for agents, or of the page alone, and what it is given.
struct ToolCall {
  const Tool* tool;
  Json arguments;
};
/// Of JSON: {"tool": NAME, "arguments": {...}}. Throws RefusedRequest: for what is no such call, and for outputs that
/// are not plain names.
ToolCall call_of(const std::string& text);

/// A run, and the folder in which it has left its files.
struct RunOfTool {
  const Tool& tool;
  const Json& arguments;
  std::string number;
  std::filesystem::path folder;
};
/// What the page hears of its end: status, reports, files, the number of the run; error, next and sources as the door
/// for agents has them.
Json outcome_of(const RunOfTool& run, const std::vector<RunResult>& results, const Folders& folders);

}  // namespace octafront::cli
