#include "sizing/octree_corners.h"

#include "core/flat_map.h"

#include <algorithm>

namespace octafront {

namespace {

using Units = std::array<std::uint32_t, 3>;

/// Numbers positions in the order in which they are first asked for.
class Numbering {
 public:
  explicit Numbering(std::size_t expected) : number_(expected) {}

  std::uint32_t number_of(Units p, std::vector<Units>& positions) {
    const std::uint32_t number = number_.find_or_add(code(p), static_cast<std::uint32_t>(positions.size()));
    if (number == positions.size()) positions.push_back(p);
    return number;
  }
  /// REQUIRES: p has a number.
  std::uint32_t find(Units p) const { return *number_.find(code(p)); }

 private:
  static std::uint64_t code(Units p) { return (std::uint64_t{p[0]} << 21 | p[1]) << 21 | p[2]; }

  FlatMap<std::uint64_t, std::uint32_t> number_;
};

/// In how many of the eight directions a corner at p has space of the root cube.
int octants_inside(Units p) {
  int n = 8;
  for (const std::uint32_t x : p) n /= x == 0 || x == OctreeKey::kSide ? 2 : 1;
  return n;
}

struct HangingCorner {
  std::uint32_t corner;
  OctreeKey on;  ///< the larger leaf in whose edge or face it lies
};

/// The leaf around p of which p is no corner.
OctreeKey larger_leaf_at(const Octree& tree, Units p) {
  for (int m = 0; m < 8; ++m) {
    Units c = p;
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      if (m >> a & 1) inside = inside && c[a]-- > 0;
      inside = inside && c[a] < OctreeKey::kSide;
    }
    if (!inside) continue;
    const OctreeKey leaf = tree.leaf(tree.find(OctreeKey::containing(c[0], c[1], c[2])));
    const Units lo = leaf.corner();
    for (int a = 0; a < 3; ++a) {
      if (p[a] != lo[a] && p[a] != lo[a] + leaf.side()) return leaf;
    }
  }
  return OctreeKey();
}

/// Adds a free corner to the list that begins at `first`; equal ones are merged.
void add_share(std::vector<OctreeCorners::Share>& pool, std::size_t first, std::uint32_t corner, double weight) {
  for (std::size_t i = first; i < pool.size(); ++i) {
    if (pool[i].corner == corner) {
      pool[i].weight += weight;
      return;
    }
  }
  pool.push_back({corner, weight});
}

/// The shares of the hanging corners, in the order in which they are found.
struct ShareLists {
  std::vector<OctreeCorners::Share> pool;
  std::vector<std::array<std::uint32_t, 2>> range;  ///< per hanging corner: from where to where in the pool
};

/// The masters of a hanging corner: both ends along each axis on which it lies halfway.
void find_shares(const OctreeCorners& corners, const Numbering& numbers, const HangingCorner& h,
                 const std::vector<std::uint32_t>& slot, ShareLists& lists) {
  const Units p = corners.position[h.corner], lo = h.on.corner();
  const std::uint32_t side = h.on.side();
  std::array<int, 2> half_axes{};
  int n = 0;
  for (int a = 0; a < 3; ++a) {
    if (p[a] != lo[a] && p[a] != lo[a] + side) half_axes[n++] = a;
  }
  const std::size_t first = lists.pool.size();
  const double weight = n == 1 ? 0.5 : 0.25;
  for (int m = 0; m < 1 << n; ++m) {
    Units q = p;
    for (int k = 0; k < n; ++k) q[half_axes[k]] = lo[half_axes[k]] + (m >> k & 1 ? side : 0);
    const std::uint32_t master = numbers.find(q);
    if (slot[master] == 0) {
      add_share(lists.pool, first, master, weight);
      continue;
    }
    const auto [begin, end] = lists.range[slot[master] - 1];
    for (std::uint32_t i = begin; i < end; ++i) {
      const OctreeCorners::Share s = lists.pool[i];
      add_share(lists.pool, first, s.corner, weight * s.weight);
    }
  }
  lists.range[slot[h.corner] - 1] = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(lists.pool.size())};
}

std::vector<HangingCorner> hanging_corners(const Octree& tree, const OctreeCorners& corners) {
  std::vector<std::uint8_t> incident(corners.size(), 0);
  for (const auto& leaf : corners.of_leaf) {
    for (const std::uint32_t c : leaf) ++incident[c];
  }
  std::vector<HangingCorner> hanging;
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    if (incident[c] < octants_inside(corners.position[c])) {
      hanging.push_back({c, larger_leaf_at(tree, corners.position[c])});
    }
  }
  // The masters of a corner on a leaf of level l hang, if at all, on leaves of lower levels.
  std::stable_sort(hanging.begin(), hanging.end(),
                   [](const HangingCorner& a, const HangingCorner& b) { return a.on.level() < b.on.level(); });
  return hanging;
}

}  // namespace

OctreeCorners octree_corners(const Octree& tree) {
  OctreeCorners corners;
  Numbering numbers(tree.size() + tree.size() / 2);
  corners.of_leaf.resize(tree.size());
  for (std::size_t l = 0; l < tree.size(); ++l) {
    const Units lo = tree.leaf(l).corner();
    const std::uint32_t side = tree.leaf(l).side();
    for (std::uint32_t i = 0; i < 8; ++i) {
      const Units p{lo[0] + (i & 1) * side, lo[1] + (i >> 1 & 1) * side, lo[2] + (i >> 2) * side};
      corners.of_leaf[l][i] = numbers.number_of(p, corners.position);
    }
  }
  const std::vector<HangingCorner> hanging = hanging_corners(tree, corners);
  std::vector<std::uint32_t> slot(corners.size(), 0);
  for (std::size_t i = 0; i < hanging.size(); ++i) slot[hanging[i].corner] = static_cast<std::uint32_t>(i + 1);
  ShareLists lists;
  lists.range.resize(hanging.size());
  for (const HangingCorner& h : hanging) find_shares(corners, numbers, h, slot, lists);
  corners.first_share.reserve(corners.size() + 1);
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    corners.first_share.push_back(static_cast<std::uint32_t>(corners.shares.size()));
    if (slot[c] == 0) continue;
    const auto [begin, end] = lists.range[slot[c] - 1];
    corners.shares.insert(corners.shares.end(), lists.pool.begin() + begin, lists.pool.begin() + end);
  }
  corners.first_share.push_back(static_cast<std::uint32_t>(corners.shares.size()));
  return corners;
}

}  // namespace octafront
