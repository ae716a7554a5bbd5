#pragma once

#include <octafront/report.h>

#include <chrono>

namespace octafront {

/// CPU seconds (user and system) that this process has used so far, all threads together.
double process_cpu_seconds();

/// Fills in the times of a StageReport between its construction and destruction; then returns memory that was freed.
class StageTimer {
 public:
  explicit StageTimer(StageReport& report);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageReport& report_;
  std::chrono::steady_clock::time_point wall_start_;
  double cpu_start_;
};

}  // namespace octafront
