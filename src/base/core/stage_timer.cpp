#include "base/core/stage_timer.h"

#include "base/core/freed_memory.h"

#ifdef _WIN32
#include "base/core/files_of_windows.h"
#else
#include <sys/resource.h>
#endif

namespace octafront {

double process_cpu_seconds() {
#ifdef _WIN32
  FILETIME ignored{}, system{}, user{};
  GetProcessTimes(GetCurrentProcess(), &ignored, &ignored, &system, &user);
  const auto seconds = [](FILETIME t) { return 1e-7 * (0x1p32 * t.dwHighDateTime + t.dwLowDateTime); };
  return seconds(user) + seconds(system);
#else
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
#endif
}

StageTimer::StageTimer(StageReport& report)
    : report_(report), wall_start_(std::chrono::steady_clock::now()), cpu_start_(process_cpu_seconds()) {}

StageTimer::~StageTimer() {
  report_.wall_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count();
  report_.cpu_seconds += process_cpu_seconds() - cpu_start_;
  return_freed_memory();
}

}  // namespace octafront
