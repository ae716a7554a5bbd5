#include "sizing/field/octree_corners.h"

#include "base/core/buckets.h"
#include "base/core/flat_map.h"
#include "base/core/parallel.h"

#include <algorithm>

namespace octafront {

namespace {

using Units = std::array<std::uint32_t, 3>;

/// The corners of the leaves, eight each, in slots: which of them are one, and their numbers in the order of the slots
/// that have them first. By several threads: equal ones fall into the same of some tables.
class Numbering {
 public:
  explicit Numbering(const Octree& tree) : tree_(tree), tables_(thread_count() == 1 ? 1 : kTables) {
    first_ = tables_.size() == 1 ? first_slots() : first_slots_by_table();
    number_.resize(first_.size());
    for (std::size_t i = 0; i < first_.size(); ++i)
      if (is_first(i)) number_[i] = corners_++;
    parallel_for(first_.size(), [&](std::size_t i) {
      if (!is_first(i)) number_[i] = number_[first_[i]];
    });
  }

  std::uint32_t corners() const { return corners_; }
  std::uint32_t of_slot(std::size_t slot) const { return number_[slot]; }
  /// Whether no slot before it has the same corner.
  bool is_first(std::size_t slot) const { return first_[slot] == slot; }
  /// REQUIRES: p is a corner.
  std::uint32_t find(Units p) const { return number_[*tables_[table_of(code(p))].find(code(p))]; }
  /// Corner i of a leaf has the halves of child i.
  Units position(std::size_t slot) const {
    const OctreeKey leaf = tree_.leaf(slot / 8);
    const Units lo = leaf.corner();
    const auto i = static_cast<std::uint32_t>(slot % 8);
    return {lo[0] + (i & 1) * leaf.side(), lo[1] + (i >> 1 & 1) * leaf.side(), lo[2] + (i >> 2) * leaf.side()};
  }

 private:
  static constexpr std::size_t kTables = 64;
  static constexpr int kRecentBits = 12;

  /// The table knows all corners; three of four are those of a leaf shortly before.
  std::vector<std::uint32_t> first_slots() {
    struct Recent {
      std::uint64_t code;
      std::uint32_t first;
    };
    std::vector<Recent> recent(std::size_t{1} << kRecentBits, {FlatKeys<std::uint64_t>::kEmpty, 0});
    std::vector<std::uint32_t> first(8 * tree_.size());
    tables_[0].reset(first.size() / 5);
    for (std::uint32_t i = 0; i < first.size(); ++i) {
      const std::uint64_t at = code(position(i));
      Recent& known = recent[FlatKeys<std::uint64_t>::hash(at) >> (64 - kRecentBits)];
      if (known.code != at) known = {at, tables_[0].find_or_add(at, i)};
      first[i] = known.first;
    }
    return first;
  }

  std::vector<std::uint32_t> first_slots_by_table() {
    std::vector<std::uint32_t> first(8 * tree_.size());
    const Buckets<> by_table(first.size(), tables_.size(), [&](std::size_t i, const auto& add) {
      add(table_of(code(position(i))), static_cast<std::uint32_t>(i));
    });
    parallel_for(
        tables_.size(),
        [&](std::size_t t) {
          tables_[t].reset(by_table[t].size() / 5);
          for (const std::uint32_t i : by_table[t]) first[i] = tables_[t].find_or_add(code(position(i)), i);
        },
        Split::kSingly);
    return first;
  }

  static std::uint64_t code(Units p) { return (std::uint64_t{p[0]} << 21 | p[1]) << 21 | p[2]; }
  /// Hashed twice: corners of large leaves differ in few bits, and the upper bits of one hash are the tables' own.
  std::size_t table_of(std::uint64_t code) const {
    const std::uint64_t once = FlatKeys<std::uint64_t>::hash(code);
    return (FlatKeys<std::uint64_t>::hash(once ^ once >> 32) >> 32) % tables_.size();
  }

