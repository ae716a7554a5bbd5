// Of a program that starts no others, in a web page: what serves them.
#include <octafront/error.h>

#include "mcp_server.h"
#include "workbench.h"

namespace octafront::cli {

void serve_mcp(const CLI::App&, const Folders&, const ToolLimits&) {
  throw OptionError("no programs are started here");
}

void serve_workbench(const CLI::App&, const WorkbenchSetting&) {
  throw OptionError("no programs are started here");
}

}  // namespace octafront::cli
