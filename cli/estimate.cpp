#include "estimate.h"

#include <octafront/limits.h>

#include "presets.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <thread>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

// What an element and a face of the boundary take, by `bench/run.sh dry_run --fit` on one thread: the front works at
// the boundary, the lattice fills the inside.
struct Cost {
  double per_tet, per_face;
  double of(const Estimate& e) const { return per_tet * e.tets + per_face * e.boundary_faces; }
};
constexpr Cost kFillSeconds{2e-6, 12e-6}, kImproveSeconds{0.6e-6, 9e-6}, kBytes{41, 310}, kFileBytes{8.4, 35};
// The same of triangles that are kept and longer than the sizes: for each size along their longest edges beyond two.
constexpr double kFillPerSizeOfEdge = 0.1e-3, kImprovePerSizeOfEdge = 0.25e-3;
constexpr double kBytesOfProgram = 27e6;
/// Twice as many threads take about 1 / 1.7 of the time.
constexpr double kThreadPower = 0.75;

/// Against the default level.
double improvement_share(ImproveOptions::Level level) {
  switch (level) {
    case ImproveOptions::Level::kOff:
      return 0;
    case ImproveOptions::Level::kPaper:
      return 0.3;
    case ImproveOptions::Level::kFast:
      return 0.45;
    case ImproveOptions::Level::kBest:
      return 6.5;
    default:
      return 1;
  }
}

/// What a stage counted, the last one that did; 0 if none did.
double counted_as(std::string_view name, const Report& report) {
  double count = 0;
  for (const StageReport& stage : report.stages)
    for (const auto& [key, value] : stage.counters)
      if (key == name) count = value;
  return count;
}

std::string time_in_words(double seconds) {
  if (seconds < 60) return fmt::format("{:.2g} s", std::max(0.1, seconds));
  return fmt::format("{:.0f} min", std::ceil(seconds / 60));
}

}  // namespace

Estimate estimate_run(const Report& sizes, const Options& options, int threads) {
  const int machine = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const double used = threads > 0 ? std::min(threads, machine) : machine;
  Estimate e;
  e.tets = sizes.expected_tets;
  e.boundary_faces = counted_as("triangles", sizes);
  const double long_edges = counted_as("sizes along long edges", sizes),
               improving = improvement_share(options.improve.level);
  const double work = kFillSeconds.of(e) + improving * kImproveSeconds.of(e) +
                      long_edges * (kFillPerSizeOfEdge + improving * kImprovePerSizeOfEdge);
  // Of the processor, not the clock: what else the machine does now is not this run's.
  if (options.method == Method::kOctreeAft) e.seconds = (sizes.cpu_seconds + work) / std::pow(used, kThreadPower);
  e.memory_bytes = std::max(static_cast<double>(sizes.peak_memory_bytes), kBytesOfProgram + kBytes.of(e));
  e.file_bytes = kFileBytes.of(e);
  return e;
}

void tell_estimate(Session& session, const SizeResult& sizes) {
  const Arguments& a = session.arguments();
  const Estimate e = estimate_run(sizes.report, with_preset(a), a.threads);
  session.tell(sizes.report);
  session.found({{"dry_run",
                  {{"expected_tets", e.tets},
                   {"smallest_size", sizes.sizes.min_size()},
                   {"largest_size", sizes.sizes.max_size()},
                   {"boundary_faces", e.boundary_faces},
                   {"seconds", e.seconds ? Json(*e.seconds) : Json()},
                   {"memory_bytes", e.memory_bytes},
                   {"file_bytes", e.file_bytes}}}});
  const std::string time =
      e.seconds ? "about " + time_in_words(*e.seconds) + " in all" : "time: not known for this method";
  session.say(
      fmt::format("\ndry run: nothing was made. About {:.3g} elements, sizes from {:.4g} to {:.4g}; {}, {} of memory, "
                  "a .vtu of {}\n",
                  e.tets, sizes.sizes.min_size(), sizes.sizes.max_size(), time, bytes_in_words(e.memory_bytes),
                  bytes_in_words(e.file_bytes)));
}

}  // namespace octafront::cli
