#include "pipeline/stages/measure.h"

#include <octafront/tet_mesh.h>

#include "base/core/parallel.h"
#include "base/core/utf8.h"
#include "base/mesh/quality_sum.h"
#include "base/shared/packing.h"
#include "base/shared/shared_tets.h"
#include "improve/curved/curved.h"

#include <algorithm>
#include <cstring>

#ifdef _WIN32
#include "base/core/files_of_windows.h"

#include <psapi.h>
#else
#include <sys/resource.h>
#endif

namespace octafront {

namespace {

std::uint64_t edge_key(VertexIndex a, VertexIndex b) {
  return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

SizeSummary summarize(std::vector<std::uint64_t>& keys, const std::vector<Vec3>& points, const SizeField& sizes) {
  constexpr double kShortest = 0.7, kLongest = 1.4;  // the band in which users call a length "as asked"
  parallel_sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  SizeSummary summary;
  summary.edges = keys.size();
  if (keys.empty()) return summary;
  std::vector<double> ratios(keys.size());
  parallel_for(keys.size(), [&](std::size_t i) {
    const Vec3 a = points[keys[i] >> 32], b = points[keys[i] & 0xffffffffu];
    ratios[i] = distance(a, b) / sizes.at((a + b) * 0.5);
  });
  std::uint64_t within = 0;
  double sum = 0;
  for (const double ratio : ratios) {
    sum += ratio;
    within += ratio >= kShortest && ratio <= kLongest;
  }
  summary.mean_ratio = sum / static_cast<double>(keys.size());
  summary.share_within = static_cast<double>(within) / static_cast<double>(keys.size());
  return summary;
}

class Fnv {
 public:
  template <class T>
  void add(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 0x100000001b3ull;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

}  // namespace

SizeSummary summarize_surface_edges(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                    const SizeField& sizes) {
  std::vector<std::uint64_t> keys;
  keys.reserve(triangles.size() * 3);
  for (const auto& [a, b, c] : triangles) keys.insert(keys.end(), {edge_key(a, b), edge_key(b, c), edge_key(c, a)});
  return summarize(keys, points, sizes);
}

SizeSummary summarize_volume_edges(const TetMesh& mesh, const SizeField& sizes, const Comm& comm) {
  std::vector<std::uint64_t> keys;
  // Sorting every edge of a large mesh would cost a tenth of making it: an evenly spread part of the tets gives the
  // same shares to a third digit.
  constexpr std::size_t kSample = 100'000;
  const TetCounts counts = count_tets(mesh, comm);
  const std::size_t step = std::max<std::size_t>(1, counts.all / kSample);
  for (std::size_t t = (step - counts.before % step) % step; t < mesh.tets.size(); t += step)
    for (const auto& [i, j] : kTetEdges) keys.push_back(edge_key(mesh.tets[t][i], mesh.tets[t][j]));
  keys = gathered_lists(comm, keys, "edges");
  return summarize(keys, mesh.points, sizes);
}

void describe_sizes(const TetMesh& mesh, const SizeField& sizes, Report& report, const Comm& comm) {
  report.surface_edges = summarize_surface_edges(mesh.points, mesh.boundary, sizes);
  report.volume_edges = summarize_volume_edges(mesh, sizes, comm);
}

void describe_quality(const TetMesh& mesh, Report& report, const Comm& comm) {
  const std::vector<QualitySum> mine{sum_of_quality(mesh, count_tets(mesh, comm).before)};
  QualitySum all;
  for (const QualitySum& of_rank : gathered_lists(comm, mine, "quality")) all.add(of_rank);
  report.quality = all.finished();
  report.tets = report.quality.elements;
}

namespace {

std::vector<double> flat_volumes(const TetMesh& mesh) {
  std::vector<double> of_region;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const Vec3 p = mesh.points[a];
    if (mesh.region[t] >= of_region.size()) of_region.resize(mesh.region[t] + 1, 0);
    of_region[mesh.region[t]] += dot(cross(mesh.points[b] - p, mesh.points[c] - p), mesh.points[d] - p) / 6;
  }
  return of_region;
}

}  // namespace

void describe_regions(const TetMesh& mesh, Report& report, const Comm& comm) {
  const std::uint32_t here = mesh.region.empty() ? 0 : 1 + *std::ranges::max_element(mesh.region);
  std::uint32_t regions = 0;
  for (const std::uint32_t count : gathered_lists(comm, std::vector<std::uint32_t>{here}, "regions"))
    regions = std::max(regions, count);
  if (regions == 0) return;
  struct OfRegion {
    QualitySum quality;
    double volume = 0;
  };
  std::vector<OfRegion> mine(regions);
  const std::vector<QualitySum> quality = sums_of_regions(mesh, count_tets(mesh, comm).before, regions);
  for (std::uint32_t r = 0; r < regions; ++r) mine[r].quality = quality[r];
  const std::vector<double> volumes = mesh.order() > 1 ? curved_volumes(mesh) : flat_volumes(mesh);
  for (std::uint32_t r = 0; r < volumes.size(); ++r) mine[r].volume = volumes[r];
  std::vector<OfRegion> all(regions);
  const std::vector<OfRegion> of_ranks = gathered_lists(comm, mine, "regions");
  for (std::size_t i = 0; i < of_ranks.size(); ++i) {
    all[i % regions].quality.add(of_ranks[i].quality);
    all[i % regions].volume += of_ranks[i].volume;
  }
  report.regions.assign(regions, {});
  for (std::uint32_t r = 0; r < regions; ++r) {
    report.regions[r].volume = all[r].volume;
    report.regions[r].name = r < mesh.region_names.size() ? mesh.region_names[r] : std::string();
    NameCleaning().clean(report.regions[r].name);
    report.regions[r].quality = all[r].quality.finished();
  }
}

namespace {

/// add(hash) of one rank after the other.
template <class Add>
void add_by_ranks(Fnv& hash, const Comm& comm, const Add& add) {
  for (int rank = 0; rank < comm.size(); ++rank) {
    if (rank == comm.rank()) add(hash);
    hash = gathered_lists(comm, std::vector<Fnv>{hash}, "hash")[static_cast<std::size_t>(rank)];
  }
}

}  // namespace

std::uint64_t mesh_hash(const TetMesh& mesh, const Comm& comm) {
  Fnv hash;
  for (const Vec3& p : mesh.points)
    for (int axis = 0; axis < 3; ++axis) hash.add(p[axis]);
  add_by_ranks(hash, comm, [&](Fnv& h) {
    for (const Tet& tet : mesh.tets)
      for (const VertexIndex v : tet) h.add(v);
  });
  for (const Triangle& face : mesh.boundary)
    for (const VertexIndex v : face) hash.add(v);
  add_by_ranks(hash, comm, [&](Fnv& h) {
    for (const std::uint32_t region : mesh.region) h.add(region);
  });
  for (const std::uint32_t patch : mesh.patch) hash.add(patch);
  for (const auto& mids : mesh.mid_nodes)
    for (const VertexIndex v : mids) hash.add(v);
  for (const VertexIndex v : mesh.high_nodes) hash.add(v);
  for (const Triangle& face : mesh.interfaces)
    for (const VertexIndex v : face) hash.add(v);
  for (const std::uint32_t patch : mesh.interface_patch) hash.add(patch);
  return hash.value();
}

std::uint64_t peak_memory_bytes() {
#ifdef _WIN32
  PROCESS_MEMORY_COUNTERS counters{};
  GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters);
  return counters.PeakWorkingSetSize;
#else
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  constexpr std::uint64_t kBytesEach = 1;
#else
  constexpr std::uint64_t kBytesEach = 1024;
#endif
  return static_cast<std::uint64_t>(usage.ru_maxrss) * kBytesEach;
#endif
}

}  // namespace octafront
