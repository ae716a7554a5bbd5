#include <octafront/limits.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>
#include <thread>

#include <fmt/core.h>
#ifdef _WIN32
#include "base/core/files_of_windows.h"
#else
#include <csignal>

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>
#endif

namespace octafront {

namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
constexpr int kStatus = 7;

std::atomic<std::uint64_t> memory_set{kNoLimit};
std::atomic<std::uint64_t> elements_set{kNoLimit};
std::atomic<bool> is_time_over{false};
std::vector<std::string> folders_set;
std::atomic<double> seconds_set{std::numeric_limits<double>::infinity()};

/// How much longer work may go on that does not ask whether it should.
double grace(double seconds) {
  return std::max(5.0, seconds / 4);
}

[[noreturn]] void end_at_once() {
  constexpr std::string_view kWords = "octafront: the CPU seconds that it may take are spent; no result was written\n";
#ifndef _WIN32
  // Whether it can be told makes no difference.
  [[maybe_unused]] const ssize_t told = ::write(STDERR_FILENO, kWords.data(), kWords.size());
#endif
  std::_Exit(kStatus);
}

#if defined(_WIN32)

double cpu_seconds() {
  FILETIME made, ended, kernel, user;
  if (GetProcessTimes(GetCurrentProcess(), &made, &ended, &kernel, &user) == 0) return 0;
  const auto seconds = [](const FILETIME& t) { return 1e-7 * (t.dwHighDateTime * 0x1p32 + t.dwLowDateTime); };
  return seconds(kernel) + seconds(user);
}

void watch_time(double seconds) {
  std::thread([begun = cpu_seconds(), seconds] {
    for (;; Sleep(50)) {
      const double spent = cpu_seconds() - begun;
      if (spent > seconds) is_time_over = true;
      if (spent > seconds + grace(seconds)) end_at_once();
    }
  }).detach();
}

std::uint64_t memory_of_machine() {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  return GlobalMemoryStatusEx(&status) != 0 ? status.ullTotalPhys : kNoLimit;
}

void limit_data(std::uint64_t) {}
std::uint64_t memory_of_system() {
  return kNoLimit;
}

#else

/// Of this process and of those that it has waited for.
double cpu_seconds() {
  double seconds = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage use{};
    if (::getrusage(who, &use) != 0) continue;
    for (const timeval& t : {use.ru_utime, use.ru_stime})
      seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  }
  return seconds;
}

void on_time(int) {
  if (is_time_over.exchange(true)) end_at_once();
}

timeval timeval_of(double seconds) {
  constexpr double kMost = 1e9;
  const double whole = std::floor(std::min(seconds, kMost));
  const auto micro = static_cast<suseconds_t>(1e6 * (std::min(seconds, kMost) - whole));
  return {static_cast<time_t>(whole), std::max<suseconds_t>(micro, whole > 0 ? 0 : 1)};
}

void watch_time(double seconds) {
  struct sigaction action {};
  action.sa_handler = on_time;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGPROF, &action, nullptr);
  const itimerval timer{timeval_of(grace(seconds)), timeval_of(std::max(seconds, 1e-6))};
  ::setitimer(ITIMER_PROF, &timer, nullptr);
}

std::uint64_t memory_of_machine() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || size <= 0) return kNoLimit;
  std::uint64_t least = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size);
  // Version 2 and 1; "max" is no number.
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::uint64_t bytes = 0;
    if (std::ifstream(file) >> bytes && bytes > 0) least = std::min(least, bytes);
  }
  return least;
}

/// What threads reserve and do not use: it counts for the system, and should not for the user.
std::uint64_t stacks() {
  rlimit stack{};
  constexpr std::uint64_t kUsual = 8 << 20;
  const bool is_known = ::getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur != RLIM_INFINITY;
  return (1 + std::uint64_t{std::thread::hardware_concurrency()}) * (is_known ? std::uint64_t{stack.rlim_cur} : kUsual);
}

