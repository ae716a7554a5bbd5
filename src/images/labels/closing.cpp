#include "base/core/parallel.h"
#include "images/labels/label_steps.h"

#include <algorithm>
#include <array>
#include <vector>

namespace octafront::image {
namespace {

/// The box of a region's voxels, `hi` behind the last ones; empty if it has none.
struct Extent {
  std::array<std::int64_t, 3> lo{INT64_MAX, INT64_MAX, INT64_MAX}, hi{0, 0, 0};
  bool empty() const { return lo[0] >= hi[0]; }
};

std::vector<Extent> extents_of(const LabelImage& image) {
  std::vector<Extent> all(image.labels.size());
  std::size_t at = 0;
  for (std::int64_t k = 0; k < image.grid.size[2]; ++k)
    for (std::int64_t j = 0; j < image.grid.size[1]; ++j)
      for (std::int64_t i = 0; i < image.grid.size[0]; ++i, ++at) {
        if (image.regions[at] == LabelImage::kNoRegion) continue;
        Extent& e = all[image.regions[at]];
        const std::array<std::int64_t, 3> p{i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          e.lo[axis] = std::min(e.lo[axis], p[axis]);
          e.hi[axis] = std::max(e.hi[axis], p[axis] + 1);
        }
      }
  return all;
}

/// A region in its box with a margin, one byte per voxel. The margin may reach out of the image, so that closing sees
/// no edge there.
class Mask {
 public:
  Mask(const LabelImage& image, std::uint16_t region, const Extent& extent, std::uint32_t reach) {
    // One more than dilation reaches: what lies beyond is outside for sure.
    const std::int64_t margin = reach + 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo_[axis] = extent.lo[axis] - margin;
      n_[axis] = extent.hi[axis] - extent.lo[axis] + 2 * margin;
    }
    bytes_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]), 0);
    for_each_in(image, [&](std::size_t here, std::size_t there) { bytes_[here] = image.regions[there] == region; });
  }

  void dilate() { step(1); }
  void erode() { step(0); }

  /// Calls visit(voxel of the image) for each voxel of the mask that lies in the image.
  template <class Visit>
  void for_each_set(const LabelImage& image, const Visit& visit) const {
    for_each_in(image, [&](std::size_t here, std::size_t there) {
      if (bytes_[here] != 0) visit(there);
    });
  }

 private:
  template <class Visit>
  void for_each_in(const LabelImage& image, const Visit& visit) const {
    const auto& size = image.grid.size;
    const auto begin = [&](std::size_t axis) { return std::max<std::int64_t>(0, lo_[axis]); };
    const auto end = [&](std::size_t axis) { return std::min<std::int64_t>(size[axis], lo_[axis] + n_[axis]); };
    for (std::int64_t k = begin(2); k < end(2); ++k)
      for (std::int64_t j = begin(1); j < end(1); ++j)
        for (std::int64_t i = begin(0); i < end(0); ++i)
          visit(static_cast<std::size_t>((i - lo_[0]) + n_[0] * ((j - lo_[1]) + n_[1] * (k - lo_[2]))),
                static_cast<std::size_t>(i + size[0] * (j + std::int64_t{size[1]} * k)));
  }

  /// Voxels beside one of `value` get it too.
  void step(char value) {
    next_ = bytes_;
    const std::array<std::int64_t, 3> steps{1, n_[0], n_[0] * n_[1]};
    parallel_for(static_cast<std::size_t>(n_[2] - 2), [&](std::size_t slice) {
      const auto k = static_cast<std::int64_t>(slice) + 1;
      for (std::int64_t j = 1; j + 1 < n_[1]; ++j)
        for (std::int64_t i = 1; i + 1 < n_[0]; ++i) {
          const std::int64_t at = i + n_[0] * (j + n_[1] * k);
          for (const std::int64_t s : steps)
            if (byte(at - s) == value || byte(at + s) == value) next_[static_cast<std::size_t>(at)] = value;
        }
    });
    bytes_.swap(next_);
  }
  char byte(std::int64_t at) const { return bytes_[static_cast<std::size_t>(at)]; }

  std::array<std::int64_t, 3> lo_{}, n_{};
  std::vector<char> bytes_, next_;
};

}  // namespace

std::uint64_t close_gaps(LabelImage& image, std::uint32_t reach, const RunContext& context) {
  const std::vector<Extent> extents = extents_of(image);
  const std::vector<std::uint16_t> before = image.regions;
  std::uint64_t taken = 0;
  LabelImage source{image.grid, before, image.labels, {}};
  for (std::size_t r = 0; r < extents.size(); ++r) {
    context.check();
    context.report("closing gaps", static_cast<double>(r) / static_cast<double>(extents.size()));
    if (extents[r].empty()) continue;
    const auto region = static_cast<std::uint16_t>(r);
    Mask mask(source, region, extents[r], reach);
    for (std::uint32_t n = 0; n < reach; ++n) mask.dilate();
    for (std::uint32_t n = 0; n < reach; ++n) mask.erode();
    mask.for_each_set(image, [&](std::size_t voxel) {
      if (image.regions[voxel] != LabelImage::kNoRegion) return;
      image.regions[voxel] = region;
      ++taken;
    });
  }
  return taken;
}

}  // namespace octafront::image
