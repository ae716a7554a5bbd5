#pragma once

#include <octafront/vec.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace octafront::surface {

struct NoData {};

/// Finds points near a place, for points that each have a size of their own. A point lives in the grid of the level of
/// its size, which is in [2^level, 2^(level+1)), in cells of side 2^(level+2): points lie on a surface, so most cells
/// are empty, and larger ones are fewer to look at. A query looks only at levels near its own: sizes are graded, so
/// points of very different size are never neighbours. Cells know whether there are points in their children, which is
/// rare: nobody looks for them in vain. `Data` is what visitors want to know of points without looking elsewhere.
template <class Data>
class PointGrid {
 public:
  struct Entry {
    Vec3 p;
    double size;
    std::uint32_t id;
    Data data;
  };

  explicit PointGrid(Vec3 origin) : origin_(origin) { cells_.resize(1 << 8); }

  /// Ids are to be added as 0, 1, 2 ...
  void add(Vec3 p, double size, const Data& data = {}) {
    const int level = std::ilogb(size);
    highest_ = points_ == 0 ? level : std::max(highest_, level);
    largest_ = std::max(largest_, size);
    const Index at = index_of(p, level);
    const std::uint64_t key = key_of(at, level);
    const Cell* known = find(key);
    if (!known || known->page == kNoPage) make_cell(key_of(parent_of(at), level + 1)).has_finer = true;
    append(make_cell(key), {p, size, points_++, data});
  }

  /// Calls visit(entry) for every point nearer to p than `reach` times the mean of `size` and its own size (rounded up
  /// to a power of two, so some are farther), if the sizes are within a factor of two to four.
  template <class Visit>
  void for_each_near(Vec3 p, double size, double reach, Visit visit) const {
    const int level = std::ilogb(size);
    visit_level(p, size, reach, level, visit, [&](const Cell& cell, Index at) {
      if (!cell.has_finer) return;
      const Range below = range_of(p, size, reach, level - 1);
      for_each_index(children_within(at, below), [&](Index child) {
        if (const Cell* c = find(key_of(child, level - 1))) visit_cell(*c, p, below.radius * below.radius, visit);
      });
    });
    if (level < highest_) visit_level(p, size, reach, level + 1, visit, [](const Cell&, Index) {});
  }

 private:
  static constexpr std::uint32_t kNoPage = 0xffffffffu;

  struct Index {
    std::int64_t x, y, z;
  };
  struct Range {
    Index lo, hi;
    double radius;
  };
  /// A slot of the hash table.
  struct Cell {
    std::uint64_t key = 0;
    std::uint32_t page = kNoPage;  ///< of its points: the last one
    bool is_used = false, has_finer = false;
  };
  /// Points of one cell: where they are side by side in memory, for most are too far.
  struct Page {
    static constexpr std::uint32_t kRoom = 6;
    std::array<Vec3, kRoom> places;
    std::uint32_t count = 0, next = kNoPage;
    std::array<Entry, kRoom> entries;
  };

