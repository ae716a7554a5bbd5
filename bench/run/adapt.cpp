// The cases of the Unstructured Grid Adaptation Working Group: adapts a mesh to one of their metrics, and tells how it
// fits as JSON. bench/run/adapt.py runs it.

#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/io.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string_view>

#include <fmt/core.h>

using namespace octafront;

namespace {

using Tensor = std::array<std::array<double, 3>, 3>;

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A layer of .001 at z = .5, .1 along it.
Tensor linear(Vec3 p) {
  const double h = 0.001 + 0.198 * std::abs(p.z - 0.5);
  return {{{100, 0, 0}, {0, 100, 0}, {0, 0, 1 / (h * h)}}};
}

/// A layer of .001 at r = .5; around it .1, or of polar-2 .025 near it.
Tensor polar(Vec3 p, bool is_second) {
  const double r = std::hypot(p.x, p.y), c = p.x / r, s = p.y / r;
  const double along_r = 0.001 + 0.198 * std::abs(r - 0.5), d = std::min(10 * (0.6 - r), 1.0);
  const double around = !is_second || d < 0 ? 0.1 : d / 40 + (1 - d) * 0.1;
  const double a = 1 / (along_r * along_r), b = 1 / (around * around);
  return {{{a * c * c + b * s * s, (a - b) * c * s, 0}, {(a - b) * c * s, a * s * s + b * c * c, 0}, {0, 0, 100}}};
}

}  // namespace

int main(int count, char** words) try {
  if (count != 3) return std::fputs("usage: octafront_adapt_cases MESH linear|polar-1|polar-2\n", stderr), 2;
  const std::string_view which = words[2];
  const TetMesh mesh = read_mesh(words[1]);
  RunContext context;
  context.threads = 1;
  const MetricFunction metric = [&](Vec3 p) { return which == "linear" ? linear(p) : polar(p, which == "polar-2"); };
  const double start = cpu_seconds();
  const AdaptedMesh made = adapt_to_metric(mesh, metric, {}, context);
  const double seconds = cpu_seconds() - start;
  const MetricSummary& fit = made.after;
  fmt::print(
      "{{\"tets\": {}, \"complexity\": {:.6g}, \"edges\": {}, \"fitting\": {}, \"shortest\": {:.4f}, \"longest\": "
      "{:.4f}, "
      "\"quality_min\": {:.4f}, \"quality_mean\": {:.4f}, \"cpu\": {:.3f}}}\n",
      made.mesh.tets.size(), fit.complexity, fit.edges, fit.fitting, fit.shortest, fit.longest, fit.quality_min,
      fit.quality_mean, seconds);
  return 0;
} catch (const Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
