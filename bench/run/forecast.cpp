#include "forecast.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <queue>
#include <vector>

namespace octafront {

namespace {

/// A region shorter than this gains nothing: to wake threads takes some microseconds.
constexpr double kWorthwhile = 20e-6;

/// What the calling thread has counted so far: in the task that it does, or in all.
thread_local Forecast of_thread;

/// What a clock's reading takes, the least of some.
double reading() {
  double least = 1;
  for (int k = 0; k < 100; ++k) {
    const double before = thread_cpu_seconds();
    least = std::min(least, thread_cpu_seconds() - before);
  }
  return least;
}

/// Tasks in their order, each to the thread that is free first.
double last_end(std::size_t threads, const std::vector<double>& tasks) {
  std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
  double last = 0;
  for (const double seconds : tasks) {
    double start = 0;
    if (free_at.size() == threads) start = free_at.top(), free_at.pop();
    free_at.push(start + seconds);
    last = std::max(last, start + seconds);
  }
  return last;
}

}  // namespace

void Forecast::add(const Forecast& other) {
  parallel += other.parallel, counting += other.counting, regions += other.regions;
  for (std::size_t k = 0; k < with.size(); ++k) with[k] += other.with[k];
}

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_shared(std::size_t threads, const std::vector<double>& tasks, double alone) {
  if (alone < kWorthwhile) return alone;
  return std::max(last_end(threads, tasks), alone / static_cast<double>(threads));
}

Forecast forecast_region(std::size_t tasks, FunctionRef<void(std::size_t)> task) {
  static const double kReading = reading();
  struct Outside {  // put back whatever a task throws
    Forecast all = of_thread;
    ~Outside() { of_thread = all; }
  } outside;
  const double start = thread_cpu_seconds();
  Forecast region;
  std::array<std::vector<double>, Forecast::kThreads.size()> seconds;
  for (std::vector<double>& of_tasks : seconds) of_tasks.resize(tasks);
  double before = thread_cpu_seconds();
  for (std::size_t i = 0; i < tasks; ++i) {
    of_thread = {};
    task(i);
    const double now = thread_cpu_seconds(), own = std::max(0.0, now - before - kReading - of_thread.counting);
    before = now;
    region.parallel += own;
    region.counting += of_thread.counting, region.regions += of_thread.regions;
    // Regions inside a task are done by all threads, too.
    for (std::size_t k = 0; k < seconds.size(); ++k) seconds[k][i] = own - of_thread.parallel + of_thread.with[k];
  }
  for (std::size_t k = 0; k < seconds.size(); ++k)
    region.with[k] = seconds_shared(Forecast::kThreads[k], seconds[k], region.parallel);
  ++region.regions;
  region.counting = thread_cpu_seconds() - start - region.parallel;
  outside.all.add(region);
  return region;
}

const Forecast& forecast_so_far() {
  return of_thread;
}

}  // namespace octafront
