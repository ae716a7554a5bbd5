#include "terminal.h"

#include <csignal>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace octafront::cli {

namespace {

std::atomic<bool> interrupted{false};
bool progress_shown = false;

void on_signal(int) {
  interrupted.store(true);
}

}  // namespace

const std::atomic<bool>& install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  // A second Ctrl-C ends the program at once.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return interrupted;
}

RunContext terminal_context(int threads, bool quiet) {
  RunContext context;
  context.cancel = &install_interrupt_handler();
  context.threads = threads;
  if (quiet || !isatty(STDERR_FILENO)) return context;
  context.progress = [](std::string_view stage, double fraction) {
    const std::string share = fraction >= 0 ? fmt::format(" {:3.0f} %", 100 * fraction) : " ...";
    fmt::print(stderr, "\r\x1b[K{}{}", stage, share);
    std::fflush(stderr);
    progress_shown = true;
  };
  return context;
}

void clear_progress() {
  if (!progress_shown) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  progress_shown = false;
}

}  // namespace octafront::cli