  const Octree& tree_;
  std::vector<FlatMap<std::uint64_t, std::uint32_t>> tables_;  ///< from codes to the first slot
  std::vector<std::uint32_t> first_, number_;                  ///< per slot: the first with its corner, its number
  std::uint32_t corners_ = 0;
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
struct Masters {
  int count = 0;
  std::array<std::uint32_t, 4> corner{};
};

Masters masters_of(const OctreeCorners& corners, const Numbering& numbers, const HangingCorner& h) {
  const Units p = corners.position[h.corner], lo = h.on.corner();
  const std::uint32_t side = h.on.side();
  std::array<int, 2> half_axes{};
  int n = 0;
  for (int a = 0; a < 3; ++a) {
    if (p[a] != lo[a] && p[a] != lo[a] + side) half_axes[n++] = a;
  }
  Masters masters;
  for (int m = 0; m < 1 << n; ++m) {
    Units q = p;
    for (int k = 0; k < n; ++k) q[half_axes[k]] = lo[half_axes[k]] + (m >> k & 1 ? side : 0);
    masters.corner[masters.count++] = numbers.find(q);
  }
  return masters;
}

void find_shares(const HangingCorner& h, const Masters& masters, const std::vector<std::uint32_t>& slot,
                 ShareLists& lists) {
  const std::size_t first = lists.pool.size();
  const double weight = 1.0 / masters.count;
  for (int m = 0; m < masters.count; ++m) {
    const std::uint32_t master = masters.corner[m];
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
  constexpr std::size_t kRange = 8192;
  auto hanging = parallel_collect<HangingCorner>(
      corners.size(), kRange, [&](std::size_t begin, std::size_t end, std::vector<HangingCorner>& found) {
        for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c)
          if (incident[c] < octants_inside(corners.position[c]))
            found.push_back({c, larger_leaf_at(tree, corners.position[c])});
      });
  // The masters of a corner on a leaf of level l hang, if at all, on leaves of lower levels.
  std::stable_sort(hanging.begin(), hanging.end(),
                   [](const HangingCorner& a, const HangingCorner& b) { return a.on.level() < b.on.level(); });
  return hanging;
}

}  // namespace

std::vector<std::array<double, 8>> OctreeCorners::at_leaves(const std::vector<double>& of_corner) const {
  std::vector<std::array<double, 8>> result(of_leaf.size());
  parallel_for(of_leaf.size(), [&](std::size_t l) {
    for (int k = 0; k < 8; ++k) result[l][k] = of_corner[of_leaf[l][k]];
  });
  return result;
}

OctreeCorners octree_corners(const Octree& tree) {
  const Numbering numbers(tree);
  OctreeCorners corners;
  corners.of_leaf.resize(tree.size());
  corners.position.resize(numbers.corners());
  parallel_for(tree.size(), [&](std::size_t l) {
    for (std::uint32_t i = 0; i < 8; ++i) corners.of_leaf[l][i] = numbers.of_slot(8 * l + i);
  });
  parallel_for(8 * tree.size(), [&](std::size_t i) {
    if (numbers.is_first(i)) corners.position[numbers.of_slot(i)] = numbers.position(i);
  });
  const std::vector<HangingCorner> hanging = hanging_corners(tree, corners);
  std::vector<std::uint32_t> slot(corners.size(), 0);
  for (std::size_t i = 0; i < hanging.size(); ++i) slot[hanging[i].corner] = static_cast<std::uint32_t>(i + 1);
  ShareLists lists;
  lists.range.resize(hanging.size());
  std::vector<Masters> masters(hanging.size());
  parallel_for(hanging.size(), [&](std::size_t i) { masters[i] = masters_of(corners, numbers, hanging[i]); });
  for (std::size_t i = 0; i < hanging.size(); ++i) find_shares(hanging[i], masters[i], slot, lists);
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
