#pragma once

#include <octafront/run_context.h>

namespace octafront::cli {

/// Makes limits on the size of files errors that can be told (not a signal that kills), and sees to it that no file of
/// ours can take the place of a standard stream that is closed; memory goes back once it is free. To be called first.
void prepare_process();

/// Ctrl-C and SIGTERM set this flag; the run ends at the next check, with nothing half-written.
const std::atomic<bool>& install_interrupt_handler();

/// A run context for at most as many threads as the machine has, with a progress line on stderr, if that is a terminal
/// that can wipe a line and `quiet` is not set.
RunContext terminal_context(int threads, bool quiet);

/// Wipes the progress line, if there is one.
void clear_progress();

}  // namespace octafront::cli
