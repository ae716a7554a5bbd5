#include "base/core/wording.h"
#include "images/files/dicom/series.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront::image {
namespace {

class Segmentation {
 public:
  Segmentation(const io::Input& input, const SliceFile& file) : input_(input), file_(file) {}

  Image read() {
    check();
    image_.format = fmt::format("DICOM segmentation, {}", counted(file_.segments.size(), "segment"));
    image_.unit = "mm";
    image_.frame = "LPS";
    make_grid();
    std::vector<std::int32_t> labels(image_.grid.voxels(), 0);
    for (const Slice& slice : file_.slices) add_frame(slice, labels);
    if (overlaps_ > 0)
      image_.notes.push_back(
          fmt::format("{} in several segments: the last one has them", counted(overlaps_, "voxel is", "voxels are")));
    image_.values = narrowed(labels, image_.notes);
    for (const Segment& segment : file_.segments)
      if (!segment.name.empty()) image_.names.push_back({segment.number, segment.name});
    return std::move(image_);
  }

 private:
  void check() const {
    if (!file_.syntax.is_readable || file_.syntax.is_rle)
      input_.fail(fmt::format("its segments are written as {}, which is not read here; convert it (gdcmconv --raw)",
                              file_.syntax.name));
    const std::uint32_t bits = file_.format.bits_allocated;
    if (bits != 1 && bits != 8) input_.fail(fmt::format("has segments of {} bits a pixel; 1 and 8 are read", bits));
    for (const Slice& slice : file_.slices)
      if (!slice.has_place || slice.size != file_.slices[0].size)
        input_.fail("does not say where its frames lie (position, orientation or pixel spacing is missing)");
    const std::uint64_t all = each() * file_.slices.size() * bits;
    if (all > 8 * std::uint64_t{file_.pixels.size()})
      input_.fail(
          fmt::format("has {} bytes of pixels, and its frames take {}; it is truncated: copy or export it again",
                      file_.pixels.size(), all / 8));
  }

  std::uint64_t each() const { return std::uint64_t{file_.slices[0].size[0]} * file_.slices[0].size[1]; }

  double height(const Slice& s) const {
    return dot(s.at - file_.slices[0].at, cross(file_.slices[0].directions[0], file_.slices[0].directions[1]));
  }

  /// Frames of nothing are mostly left out: planes stand at whole steps of the least distance.
  void make_grid() {
    std::vector<double> heights;
    for (const Slice& s : file_.slices) heights.push_back(height(s));
    std::sort(heights.begin(), heights.end());
    const Slice& first = *std::ranges::min_element(file_.slices, {}, [&](const Slice& s) { return height(s); });
    const double same = 1e-3 * std::min(first.spacing[0], first.spacing[1]);
    for (std::size_t i = 1; i < heights.size(); ++i)
      if (const double gap = heights[i] - heights[i - 1]; gap > same && (step_ == 0 || gap < step_)) step_ = gap;
    if (step_ == 0) step_ = first.thickness > 0 ? first.thickness : 1;
    lowest_ = heights.front();
    const double planes = std::round((heights.back() - lowest_) / step_) + 1;
    image_.grid.size = checked_sizes(input_, {first.size[0], first.size[1], static_cast<std::int64_t>(planes)});
    require_memory_for(input_, image_.grid.voxels(), VoxelType::kInt32);
    image_.grid.origin = first.at;
    for (std::size_t i = 0; i < 2; ++i) image_.grid.axes[i] = first.directions[i] * first.spacing[i];
    image_.grid.axes[2] = cross(first.directions[0], first.directions[1]) * step_;
    check_grid(input_, image_.grid);
  }

  bool is_in(std::uint64_t pixel) const {
    const auto byte = [&](std::uint64_t at) { return static_cast<unsigned char>(file_.pixels[at]); };
    if (file_.format.bits_allocated == 8) return 2u * byte(pixel) >= file_.most;
    return (byte(pixel / 8) >> pixel % 8 & 1) != 0;
  }

  void add_frame(const Slice& slice, std::vector<std::int32_t>& labels) {
    const double plane = (height(slice) - lowest_) / step_;
    if (std::abs(plane - std::round(plane)) > kOffPlane)
      input_.fail(fmt::format("has a frame {:.4g} planes above the first; planes at whole steps are read", plane));
    const std::uint64_t first = static_cast<std::uint64_t>(std::round(plane)) * each();
    for (std::uint64_t i = 0; i < each(); ++i) {
      if (!is_in(slice.frame * each() + i)) continue;
      std::int32_t& label = labels[first + i];
      overlaps_ += label != 0;
      label = static_cast<std::int32_t>(slice.segment);
    }
  }

  static constexpr double kOffPlane = 0.05;  ///< as headers round places

  const io::Input& input_;
  const SliceFile& file_;
  Image image_;
  double step_ = 0, lowest_ = 0;
  std::uint64_t overlaps_ = 0;
};

}  // namespace

Image read_segmentation(const io::Input& input, const SliceFile& file) {
  if (file.slices.empty()) input.fail("has no frames");
  return Segmentation(input, file).read();
}

}  // namespace octafront::image
