// The smallest 2:1 balanced octree that has given cells divided.
//
// If a cell c is divided, its children touch the 26 neighbours of c of its own level; 2:1 asks that these exist, which
// means that their parents are divided. Seen from c the parents number eight, c's own included: along each axis c's
// parent and the one on c's side of it. One sweep from the finest level to the root therefore closes the set. (The idea
// of closing parents instead of rippling through leaves: T. Isaac, C. Burstedde, O. Ghattas, "Low-cost parallel
// algorithms for 2:1 octree balance", 2012.)

#include "base/core/parallel.h"
#include "sizing/field/octree.h"

#include <algorithm>

namespace octafront {

namespace {

constexpr std::size_t kCellsAtOnce = 1024;
/// What lies in a cell of this level is a thread's own: there are some hundred of them where there is any surface.
constexpr int kTopLevel = 4;

void sort_unique(std::vector<OctreeKey>& cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

RawVector<OctreeKey> sorted_unique(RawVector<OctreeKey> cells) {
  parallel_sort(cells);
  return parallel_collect<OctreeKey, RawVector<OctreeKey>>(
      cells.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end, std::vector<OctreeKey>& once) {
        for (std::size_t i = begin; i < end; ++i)
          if (i == 0 || cells[i] != cells[i - 1]) once.push_back(cells[i]);
      });
}

void add_parents_around(OctreeKey cell, std::vector<OctreeKey>& parents) {
  const OctreeKey parent = cell.parent();
  const int c = cell.child_number();
  for (int mask = 0; mask < 8; ++mask) {
    const auto step = [&](int axis) { return (mask >> axis & 1) == 0 ? 0 : (c >> axis & 1) != 0 ? 1 : -1; };
    const OctreeKey other = parent.neighbour(step(0), step(1), step(2));
    if (other.is_valid()) parents.push_back(other);
  }
}

}  // namespace

void DividedCells::close() {
  for (int l = OctreeKey::kMaxLevel; l > 0; --l) {
    if (levels_[l].empty()) continue;
    const Level& cells = levels_[l] = sorted_unique(std::move(levels_[l]));
    // Siblings share most of their parents' neighbours: few are left of those of a range.
    const auto parents = parallel_collect<OctreeKey, Level>(
        cells.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end, std::vector<OctreeKey>& found) {
          for (std::size_t i = begin; i < end; ++i) add_parents_around(cells[i], found);
          sort_unique(found);
        });
    levels_[l - 1].insert(levels_[l - 1].end(), parents.begin(), parents.end());
  }
  levels_[0] = sorted_unique(std::move(levels_[0]));
}

// On each level the cells come in the order of the curve, as they are sorted in levels_.
void DividedCells::leaves_below(OctreeKey top, std::vector<OctreeKey>& leaves) const {
  std::array<Level::const_iterator, OctreeKey::kMaxLevel + 1> next;
  for (int l = 0; l <= OctreeKey::kMaxLevel; ++l)
    next[l] = std::lower_bound(levels_[l].begin(), levels_[l].end(), OctreeKey::from_id(top.range_min()));
  std::vector<OctreeKey> stack{top};
  while (!stack.empty()) {
    const OctreeKey cell = stack.back();
    stack.pop_back();
    const int l = cell.level();
    if (next[l] != levels_[l].end() && *next[l] == cell && l < OctreeKey::kMaxLevel) {
      ++next[l];
      for (int i = 7; i >= 0; --i) stack.push_back(cell.child(i));
    } else {
      leaves.push_back(cell);
    }
  }
}

Octree DividedCells::tree() const {
  // The leaves if nothing below kTopLevel were divided.
  std::vector<OctreeKey> tops{OctreeKey::root()};
  for (int l = 0; l < kTopLevel; ++l) {
    std::vector<OctreeKey> next;
    for (const OctreeKey cell : tops) {
      if (cell.level() < l || !std::binary_search(levels_[l].begin(), levels_[l].end(), cell))
        next.push_back(cell);
      else
        for (int i = 0; i < 8; ++i) next.push_back(cell.child(i));
    }
    tops.swap(next);
  }
  return Octree(parallel_collect<OctreeKey, Level>(
      tops.size(), 1, [&](std::size_t begin, std::size_t end, std::vector<OctreeKey>& leaves) {
        for (std::size_t i = begin; i < end; ++i) leaves_below(tops[i], leaves);
      }));
}

DividedCells divided_cells(const Octree& tree, const std::function<bool(std::size_t)>& stays) {
  DividedCells cells;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    // The first descendant of each divided cell names it once.
    OctreeKey cell = tree.leaf(i);
    bool is_whole = i + 7 < tree.size() && cell.level() > 0 && tree.leaf(i + 7) == cell.parent().child(7);
    while (cell.level() > 0 && cell.child_number() == 0) {
      cell = cell.parent();
      if (!is_whole || !stays || stays(i)) cells.divide(cell);
      is_whole = false;
    }
  }
  return cells;
}

}  // namespace octafront
