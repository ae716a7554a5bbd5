#include "rehearsal.h"

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/limits.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <fstream>
#include <string_view>

#include <fmt/core.h>
#ifndef _WIN32
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace octafront::cli {

namespace {

constexpr std::string_view kHdf5Begins = "\x89HDF\r\n\x1a\n";

/// Files of HDF5, and those of XDMF, whose numbers are in one beside it.
bool needs_hdf5(const std::filesystem::path& file) {
  std::array<char, kHdf5Begins.size()> first{};
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  std::ifstream(file, std::ios::binary).read(first.data(), first.size());
  return std::string_view(first.data(), first.size()) == kHdf5Begins || file.extension() == ".xdmf" ||
         file.extension() == ".xmf";
}

#ifdef _WIN32
// Processes cannot be copied.
void rehearse_reading(const std::filesystem::path&) {}
#else
[[noreturn]] void read_and_exit(const std::filesystem::path& file) {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  if (const double left = std::ceil(cpu_seconds_left()); std::isfinite(left)) {
    const rlimit seconds{static_cast<rlim_t>(left), static_cast<rlim_t>(left)};
    setrlimit(RLIMIT_CPU, &seconds);
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  try {
    static_cast<void>(read_mesh_file(file.string()));
  } catch (...) {  // Who reads it in earnest will say so.
  }
  ::_exit(0);
}

void rehearse_reading(const std::filesystem::path& file) {
  const pid_t child = ::fork();
  if (child < 0) return;  // no room for a process: what is read in earnest is probably fine
  if (child == 0) read_and_exit(file);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};
  if (WIFSIGNALED(status) && std::ranges::find(kCrashes, WTERMSIG(status)) != kCrashes.end())
    throw InputError(
        fmt::format("{}: the file is damaged: the HDF5 library crashes on it; export it again", file.string()));
}
#endif

}  // namespace

void rehearse_reading(const Arguments& arguments) {
  if (needs_hdf5(arguments.input)) rehearse_reading(arguments.input);
  for (const auto& file : arguments.bodies)
    if (file != arguments.input && needs_hdf5(file)) rehearse_reading(file);
}

}  // namespace octafront::cli