  static double power_of_two(int level) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(level + 1023) << 52);
  }
  Index index_of(Vec3 p, int level) const {
    const double scale = 0.25 / power_of_two(level);
    const auto index = [&](double x) {  // std::floor() and std::ldexp() are calls
      const auto towards_zero = static_cast<std::int64_t>(x * scale);
      return towards_zero - (static_cast<double>(towards_zero) > x * scale);
    };
    const Vec3 d = p - origin_;
    return {index(d.x), index(d.y), index(d.z)};
  }
  static Index parent_of(Index i) { return {i.x >> 1, i.y >> 1, i.z >> 1}; }
  static Range children_within(Index i, const Range& r) {
    return {{std::max(2 * i.x, r.lo.x), std::max(2 * i.y, r.lo.y), std::max(2 * i.z, r.lo.z)},
            {std::min(2 * i.x + 1, r.hi.x), std::min(2 * i.y + 1, r.hi.y), std::min(2 * i.z + 1, r.hi.z)},
            r.radius};
  }
  Range range_of(Vec3 p, double size, double reach, int level) const {
    const double radius = 0.5 * reach * (size + std::min(2 * power_of_two(level), largest_));
    const Vec3 r{radius, radius, radius};
    return {index_of(p - r, level), index_of(p + r, level), radius};
  }
  static std::uint64_t key_of(Index c, int level) {
    std::uint64_t k = static_cast<std::uint64_t>(c.x) * 0x9e3779b97f4a7c15ull;
    k = (k ^ (k >> 29)) + static_cast<std::uint64_t>(c.y) * 0xbf58476d1ce4e5b9ull;
    k = (k ^ (k >> 31)) + static_cast<std::uint64_t>(c.z) * 0x94d049bb133111ebull;
    k = (k ^ (k >> 30)) + static_cast<std::uint64_t>(level) * 0xd6e8feb86659fd93ull;
    return k ^ (k >> 32);
  }

  std::size_t slot_of(std::uint64_t key) const {
    std::size_t slot = key & (cells_.size() - 1);
    while (cells_[slot].is_used && cells_[slot].key != key) slot = (slot + 1) & (cells_.size() - 1);
    return slot;
  }
  const Cell* find(std::uint64_t key) const {
    const Cell& cell = cells_[slot_of(key)];
    return cell.is_used ? &cell : nullptr;
  }
  /// That cell, which is there from now on.
  Cell& make_cell(std::uint64_t key) {
    std::size_t slot = slot_of(key);
    if (cells_[slot].is_used) return cells_[slot];
    if (2 * ++used_ > cells_.size()) {
      grow();
      slot = slot_of(key);
    }
    cells_[slot].key = key;
    cells_[slot].is_used = true;
    return cells_[slot];
  }
  void grow() {
    std::vector<Cell> old(2 * cells_.size());
    old.swap(cells_);
    for (const Cell& cell : old)
      if (cell.is_used) cells_[slot_of(cell.key)] = cell;
  }
  void append(Cell& cell, const Entry& entry) {
    if (cell.page == kNoPage || pages_[cell.page].count == Page::kRoom) {
      pages_.emplace_back();
      pages_.back().next = cell.page;
      cell.page = static_cast<std::uint32_t>(pages_.size() - 1);
    }
    Page& page = pages_[cell.page];
    page.places[page.count] = entry.p;
    page.entries[page.count++] = entry;
  }

  template <class Visit>
  static void for_each_index(const Range& r, const Visit& visit) {
    for (std::int64_t z = r.lo.z; z <= r.hi.z; ++z) {
      for (std::int64_t y = r.lo.y; y <= r.hi.y; ++y) {
        for (std::int64_t x = r.lo.x; x <= r.hi.x; ++x) visit(Index{x, y, z});
      }
    }
  }
  template <class Visit, class VisitCell>
  void visit_level(Vec3 p, double size, double reach, int level, Visit& visit, const VisitCell& also) const {
    const Range range = range_of(p, size, reach, level);
    for_each_index(range, [&](Index at) {
      const Cell* cell = find(key_of(at, level));
      if (!cell) return;
      visit_cell(*cell, p, range.radius * range.radius, visit);
      also(*cell, at);
    });
  }
  template <class Visit>
  void visit_cell(const Cell& cell, Vec3 p, double square, Visit& visit) const {
    for (std::uint32_t i = cell.page; i != kNoPage; i = pages_[i].next) {
      const Page& page = pages_[i];
      for (std::uint32_t k = 0; k < page.count; ++k) {
        if (squared_length(page.places[k] - p) < square) visit(page.entries[k]);
      }
    }
  }

  Vec3 origin_;
  std::vector<Cell> cells_;  ///< open addressing; the size is a power of two
  std::vector<Page> pages_;
  std::size_t used_ = 0;  ///< cells
  std::uint32_t points_ = 0;
  int highest_ = 0;
  double largest_ = 0;
};

}  // namespace octafront::surface
