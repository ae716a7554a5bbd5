#include <octafront/error.h>
#include <octafront/image.h>

#include "base/core/wording.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Labels of electrodes are those of SimNIBS: behind 100.
constexpr std::int64_t kFirstElectrode = 101;

/// The disc of one electrode among the voxels of an image.
class Disc {
 public:
  Disc(const LabelImage& image, const Electrode& asked)
      : grid_(image.grid),
        regions_(image.regions),
        asked_(asked),
        least_(std::min({length(grid_.axes[0]), length(grid_.axes[1]), length(grid_.axes[2])})) {}

  /// The voxels of the disc: outside, no farther from the skin than it is high, and from its axis than its radius.
  std::vector<std::size_t> voxels() const {
    const Vec3 foot = nearest_of_body(), axis = outward(foot);
    std::vector<std::size_t> all;
    for_each_near(foot, asked_.radius + asked_.height, [&](std::size_t voxel, Vec3 p) {
      const Vec3 from = p - foot;
      const double along = dot(from, axis);
      if (is_body(voxel) || length(from - axis * along) > asked_.radius) return;
      // Not what lies on the other side of a thin part.
      if (along > -asked_.radius && away_from_body(p) <= asked_.height) all.push_back(voxel);
    });
    return all;
  }

 private:
  bool is_body(std::size_t voxel) const { return regions_[voxel] != LabelImage::kNoRegion; }

  Vec3 middle(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return grid_.to_world({static_cast<double>(i), static_cast<double>(j), grid_.slice(static_cast<std::uint32_t>(k))});
  }

  /// visit(number, middle) of the voxels that lie so near to a place, and of some more.
  template <class Visit>
  void for_each_near(Vec3 place, double reach, const Visit& visit) const {
    const Vec3 at = grid_.to_index(place);
    const auto steps = static_cast<std::int64_t>(std::ceil(reach / least_)) + 1;
    std::array<std::int64_t, 3> lo{}, hi{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto middle = static_cast<std::int64_t>(std::llround(at[static_cast<int>(a)]));
      lo[a] = std::max<std::int64_t>(0, middle - steps);
      hi[a] = std::min<std::int64_t>(grid_.size[a] - 1, middle + steps);
    }
    for (std::int64_t k = lo[2]; k <= hi[2]; ++k)
      for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
        for (std::int64_t i = lo[0]; i <= hi[0]; ++i)
          visit(static_cast<std::size_t>(i + grid_.size[0] * (j + std::int64_t{grid_.size[1]} * k)), middle(i, j, k));
  }

  Vec3 nearest_of_body() const {
    Vec3 nearest;
    double least = HUGE_VAL;
    std::size_t voxel = 0;
    for (std::uint32_t k = 0; k < grid_.size[2]; ++k)
      for (std::uint32_t j = 0; j < grid_.size[1]; ++j)
        for (std::uint32_t i = 0; i < grid_.size[0]; ++i, ++voxel) {
          if (!is_body(voxel)) continue;
          const Vec3 p = middle(i, j, k);
          if (const double d = distance(p, asked_.at); d < least) least = d, nearest = p;
        }
    return nearest;
  }

  /// From the body's voxels around to those outside.
  Vec3 outward(Vec3 foot) const {
    Vec3 body, outside;
    double in = 0, out = 0;
    const double around = asked_.radius + asked_.height;
    for_each_near(foot, around, [&](std::size_t voxel, Vec3 p) {
      if (distance(p, foot) > around) return;
      if (is_body(voxel))
        body += p, ++in;
      else
        outside += p, ++out;
    });
    if (out == 0) throw OptionError(fmt::format("`electrode`: {} lies deep inside", at_point(asked_.at)));
    return normalized(outside / out - body / in);
  }

  double away_from_body(Vec3 p) const {
    double least = HUGE_VAL;
    for_each_near(p, asked_.height, [&](std::size_t voxel, Vec3 q) {
      if (is_body(voxel)) least = std::min(least, distance(p, q));
    });
    return least;
  }

  const ImageGrid& grid_;
  const std::vector<std::uint16_t>& regions_;
  const Electrode& asked_;
  double least_;  ///< distance of voxels
};

}  // namespace

LabelImage with_electrodes(LabelImage image, const std::vector<Electrode>& electrodes) {
  std::vector<std::vector<std::size_t>> discs;
  for (const Electrode& electrode : electrodes) discs.push_back(Disc(image, electrode).voxels());
  std::int64_t last = kFirstElectrode - 1;
  for (const LabelImage::Label& label : image.labels) last = std::max(last, label.value);
  for (std::size_t e = 0; e < discs.size(); ++e) {
    if (discs[e].empty())
      throw OptionError(
          fmt::format("`electrode`: no voxel of the disc at {} lies in the image and outside of the body; "
                      "pad the image, or make it larger",
                      at_point(electrodes[e].at)));
    const auto number = static_cast<std::uint16_t>(image.labels.size());
    image.labels.push_back({++last, electrodes.size() == 1 ? "electrode" : fmt::format("electrode {}", e + 1)});
    for (const std::size_t voxel : discs[e])
      if (image.regions[voxel] == LabelImage::kNoRegion) image.regions[voxel] = number;
    image.notes.push_back(
        fmt::format("{}: {} on the skin", image.labels.back().name, counted(discs[e].size(), "voxel")));
  }
  return image;
}

}  // namespace octafront
