#include "sizing/field/octree_corners.h"

#include "base/core/buckets.h"
#include "base/core/flat_map.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <memory>

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
    const auto count = [this](std::size_t begin, std::size_t end) {
      std::size_t sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += is_first(i);
      return sum;
    };
    corners_ = number_in_blocks(first_.size(), count, [this](std::size_t begin, std::size_t end, std::size_t next) {
      for (std::size_t i = begin; i < end; ++i)
        if (is_first(i)) number_[i] = static_cast<std::uint32_t>(next++);
      return next;
    });
    parallel_for(first_.size(), [&](std::size_t i) {
      if (!is_first(i)) number_[i] = number_[first_[i]];
    });
  }

  std::size_t corners() const { return corners_; }
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
  RawVector<std::uint32_t> first_slots() {
    struct Recent {
      std::uint64_t code;
      std::uint32_t first;
    };
    std::vector<Recent> recent(std::size_t{1} << kRecentBits, {FlatKeys<std::uint64_t>::kEmpty, 0});
    RawVector<std::uint32_t> first(8 * tree_.size());
    tables_[0].reset(first.size() / 5);
    for (std::uint32_t i = 0; i < first.size(); ++i) {
      const std::uint64_t at = code(position(i));
      Recent& known = recent[FlatKeys<std::uint64_t>::hash(at) >> (64 - kRecentBits)];
      if (known.code != at) known = {at, tables_[0].find_or_add(at, i)};
      first[i] = known.first;
    }
    return first;
  }

  RawVector<std::uint32_t> first_slots_by_table() {
    RawVector<std::uint32_t> first(8 * tree_.size());
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
  RawVector<std::uint32_t> first_, number_;                    ///< per slot: the first with its corner, its number
  std::size_t corners_ = 0;
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

using Shares = std::vector<OctreeCorners::Share>;

/// Adds a free corner to the list that begins at `first`; equal ones are merged.
void add_share(Shares& pool, std::size_t first, std::uint32_t corner, double weight) {
  for (std::size_t i = first; i < pool.size(); ++i) {
    if (pool[i].corner == corner) {
      pool[i].weight += weight;
      return;
    }
  }
  pool.push_back({corner, weight});
}

/// Where the shares of a hanging corner are.
struct ShareList {
  const Shares* pool = nullptr;
  std::uint32_t begin = 0, end = 0;

  std::span<const OctreeCorners::Share> list() const { return std::span(*pool).subspan(begin, end - begin); }
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

constexpr std::uint32_t kFree = 0xffffffff;

/// The shares of the hanging corners: `slot` says of each corner which of them it is, or kFree.
class ShareFinder {
 public:
  ShareFinder(const OctreeCorners& corners, const Numbering& numbers, const Buckets<HangingCorner>& by_level)
      : corners_(corners), numbers_(numbers), slot_(parallel_filled(corners.size(), kFree)), lists_(by_level.items()) {
    for (std::size_t l = 0; l < by_level.size(); ++l) find_shares(by_level[l], by_level.first(l));
  }

  bool hangs(std::size_t corner) const { return slot_[corner] != kFree; }
  std::span<const OctreeCorners::Share> operator[](std::size_t corner) const { return lists_[slot_[corner]].list(); }

 private:
  static constexpr std::size_t kAtOnce = 256;

  /// The masters of a corner on a leaf of one level hang, if at all, on leaves of lower levels: those are known.
  void find_shares(std::span<const HangingCorner> level, std::size_t first) {
    const std::size_t pools = pools_.size(), more = (level.size() + kAtOnce - 1) / kAtOnce;
    for (std::size_t k = 0; k < more; ++k) pools_.push_back(std::make_unique<Shares>());
    parallel_for(
        more,
        [&](std::size_t k) {
          for (std::size_t i = k * kAtOnce; i < std::min(level.size(), (k + 1) * kAtOnce); ++i)
            lists_[first + i] = shares_of(level[i], *pools_[pools + k]);
        },
        Split::kSingly);
    parallel_for(level.size(), [&](std::size_t i) { slot_[level[i].corner] = static_cast<std::uint32_t>(first + i); });
  }

  ShareList shares_of(const HangingCorner& h, Shares& pool) const {
    const Masters masters = masters_of(corners_, numbers_, h);
    const std::size_t first = pool.size();
    const double weight = 1.0 / masters.count;
    for (int m = 0; m < masters.count; ++m) {
      const std::uint32_t master = masters.corner[m];
      if (!hangs(master)) {
        add_share(pool, first, master, weight);
        continue;
      }
      for (const OctreeCorners::Share& s : (*this)[master]) add_share(pool, first, s.corner, weight * s.weight);
    }
    return {&pool, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(pool.size())};
  }

  const OctreeCorners& corners_;
  const Numbering& numbers_;
  std::vector<std::unique_ptr<Shares>> pools_;
  RawVector<std::uint32_t> slot_;
  RawVector<ShareList> lists_;
};

/// By the level of the leaf on which they hang.
Buckets<HangingCorner> hanging_corners(const Octree& tree, const OctreeCorners& corners) {
  constexpr std::size_t kRange = 1024;
  const auto hanging = parallel_collect<HangingCorner, RawVector<HangingCorner>>(
      corners.size(), kRange, [&](std::size_t begin, std::size_t end, std::vector<HangingCorner>& found) {
        for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c)
          if (corners.leaves[c].size() < static_cast<std::size_t>(octants_inside(corners.position[c])))
            found.push_back({c, larger_leaf_at(tree, corners.position[c])});
      });
  return {hanging.size(), OctreeKey::kMaxLevel + 1,
          [&](std::size_t i, const auto& add) { add(static_cast<std::size_t>(hanging[i].on.level()), hanging[i]); }};
}

/// Writes them corner by corner.
void set_shares(const ShareFinder& found, OctreeCorners& corners) {
  corners.first_share.resize(corners.size() + 1);
  const auto count = [&](std::size_t begin, std::size_t end) {
    std::size_t sum = 0;
    for (std::size_t c = begin; c < end; ++c)
      if (found.hangs(c)) sum += found[c].size();
    return sum;
  };
  const std::size_t all =
      number_in_blocks(corners.size(), count, [&](std::size_t begin, std::size_t end, std::size_t at) {
        for (std::size_t c = begin; c < end; ++c) {
          corners.first_share[c] = static_cast<std::uint32_t>(at);
          if (found.hangs(c)) at += found[c].size();
        }
        return at;
      });
  corners.first_share[corners.size()] = static_cast<std::uint32_t>(all);
  corners.shares.resize(all);
  parallel_for(corners.size(), [&](std::size_t c) {
    if (found.hangs(c)) std::ranges::copy(found[c], corners.shares.begin() + corners.first_share[c]);
  });
}

}  // namespace

RawVector<std::array<double, 8>> OctreeCorners::at_leaves(std::span<const double> of_corner) const {
  RawVector<std::array<double, 8>> result(of_leaf.size());
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
  corners.leaves = group_by_owner(corners.size(), static_cast<std::uint32_t>(8 * tree.size()),
                                  [&](std::uint32_t i) { return corners.of_leaf[i / 8][i % 8]; });
  set_shares(ShareFinder(corners, numbers, hanging_corners(tree, corners)), corners);
  return corners;
}

}  // namespace octafront
