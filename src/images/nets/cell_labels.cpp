#include "images/nets/cell_labels.h"

#include <octafront/error.h>

#include <fmt/core.h>

namespace octafront::nets {

namespace {

/// The labels of the voxels around the cell, `count` higher; empty without a margin.
std::vector<Label> with_labels_around(const ImageGrid& grid, const std::vector<Label>& labels, std::size_t count,
                                      const PeriodicMargin& margin) {
  if (margin == PeriodicMargin{}) return {};
  if (2 * count >= LabelImage::kNoRegion)
    throw InputError(fmt::format("an image that goes on periodically has {} labels at most, and this one has {}",
                                 LabelImage::kNoRegion / 2 - 1, count));
  std::vector<Label> around = labels;
  std::size_t number = 0;
  const auto is_in = [&](std::size_t i, std::size_t axis) {
    return i >= margin[axis] && i < grid.size[axis] - margin[axis];
  };
  for (std::size_t k = 0; k < grid.size[2]; ++k)
    for (std::size_t j = 0; j < grid.size[1]; ++j)
      for (std::size_t i = 0; i < grid.size[0]; ++i, ++number)
        if (around[number] != LabelImage::kNoRegion && !(is_in(i, 0) && is_in(j, 1) && is_in(k, 2)))
          around[number] = static_cast<Label>(around[number] + count);
  return around;
}

}  // namespace

CellLabels::CellLabels(const ImageGrid& grid, const std::vector<Label>& labels, std::size_t count,
                       const PeriodicMargin& margin)
    : count_(count),
      around_(with_labels_around(grid, labels, count, margin)),
      lattice_(grid, around_.empty() ? labels : around_, margin) {}

void CellLabels::forget_margin(LabelSizes& sizes) const {
  if (!lattice_.is_periodic()) return;
  for (std::size_t l = 0; l < count_; ++l) sizes.voxels[count_ + l] = sizes.voxels[l], sizes.volume[count_ + l] = 0;
}

void CellLabels::cut_out_cell(Net& net) const {
  if (!lattice_.is_periodic()) return;
  for (Quad& q : net.quads)
    for (Label* label : {&q.lower, &q.upper})
      if (*label >= count_) *label = LabelImage::kNoRegion;
  std::erase_if(net.quads, [](const Quad& q) { return q.lower == q.upper; });
}

}  // namespace octafront::nets
