// One mesh by one thread that times every task: octafront_threads MODEL ELEMENTS MESH. Prints for bench/run/threads.py
// what is serial in each stage and in all, and how long 2, 16 and 64 threads would take, as JSON.

#include <octafront/octafront.h>

#include "base/core/parallel.h"
#include "forecast.h"

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace {

using namespace octafront;

/// What had been counted, and when.
struct Reading {
  Forecast counted = forecast_so_far();
  double seconds = thread_cpu_seconds();
};

std::string json_between(const Reading& from, const Reading& to) {
  const double whole = to.seconds - from.seconds - (to.counted.counting - from.counted.counting);
  const double serial = whole - (to.counted.parallel - from.counted.parallel);
  std::string json = fmt::format(R"("seconds": {:.6f}, "serial seconds": {:.6f}, "regions": {})", whole, serial,
                                 to.counted.regions - from.counted.regions);
  for (std::size_t k = 0; k < Forecast::kThreads.size(); ++k)
    json += fmt::format(R"(, "seconds with {} threads": {:.6f})", Forecast::kThreads[k],
                        serial + to.counted.with[k] - from.counted.with[k]);
  return "{" + json + "}";
}

void time_region(std::size_t tasks, FunctionRef<void(std::size_t)> task) {
  forecast_region(tasks, task);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  constexpr ParallelHook kHook{16, time_region};
  const Reading start;
  set_parallel_hook(&kHook);
  std::vector<std::pair<std::string, Reading>> stages;  // with their beginnings
  RunContext context;
  context.progress = [&](std::string_view stage, double) {
    if (stages.empty() || stages.back().first != stage) stages.emplace_back(stage, Reading());
  };
  Options options;
  context.threads = 1;
  options.size.elements = std::atoll(arguments[2]);
  const Result result = generate(read_surface(arguments[1]).surface, options, context);
  stages.emplace_back("", Reading());
  write_mesh(arguments[3], result.mesh);
  fmt::print("{{\"tets\": {}, \"hash\": \"{:016x}\", \"stages\": [", result.report.tets, result.report.hash);
  for (std::size_t s = 0; s + 1 < stages.size(); ++s)
    fmt::print("{}[\"{}\", {}]", s > 0 ? ", " : "", stages[s].first,
               json_between(stages[s].second, stages[s + 1].second));
  fmt::print("], \"whole\": {}}}\n", json_between(start, Reading()));
}
