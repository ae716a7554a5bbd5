#pragma once

#include "mcp_tools.h"

namespace octafront::cli {

/// Speaks the Model Context Protocol over standard input and output, a message of JSON-RPC 2.0 in each line, until
/// standard input ends. Calls run one after the other, each as a process of its own; meanwhile it listens. What goes in
/// may be anything: it is answered, or refused with an error of the protocol.
void serve_mcp(const CLI::App& app, const Folders& folders, const ToolLimits& limits);

}  // namespace octafront::cli
