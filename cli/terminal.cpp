#include "terminal.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

namespace octafront::cli {

namespace {

std::atomic<bool> interrupted{false};
bool progress_shown = false;

void on_signal(int) {
  interrupted.store(true);
}

bool can_wipe_lines() {
  const char* const terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) && terminal != nullptr && std::string_view(terminal) != "dumb";
}

/// More threads than that only get in each other's way.
int threads_at_most(int asked) {
  const int machine = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return std::min(asked, machine);
}

}  // namespace

void prepare_process() {
  std::signal(SIGXFSZ, SIG_IGN);
  int fd = STDIN_FILENO;
  while (fd >= 0 && fd <= STDERR_FILENO) fd = fcntl(fd, F_GETFD) < 0 ? open("/dev/null", O_RDWR) : fd + 1;
}

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
  context.threads = threads_at_most(threads);
  if (quiet || !can_wipe_lines()) return context;
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
