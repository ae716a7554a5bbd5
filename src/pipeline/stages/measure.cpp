#include "pipeline/stages/measure.h"

#include <octafront/tet_mesh.h>

#include "base/core/parallel.h"
#include "base/core/random.h"
#include "base/core/utf8.h"
#include "base/mesh/quality_sum.h"
#include "base/shared/packing.h"
#include "base/shared/shared_tets.h"
#include "improve/curved/curved.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>
#include <utility>

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

using EdgeKeys = RawVector<std::uint64_t>;

/// The edges of rows first, first + step ... as keys; `add` gives those of a row to a list.
template <class Add>
EdgeKeys keys_of_edges(std::size_t rows, const Add& add) {
  constexpr std::size_t kRows = 4096;
  return parallel_collect<std::uint64_t, EdgeKeys>(
      rows, kRows, [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& keys) {
        for (std::size_t row = begin; row < end; ++row) add(row, keys);
      });
}

EdgeKeys each_once(EdgeKeys sorted) {
  return keys_of_edges(sorted.size(), [&](std::size_t i, std::vector<std::uint64_t>& once) {
    if (i == 0 || sorted[i] != sorted[i - 1]) once.push_back(sorted[i]);
  });
}

SizeSummary summarize(EdgeKeys keys, const std::vector<Vec3>& points, const SizeField& sizes) {
  constexpr double kShortest = 0.7, kLongest = 1.4;  // the band in which users call a length "as asked"
  parallel_sort(keys);
  keys = each_once(std::move(keys));
  SizeSummary summary;
  summary.edges = keys.size();
  if (keys.empty()) return summary;
  RawVector<double> ratios(keys.size());
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

/// The hash of an item, of which `place` is the number: its bytes, eight at a time, mixed one behind the other.
template <class Item>
std::uint64_t hash_of_item(const Item& item, std::uint64_t place) {
  static_assert(std::has_unique_object_representations_v<Item> || std::is_same_v<Item, Vec3>);
  std::array<std::uint64_t, (sizeof(Item) + 7) / 8> words{};
  std::memcpy(words.data(), &item, sizeof(Item));
  std::uint64_t hash = mixed_bits(place);  // else place and label would stand for each other
  for (const std::uint64_t word : words) hash = mixed_bits(hash ^ word);
  return hash;
}

/// What all items of some arrays add up to, each hashed with its place: in any order, by any number of threads and
/// ranks, the same sum.
class MeshHash {
 public:
  explicit MeshHash(const Comm& comm) : comm_(comm) {}

  template <class Item>
  void add(const std::vector<Item>& items) {
    add_sum(items.size(), sum_of(items, 0));
  }
  /// Of items that the ranks hold in shares.
  template <class Item>
  void add_shares(const std::vector<Item>& items) {
    std::uint64_t before = 0, all = 0, sum = 0;
    const std::vector<std::uint64_t> counts = gathered_lists(comm_, std::vector<std::uint64_t>{items.size()}, "hash");
    for (std::size_t rank = 0; rank < counts.size(); ++rank) {
      if (rank < static_cast<std::size_t>(comm_.rank())) before += counts[rank];
      all += counts[rank];
    }
    for (const std::uint64_t of_rank : gathered_lists(comm_, std::vector<std::uint64_t>{sum_of(items, before)}, "hash"))
      sum += of_rank;
    add_sum(all, sum);
  }
  std::uint64_t value() const { return hash_; }

 private:
  /// `before`: how many there are before the first of these.
  template <class Item>
  static std::uint64_t sum_of(const std::vector<Item>& items, std::uint64_t before) {
    return parallel_sum(items.size(), [&](std::size_t begin, std::size_t end) {
      std::uint64_t sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += hash_of_item(items[i], before + i);
      return sum;
    });
  }
  void add_sum(std::uint64_t items, std::uint64_t sum) { hash_ = mixed_bits(mixed_bits(hash_ ^ items) ^ sum); }

  const Comm& comm_;
  std::uint64_t hash_ = 0;
};

}  // namespace

SizeSummary summarize_surface_edges(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                    const SizeField& sizes) {
  EdgeKeys keys = keys_of_edges(triangles.size(), [&](std::size_t t, std::vector<std::uint64_t>& found) {
    const auto& [a, b, c] = triangles[t];
    found.insert(found.end(), {edge_key(a, b), edge_key(b, c), edge_key(c, a)});
  });
  return summarize(std::move(keys), points, sizes);
}

SizeSummary summarize_volume_edges(const TetMesh& mesh, const SizeField& sizes, const Comm& comm) {
  // Sorting every edge of a large mesh would cost a tenth of making it: an evenly spread part of the tets gives the
  // same shares to a third digit.
  constexpr std::size_t kSample = 100'000;
  const TetCounts counts = count_tets(mesh, comm);
  const std::size_t step = std::max<std::size_t>(1, counts.all / kSample);
  const std::size_t first = (step - counts.before % step) % step;
  const std::size_t looked_at = mesh.tets.size() > first ? (mesh.tets.size() - first + step - 1) / step : 0;
  EdgeKeys keys = keys_of_edges(looked_at, [&](std::size_t k, std::vector<std::uint64_t>& found) {
    const Tet& tet = mesh.tets[first + k * step];
    for (const auto& [i, j] : kTetEdges) found.push_back(edge_key(tet[i], tet[j]));
  });
  if (!comm.alone()) {
    const auto all = gathered_lists(comm, std::vector<std::uint64_t>(keys.begin(), keys.end()), "edges");
    keys.assign(all.begin(), all.end());
  }
  return summarize(std::move(keys), mesh.points, sizes);
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

std::uint64_t mesh_hash(const TetMesh& mesh, const Comm& comm) {
  MeshHash hash(comm);
  hash.add(mesh.points);
  hash.add_shares(mesh.tets);
  hash.add(mesh.boundary);
  hash.add_shares(mesh.region);
  hash.add(mesh.patch);
  hash.add(mesh.mid_nodes);
  hash.add(mesh.high_nodes);
  hash.add(mesh.interfaces);
  hash.add(mesh.interface_patch);
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
