#pragma once

// Work divided by space, the same for any number of threads. A mesh is worked on in stages. Each stage has
// a cube, and its cells are halves of halves of that cube with at most so many points each. A worker may look at and
// change what lies wholly in its cell, while others work in theirs; what a cell does not hold wholly waits for the next
// stage, whose cells have other planes; what all stages leave is one block at the end. Cells follow from counts of
// points alone, and results are taken in the order of cells: who works on a cell, thread or process, never matters.
// Takes points and items, leaves numbers of cells; knows nothing of meshes.

#include "base/core/buckets.h"
#include "base/core/groups.h"
#include "base/geometry/spatial_order.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// Stages with cells of their own. Of a million elements, in cells of up to 8192 vertices, 11.5 % lie in no cell of the
/// first, 1.1 % in none of the first two, .06 % of three and hardly any of four.
inline constexpr int kCellStages = 4;

/// The cube of a stage: the box's own, then twice as large ones, each lower by other fifths. No multiple of a fifth is
/// a sum of halves, quarters and so on, so no plane between cells of one stage lies closer to one of another than a
/// fifth of the smaller cell.
Cube cube_of_stage(const Box3& box, int stage);

/// Points by cells that are numbered along a space-filling curve; none is empty.
struct Cells {
  std::vector<std::uint32_t> of;  ///< per point: its cell
  std::uint32_t count = 0;

  /// The cell that has all of these points; kNoOwner if there is none.
  template <class Points>
  std::uint32_t holding(const Points& points) const {
    const std::uint32_t cell = of[points[0]];
    for (const auto p : points)
      if (of[p] != cell) return kNoOwner;
    return cell;
  }
};

/// Halves the cube, across x, y and z in turn, and what comes of it, while more than `most` points lie in it: cells
/// have `most` points or fewer, unless more of them coincide (within 2^-21 of the cube). Depends on no order of the
/// points.
Cells cells_of(std::span<const Vec3> points, const Cube& cube, std::size_t most);

/// Items by the cell that holds them wholly, and those that none does, both in the order in which they came.
template <class Item>
class ItemsByCell {
 public:
  /// owner(item) tells the cell, or kNoOwner.
  template <class Owner>
  ItemsByCell(std::span<const Item> items, std::uint32_t cells, const Owner& owner)
      : ItemsByCell(items, cells, owners(items, cells, owner)) {}

  std::span<const Item> operator[](std::uint32_t cell) const { return by_owner_[cell]; }
  /// What no cell holds.
  std::span<const Item> left() const { return by_owner_[by_owner_.size() - 1]; }

 private:
  ItemsByCell(std::span<const Item> items, std::uint32_t cells, const std::vector<std::uint32_t>& owners)
      : by_owner_(items.size(), std::size_t{cells} + 1,
                  [&](std::size_t i, const auto& add) { add(owners[i], items[i]); }) {}

  template <class Owner>
  static std::vector<std::uint32_t> owners(std::span<const Item> items, std::uint32_t nobody, const Owner& owner) {
    std::vector<std::uint32_t> owners(items.size());
    parallel_for(items.size(), [&](std::size_t i) { owners[i] = std::min(owner(items[i]), nobody); });
    return owners;
  }

  Buckets<Item> by_owner_;
};

/// Calls work(cell, items, left) for each cell that holds any, in parallel. Gives what no cell holds, and what `work`
/// added to its `left`, in the order of cells.
template <class Item, class Owner, class Work>
std::vector<Item> run_in_cells(std::span<const Item> items, std::uint32_t cells, const Owner& owner, const Work& work) {
  const ItemsByCell<Item> by_cell(items, cells, owner);
  std::vector<std::vector<Item>> left(cells);
  parallel_for(
      cells,
      [&](std::size_t c) {
        const auto cell = static_cast<std::uint32_t>(c);
        if (!by_cell[cell].empty()) work(cell, by_cell[cell], left[c]);
      },
      Split::kSingly);
  std::vector<Item> all(by_cell.left().begin(), by_cell.left().end());
  for (const std::vector<Item>& of_cell : left) all.insert(all.end(), of_cell.begin(), of_cell.end());
  return all;
}

}  // namespace octafront
