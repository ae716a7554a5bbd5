#pragma once

// What several threads would make of a run, found out by one: each task of parallel.h is timed, and the tasks of a
// region (a call of parallel.h) are given in thought to 2, 16 and 64 threads. The rest of a stage is serial. For
// measurements, on any machine: OCTAFRONT_FORECAST=16 in the environment switches it on, and code that asks how many
// threads there are is told 16. Without it a region costs one look at a bool.

#include <octafront/report.h>

#include "base/core/function_ref.h"

#include <array>
#include <cstddef>
#include <cstdint>

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

/// How many threads a run is to believe in; 0: nothing is counted.
std::size_t forecast_threads();

/// CPU seconds that the calling thread has used so far.
double thread_cpu_seconds();

/// Does task(0) ... task(tasks - 1) in turn, as one region, and says what was counted.
Forecast forecast_region(std::size_t tasks, FunctionRef<void(std::size_t)> task);

/// Between construction and destruction: enters into a stage's counters what is serial in it, and how long it would
/// take.
class StageForecast {
 public:
  explicit StageForecast(StageReport& report);
  ~StageForecast();
  StageForecast(const StageForecast&) = delete;
  StageForecast& operator=(const StageForecast&) = delete;

 private:
  StageReport& report_;
  Forecast before_;
  double start_ = 0;
};

}  // namespace octafront