void limit_data(std::uint64_t bytes) {
  rlimit data{};
  if (::getrlimit(RLIMIT_DATA, &data) != 0) return;
  const std::uint64_t wanted = bytes > kNoLimit - stacks() ? kNoLimit : bytes + stacks();
  data.rlim_cur = static_cast<rlim_t>(std::min<std::uint64_t>(wanted, data.rlim_max));
  ::setrlimit(RLIMIT_DATA, &data);
}

/// As the shell's ulimit sets it.
std::uint64_t memory_of_system() {
  std::uint64_t least = kNoLimit;
  for (const auto of : {RLIMIT_DATA, RLIMIT_AS}) {
    rlimit limit{};
    if (::getrlimit(of, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      least = std::min<std::uint64_t>(least, limit.rlim_cur);
  }
  return least;
}

#endif

}  // namespace

namespace {

/// Where a file is, or would be made: also where a link leads that leads to nothing yet.
std::filesystem::path real_place(std::filesystem::path file) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(std::filesystem::symlink_status(file, error)); ++i) {
    const std::filesystem::path target = std::filesystem::read_symlink(file, error);
    if (error) break;
    file = target.is_absolute() ? target : file.parent_path() / target;
  }
  return std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
}

}  // namespace

bool lies_in(const std::string& file, const std::vector<std::string>& folders) {
  const std::filesystem::path place = real_place(file);
  return std::ranges::any_of(folders, [&](const std::string& named) {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::canonical(named, error);
    return !error && !place.empty() &&
           std::mismatch(folder.begin(), folder.end(), place.begin(), place.end()).first == folder.end();
  });
}

void require_in_folders(const std::string& file) {
  if (folders_set.empty() || lies_in(file, folders_set)) return;
  throw LimitError(LimitError::Limit::kFolders,
                   fmt::format("{}: lies outside of the folders that files may be in (`within`)", file));
}

std::string bytes_in_words(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", std::ceil(bytes / 1e6)) : fmt::format("{:.1f} GB", bytes / 1e9);
}

void set_process_limits(const ProcessLimits& limits) {
  folders_set = limits.folders;
  memory_set = limits.memory.value_or(memory_of_machine());
  if (memory_set != kNoLimit) limit_data(memory_set);
  elements_set = limits.elements.value_or(kNoLimit);
  if (!limits.cpu_seconds) return;
  seconds_set = cpu_seconds() + *limits.cpu_seconds;
  watch_time(*limits.cpu_seconds);
}

void require_elements(double there, const std::string& of) {
  if (there > static_cast<double>(elements_set))
    throw LimitError(
        LimitError::Limit::kElements,
        fmt::format("{} has {:.0f} elements, and {} are allowed (`max_elements`)", of, there, elements_set.load()));
}

void require_expected_elements(double expected) {
  constexpr double kPrecision = 1.15;  // of predictions
  if (expected > kPrecision * static_cast<double>(elements_set))
    throw LimitError(LimitError::Limit::kElements,
                     fmt::format("the mesh would have about {:.3g} elements, and {} are allowed (`max_elements`): ask "
                                 "for larger sizes",
                                 expected, elements_set.load()));
}

std::uint64_t memory_at_most() {
  static const std::uint64_t of_machine = memory_of_machine();
  return std::min({memory_set.load(), of_machine, memory_of_system()});
}

void require_memory(double bytes, const std::string& what) {
  const auto most = static_cast<double>(memory_at_most());
  if (bytes > most)
    throw LimitError(LimitError::Limit::kMemory,
                     fmt::format("{} would take {} of memory, and {} may be taken (`memory`)", what,
                                 bytes_in_words(bytes), bytes_in_words(most)));
}

double cpu_seconds_left() {
  return std::max(0.0, seconds_set - cpu_seconds());
}

void count_ended_programs() {
#ifndef _WIN32
  if (std::isfinite(seconds_set.load()) && !is_time_over) watch_time(cpu_seconds_left());
#endif
}

void check_cpu_seconds() {
  if (is_time_over.load(std::memory_order_relaxed))
    throw LimitError(LimitError::Limit::kCpuSeconds,
                     "the CPU seconds that it may take are spent (`cpu_seconds`); no result was written");
}

}  // namespace octafront
