#pragma once

#include <octafront/run_context.h>

namespace octafront::cli {

/// Ctrl-C and SIGTERM set this flag; the run ends at the next check, with nothing half-written.
const std::atomic<bool>& install_interrupt_handler();

/// A run context with a progress line on stderr, if that is a terminal and `quiet` is not set.
RunContext terminal_context(int threads, bool quiet);

/// Wipes the progress line, if there is one.
void clear_progress();

}  // namespace octafront::cli
