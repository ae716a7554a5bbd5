#pragma once

// What several threads would make of a run, found out by one: each task of parallel.h is timed, and the tasks of a
// region (a call of parallel.h) are given in thought to 2, 16 and 64 threads. The rest is serial. For measurements, on
// any machine.

#include "base/core/function_ref.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace octafront {

/// Of regions, in CPU seconds of the thread that does them.
struct Forecast {
  static constexpr std::array<std::size_t, 3> kThreads{2, 16, 64};

  double parallel = 0;                         ///< in tasks
  std::array<double, kThreads.size()> with{};  ///< how long the regions would take with so many threads
  double counting = 0;                         ///< spent on this, by no fault of the run
  std::uint64_t regions = 0;

  void add(const Forecast& other);
};

/// CPU seconds that the calling thread has used so far.
double thread_cpu_seconds();

/// What the calling thread has counted so far: in the task that it does, or in all.
const Forecast& forecast_so_far();

/// How long a region takes with so many threads: its tasks take these seconds, inner regions shared, and `alone` on one
/// thread. One too short to wake threads for gains nothing.
double seconds_shared(std::size_t threads, const std::vector<double>& tasks, double alone);

/// Does task(0) ... task(tasks - 1) in turn, as one region, and says what was counted.
Forecast forecast_region(std::size_t tasks, FunctionRef<void(std::size_t)> task);

}  // namespace octafront
