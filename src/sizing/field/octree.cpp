#include "sizing/field/octree.h"

#include "base/core/validate.h"

#include <algorithm>
#include <utility>

namespace octafront {

namespace {

/// A grid of at most this many levels: 8^6 entries are one megabyte.
constexpr int kMaxGridLevel = 6;

/// From the last id of a cell to the first one of the next: cells of the finest level have odd ids.
constexpr std::uint64_t kNextCell = 2;

/// Place of the cell on the curve of the cells of `level`.
std::size_t position_at(OctreeKey cell, int level) {
  return static_cast<std::size_t>(cell.id() >> (3 * (OctreeKey::kMaxLevel - level) + 1)) &
         ((std::size_t{1} << (3 * level)) - 1);
}

}  // namespace

RootCube RootCube::around(const Box3& box, double margin) {
  const Vec3 extent = box.extent();
  const double side = std::max({extent.x, extent.y, extent.z}) * (1 + 2 * margin);
  const double half = 0.5 * side;
  return {box.center() - Vec3{half, half, half}, side};
}

Octree::Octree(RawVector<OctreeKey> leaves) {
  depth_ = parallel_max(leaves.size(), 0, [&](std::size_t i) { return leaves[i].level(); });
  while (grid_level_ < std::min(kMaxGridLevel, depth_) && (std::size_t{1} << (3 * grid_level_)) < leaves.size()) {
    ++grid_level_;
  }
  const std::size_t cells = std::size_t{1} << (3 * grid_level_);
  RawVector<std::uint32_t> first(cells + 1);
  const auto behind = [&](std::size_t leaf) {
    return position_at(OctreeKey::from_id(leaves[leaf].range_max()), grid_level_) + 1;
  };
  parallel_ranges(leaves.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
    std::size_t next = begin == 0 ? 0 : behind(begin - 1);
    for (std::size_t i = begin; i < end; ++i)
      for (const std::size_t last = behind(i); next < last;) first[next++] = static_cast<std::uint32_t>(i);
  });
  first[cells] = static_cast<std::uint32_t>(leaves.size() - 1);
  arrays_ = std::make_shared<const Arrays>(Arrays{std::move(leaves), std::move(first)});
  leaves_ = arrays_->leaves;
  first_ = arrays_->first;
  validate(*this);
}

std::size_t Octree::find(OctreeKey cell) const {
  const std::uint64_t id = cell.range_min();
  const std::size_t place = position_at(OctreeKey::from_id(id), grid_level_);
  // first_[place] holds the leaf of the first unit of the cell; the leaf wanted ends at or behind `id`.
  std::size_t low = first_[place], count = first_[place + 1] - low;
  while (count > 0) {
    const std::size_t half = count / 2;
    const bool behind = leaves_[low + half].range_max() < id;
    low = behind ? low + half + 1 : low;
    count = behind ? count - half - 1 : half;
  }
  return low;
}

bool Octree::is_balanced() const {
  for (const OctreeKey leaf : leaves_) {
    for (int d = 0; d < 27; ++d) {
      const OctreeKey other = leaf.neighbour(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
      if (other.is_valid() && leaves_[find(other)].level() < leaf.level() - 1) return false;
    }
  }
  return true;
}

std::optional<std::string> Octree::first_inconsistency() const {
  std::uint64_t begin = OctreeKey::root().range_min();
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    if (!leaves_[i].is_valid()) return "leaf " + std::to_string(i) + " of the octree is no cell";
    if (leaves_[i].range_min() != begin)
      return "leaf " + std::to_string(i) + " of the octree does not begin where the one before it ends";
    if (find(leaves_[i]) != i) return "leaf " + std::to_string(i) + " of the octree is not found";
    begin = leaves_[i].range_max() + kNextCell;
  }
  if (begin != OctreeKey::root().range_max() + kNextCell) return "the leaves of the octree end before the root does";
  return std::nullopt;
}

bool cover_the_root(std::span<const OctreeKey> leaves) {
  std::uint64_t begin = OctreeKey::root().range_min();
  for (const OctreeKey leaf : leaves) {
    if (!leaf.is_valid() || leaf.range_min() != begin) return false;
    begin = leaf.range_max() + kNextCell;
  }
  return begin == OctreeKey::root().range_max() + kNextCell;
}

}  // namespace octafront
