#include "adapt/carry/same_items.h"

#include "base/core/parallel.h"
#include "base/mesh/tet_key.h"

#include <algorithm>
#include <array>
#include <utility>

namespace octafront::adapt {
namespace {

using Place = std::array<double, 3>;

Place place_of(Vec3 p) {
  return {p.x, p.y, p.z};
}

struct NodeAt {
  Place place;
  VertexIndex node;
  bool operator<(const NodeAt& o) const { return std::pair(place, node) < std::pair(o.place, o.node); }
};

struct NamedTet {
  Tet key;
  TetIndex tet;
  bool operator<(const NamedTet& o) const { return std::pair(key, tet) < std::pair(o.key, o.tet); }
};

void find_nodes(const TetMesh& before, const TetMesh& now, SameItems& same) {
  std::vector<NodeAt> sorted(before.points.size());
  for (VertexIndex v = 0; v < sorted.size(); ++v) sorted[v] = {place_of(before.points[v]), v};
  parallel_sort(sorted);
  same.old_of_new.assign(now.points.size(), kNone);
  same.several = parallel_sum(now.points.size(), [&](std::size_t begin, std::size_t end) {
    std::uint64_t several = 0;
    for (std::size_t v = begin; v < end; ++v) {
      const Place place = place_of(now.points[v]);
      const auto at = std::lower_bound(sorted.begin(), sorted.end(), NodeAt{place, 0});
      if (at == sorted.end() || at->place != place) continue;
      same.old_of_new[v] = at->node;
      several += at + 1 != sorted.end() && (at + 1)->place == place;
    }
    return several;
  });
}

/// The name of a new tet by old nodes; of one that has others there is none.
bool name_by_old(const Tet& t, const std::vector<VertexIndex>& old_of_new, Tet& key) {
  Tet old;
  for (std::size_t i = 0; i < 4; ++i)
    if ((old[i] = old_of_new[t[i]]) == kNone) return false;
  key = tet_key(old);
  return true;
}

}  // namespace

SameItems same_items(const TetMesh& before, const TetMesh& now, const MatchedRegions& regions) {
  SameItems same;
  find_nodes(before, now, same);
  same.old_tet_of_new.assign(now.tets.size(), kNone);
  std::vector<std::uint8_t> is_there(before.points.size(), 0);
  for (const VertexIndex v : same.old_of_new)
    if (v != kNone) is_there[v] = 1;
  std::vector<NamedTet> sorted;
  for (TetIndex t = 0; t < before.tets.size(); ++t)
    if (const Tet& tet = before.tets[t]; is_there[tet[0]] && is_there[tet[1]] && is_there[tet[2]] && is_there[tet[3]])
      sorted.push_back({tet_key(tet), t});
  parallel_sort(sorted);
  parallel_for(sorted.empty() ? 0 : now.tets.size(), [&](std::size_t number) {
    const auto t = static_cast<TetIndex>(number);
    Tet key;
    if (!name_by_old(now.tets[t], same.old_of_new, key)) return;
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), NamedTet{key, 0});
    if (at != sorted.end() && at->key == key && regions.of_old(at->tet) == regions.of_new(t))
      same.old_tet_of_new[t] = at->tet;
  });
  return same;
}

}  // namespace octafront::adapt
