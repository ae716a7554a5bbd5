#pragma once

#include "mcp_tools.h"

#include <filesystem>

namespace octafront::cli {

/// What `octafront ui` was asked for.
struct WorkbenchSetting {
  std::filesystem::path file;  ///< that is opened first; empty: none
  int port = 0;                ///< 0: any that is free
  bool opens_browser = true;
};

/// Serves the workbench to a browser on this machine: over HTTP, on the loopback address alone, to those who know the
/// token in its address. Runs of the program are processes of their own, which see the folder of the file, those that
/// were uploaded, and a folder for what they write that is removed in the end. Returns once the page was closed, or
/// on Ctrl-C. Throws OptionError where it cannot be: on Windows, without cpp-httplib, without the page.
void serve_workbench(const CLI::App& app, const WorkbenchSetting& setting);

}  // namespace octafront::cli
