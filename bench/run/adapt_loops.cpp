// A mesh adapted to a small size and to a large one in turn, many times: how fast, how good, and what is left of the
// body. Usage: octafront_adapt_loops MESH SMALL LARGE LOOPS [SURFACE], sizes in parts of the diagonal, SURFACE what
// walls lie on; a line of JSON for each adaptation.

#include <octafront/adapt.h>
#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/quality.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>

#include <fmt/core.h>

namespace {

using namespace octafront;

constexpr double kPoor = 0.3;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double volume_of(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets) {
    const Vec3 a = mesh.points[t[0]];
    sum += dot(cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a), mesh.points[t[3]] - a) / 6;
  }
  return sum;
}

std::size_t poor_ones(const TetMesh& mesh) {
  std::size_t count = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    count += radius_ratio(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) < kPoor;
  return count;
}

TetMesh adapted(const TetMesh& mesh, double size, const Domain* surface) {
  Options options;
  options.size.size = size;
  RunContext context;
  context.threads = 1;
  const double start = cpu_seconds();
  AdaptedMesh made = adapt_existing(mesh, options, context, surface);
  const double seconds = cpu_seconds() - start;
  const QualitySummary quality = summarize_quality(made.mesh);
  fmt::print(
      "{{\"size\": {:.17g}, \"tets\": {}, \"cpu\": {:.4f}, \"edges\": {}, \"fitting\": {}, \"longest\": {:.4f}, "
      "\"beta_mean\": {:.5f}, \"beta_min\": {:.5f}, \"poor\": {}, \"deviation\": {:.4g}, \"bound\": {:.4g}, "
      "\"volume\": "
      "{:.17g}}}\n",
      size, made.mesh.tets.size(), seconds, made.after.edges, made.after.fitting, made.after.longest, quality.beta_mean,
      quality.beta_min, poor_ones(made.mesh), made.deviation.upper, made.deviation.bound, volume_of(made.mesh));
  std::fflush(stdout);
  return std::move(made.mesh);
}

}  // namespace

int main(int count, char** words) try {
  if (count != 5 && count != 6)
    return std::fputs("usage: octafront_adapt_loops MESH SMALL LARGE LOOPS [SURFACE]\n", stderr), 2;
  TetMesh mesh = read_mesh(words[1]);
  Vec3 low = mesh.points.at(0), high = low;
  for (const Vec3 p : mesh.points)
    for (int i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
  const double diagonal = length(high - low);
  std::optional<Domain> surface;
  if (count == 6) surface = open_domain(words[5]);
  const Domain* ground = surface ? &*surface : nullptr;
  const double whole = !surface                        ? volume_of(mesh)
                       : surface->true_volumes.empty() ? enclosed_volume(surface->surface)
                                                       : surface->true_volumes[0];
  fmt::print("{{\"volume\": {:.17g}, \"tets\": {}}}\n", whole, mesh.tets.size());
  for (int loop = 0; loop < std::atoi(words[4]); ++loop)
    mesh = adapted(adapted(mesh, diagonal * std::atof(words[2]), ground), diagonal * std::atof(words[3]), ground);
  return 0;
} catch (const Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
