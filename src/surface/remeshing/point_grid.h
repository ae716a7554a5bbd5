#pragma once

#include <octafront/vec.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace octafront::remeshing {

/// Finds points near a place, for points that each have a size of their own. A point lives in the grid of the level of
/// its size, which is in [2^level, 2^(level+1)), in cells of side 2^(level+2): points lie on a surface, so most cells
/// are empty, and larger ones are fewer to look at. A query looks only at levels near its own: sizes are graded, so
/// points of very different size are never neighbours.
class PointGrid {
 public:
  explicit PointGrid(Vec3 origin) : origin_(origin) { table_.assign(1 << 10, kEmpty); }

  /// Ids are to be added as 0, 1, 2 ...
  void add(Vec3 p, double size) {
    if (2 * (points_.size() + 1) > table_.size()) grow();
    const int level = std::ilogb(size);
    lowest_ = points_.empty() ? level : std::min(lowest_, level);
    highest_ = points_.empty() ? level : std::max(highest_, level);
    largest_ = std::max(largest_, size);
    points_.push_back({p, key_of(cell_of(p, level), level), kEmpty});
    link(static_cast<std::uint32_t>(points_.size() - 1));
  }

  /// Calls visit(id, point) for every point nearer to p than `reach` times the mean of `size` and its own size (rounded
  /// up to a power of two, so some are farther), if the sizes are within a factor of two to four.
  template <class Visit>
  void for_each_near(Vec3 p, double size, double reach, Visit visit) const {
    const int level = std::ilogb(size);
    for (int l = std::max(level - kLevels, lowest_); l <= std::min(level + kLevels, highest_); ++l) {
      const double radius = 0.5 * reach * (size + std::min(std::ldexp(2.0, l), largest_));
      const Cell lo = cell_of(p - Vec3{radius, radius, radius}, l), hi = cell_of(p + Vec3{radius, radius, radius}, l);
      for (std::int64_t z = lo.z; z <= hi.z; ++z) {
        for (std::int64_t y = lo.y; y <= hi.y; ++y) {
          for (std::int64_t x = lo.x; x <= hi.x; ++x) visit_cell({x, y, z}, l, p, radius, visit);
        }
      }
    }
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffffu;
  static constexpr int kLevels = 1;

  struct Cell {
    std::int64_t x, y, z;
  };
  struct Entry {
    Vec3 p;
    std::uint64_t key;
    std::uint32_t next;
  };

  Cell cell_of(Vec3 p, int level) const {
    const double scale = std::ldexp(0.25, -level);
    const auto index = [&](double x) { return static_cast<std::int64_t>(std::floor(x * scale)); };
    const Vec3 d = p - origin_;
    return {index(d.x), index(d.y), index(d.z)};
  }
  static std::uint64_t key_of(Cell c, int level) {
    std::uint64_t k = static_cast<std::uint64_t>(c.x) * 0x9e3779b97f4a7c15ull;
    k = (k ^ (k >> 29)) + static_cast<std::uint64_t>(c.y) * 0xbf58476d1ce4e5b9ull;
    k = (k ^ (k >> 31)) + static_cast<std::uint64_t>(c.z) * 0x94d049bb133111ebull;
    k = (k ^ (k >> 30)) + static_cast<std::uint64_t>(level) * 0xd6e8feb86659fd93ull;
    return k ^ (k >> 32);
  }
  void link(std::uint32_t id) {
    std::uint32_t& head = table_[points_[id].key & (table_.size() - 1)];
    points_[id].next = head;
    head = id;
  }
  void grow() {
    table_.assign(4 * table_.size(), kEmpty);
    for (std::uint32_t id = 0; id < points_.size(); ++id) link(id);
  }
  template <class Visit>
  void visit_cell(Cell cell, int level, Vec3 p, double radius, Visit& visit) const {
    const std::uint64_t key = key_of(cell, level);
    for (std::uint32_t id = table_[key & (table_.size() - 1)]; id != kEmpty; id = points_[id].next) {
      const Entry& e = points_[id];
      if (e.key == key && squared_length(e.p - p) < radius * radius) visit(id, e.p);
    }
  }

  Vec3 origin_;
  std::vector<Entry> points_;
  std::vector<std::uint32_t> table_;
  int lowest_ = 0, highest_ = 0;
  double largest_ = 0;
};

}  // namespace octafront::remeshing
