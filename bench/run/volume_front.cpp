// The options of the volume front, measured on surfaces that need no files: one line each with speed and quality.
// Usage: octafront_volume_front [LEVEL]  (icosphere of 20 * 4^LEVEL triangles; 5 gives 780,000 tetrahedra)

#include <octafront/quality.h>

#include "base/core/stage_timer.h"
#include "base/core/thread_limit.h"
#include "fill/front/fill.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <fmt/core.h>

using namespace octafront;

namespace {

double mean_edge(const SurfaceMesh& s) {
  double sum = 0;
  for (const Triangle& t : s.triangles)
    for (int i = 0; i < 3; ++i) sum += distance(s.points[t[i]], s.points[t[(i + 1) % 3]]);
  return sum / (3.0 * static_cast<double>(s.triangles.size()));
}

double counter(const StageReport& report, const std::string& name) {
  for (const auto& [key, value] : report.counters)
    if (key == name) return value;
  return 0;
}

void measure(const std::string& name, const SurfaceMesh& surface, const VolumeOptions& options) {
  StageReport report;
  TetMesh mesh;
  double seconds = 1e300;
  // The least of three: what the machine does beside only ever adds.
  for (int run = 0; run < 3; ++run) {
    report = {};
    const ThreadLimit one(1);
    const double start = process_cpu_seconds();
    mesh = fill_volume(surface, SizeField::uniform(mean_edge(surface)), options, {RunContext{}, report});
    seconds = std::min(seconds, process_cpu_seconds() - start);
  }
  const QualitySummary q = summarize_quality(mesh);
  const auto share = [&](std::uint64_t n) { return 100.0 * static_cast<double>(n) / static_cast<double>(q.elements); };
  fmt::print("| {} | {} | {:.0f} | {:.3f} | {:.1f} | {:.3f} | {} | {} |\n", name, q.elements,
             static_cast<double>(q.elements) / seconds / 1000, q.beta_mean, share(q.beta_classes[4]),
             share(q.beta_classes[0]), counter(report, "retries"), counter(report, "cavities"));
}

}  // namespace

int main(int argc, char** argv) {
  const SurfaceMesh sphere = testing::icosphere(argc > 1 ? std::atoi(argv[1]) : 5);
  const auto options = [](double distance, VolumeOptions::Ranking ranking, VolumeOptions::Core core) {
    VolumeOptions o;
    o.ideal_distance = distance;
    o.ranking = ranking;
    o.core = core;
    return o;
  };
  using Ranking = VolumeOptions::Ranking;
  using Core = VolumeOptions::Core;
  fmt::print(
      "| options | tetrahedra | thousands per CPU s | mean beta | % above .8 | % below .2 | retries | cavities |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (const double d : {0.6, 0.7, 0.75, 0.8165, 0.9, 1.0})
    measure(fmt::format("solid angle, ideal point at {} h", d), sphere, options(d, Ranking::kSolidAngle, Core::kOff));
  measure("quality, ideal point at 0.75 h", sphere, options(0.75, Ranking::kQuality, Core::kOff));
  for (const auto& [name, order] : {std::pair{"smallest of each layer first", VolumeOptions::Order::kSmallest},
                                    {"newest first", VolumeOptions::Order::kNewest}}) {
    VolumeOptions o = options(0.75, Ranking::kSolidAngle, Core::kOff);
    o.order = order;
    measure(fmt::format("{}, solid angle, 0.75 h", name), sphere, o);
  }
  measure("lattice core, solid angle, 0.75 h", sphere, options(0.75, Ranking::kSolidAngle, Core::kLattice));
}
