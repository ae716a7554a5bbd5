#include "terminal.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <io.h>
#include <windows.h>
#endif

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

/// How long the stage that runs will take, by how far it came in what time.
class StageClock {
 public:
  /// Negative while nobody can tell.
  double seconds_left(std::string_view stage, double fraction) {
    constexpr double kWarmUp = 2, kLeastFraction = 0.02;  // seconds; a guess from less would jump about
    const auto now = std::chrono::steady_clock::now();
    if (stage != stage_) {
      stage_ = stage;
      start_ = now;
    }
    const double passed = std::chrono::duration<double>(now - start_).count();
    return passed < kWarmUp || fraction < kLeastFraction ? -1 : passed * (1 - fraction) / fraction;
  }

 private:
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

std::string time_left_in_words(double seconds) {
  if (seconds < 0) return "";
  const auto s = static_cast<long>(std::lround(seconds));
  if (s < 60) return fmt::format(", {} s left", s);
  if (s < 3600) return fmt::format(", {}:{:02} min left", s / 60, s % 60);
  return fmt::format(", {}:{:02} h left", s / 3600, s / 60 % 60);
}

/// For a program that reads them: "\x1fSTAGE\tFRACTION", a negative one where it is not known.
void tell_progress_by_lines(std::string_view stage, double fraction) {
  fmt::print(stderr, "\x1f{}\t{:.4f}\n", stage, fraction);
}

/// More threads than that only get in each other's way.
int threads_at_most(int asked) {
  const int machine = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return std::min(asked, machine);
}

}  // namespace

void prepare_process() {
#ifdef __GLIBC__
  // By default glibc keeps blocks of up to 32 MB once they were freed: a quarter of the peak, to save 2 % of the time.
  // Small blocks ask the system for so much at once: a third of the page faults, and 2 % less time.
  constexpr int kLeastMapped = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kLeastMapped);
  mallopt(M_TRIM_THRESHOLD, 4 * kLeastMapped);
  mallopt(M_TOP_PAD, 32 * kLeastMapped);
#endif
#ifdef _WIN32
  // Files that go to standard output are bytes, and names in messages UTF-8.
  _setmode(STDOUT_FILENO, _O_BINARY);
  SetConsoleOutputCP(CP_UTF8);
#else
  std::signal(SIGXFSZ, SIG_IGN);
  int fd = STDIN_FILENO;
  while (fd >= 0 && fd <= STDERR_FILENO) fd = fcntl(fd, F_GETFD) < 0 ? open("/dev/null", O_RDWR) : fd + 1;
#endif
}

const std::atomic<bool>& install_interrupt_handler() {
#ifdef _WIN32
  // Each is forgotten when it comes: a second Ctrl-C ends the program at once.
  for (const int signal : {SIGINT, SIGTERM, SIGBREAK}) std::signal(signal, on_signal);
#else
  struct sigaction action {};
  action.sa_handler = on_signal;
  // A second Ctrl-C ends the program at once.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // Who started the program with nohup wants it to outlive the terminal.
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
#endif
  return interrupted;
}

RunContext terminal_context(int threads, bool quiet) {
  RunContext context;
  context.cancel = &install_interrupt_handler();
  context.threads = threads_at_most(threads);
  if (const char* wanted = std::getenv("OCTAFRONT_PROGRESS");
      wanted != nullptr && std::string_view(wanted) == "lines") {
    context.progress = tell_progress_by_lines;
    return context;
  }
  if (quiet || !can_wipe_lines()) return context;
  context.progress = [clock = StageClock()](std::string_view stage, double fraction) mutable {
    const std::string share = fraction >= 0 ? fmt::format(" {:3.0f} %", 100 * fraction) : " ...";
    fmt::print(stderr, "\r\x1b[K{}{}{}", stage, share, time_left_in_words(clock.seconds_left(stage, fraction)));
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
