#include <octafront/error.h>
#include <octafront/image.h>

#include "base/core/wording.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Labels of electrodes are those of SimNIBS: behind 100.
constexpr std::int64_t kFirstElectrode = 101;
/// In voxels. A point on the skin lies within the half diagonal of one from the middle of a voxel there; one this far
/// off was read from another surface, and where the disc stands is said.
constexpr double kFarFromSkin = 3;
/// In voxels, beyond its own size: a disc this far off is no inaccuracy, but a point in other coordinates.
constexpr double kInOtherCoordinates = 5;
/// In voxels: where the skin faces is told by so many around its foot at least, however small the disc.
constexpr double kAroundFoot = 2;

/// The disc of one electrode among the voxels of an image.
class Disc {
 public:
  /// Throws OptionError for a point that is nowhere near the skin.
  Disc(const LabelImage& image, const Electrode& asked)
      : grid_(image.grid),
        regions_(image.regions),
        asked_(asked),
        least_(std::min({length(grid_.axes[0]), length(grid_.axes[1]), length(grid_.axes[2])})),
        largest_(std::max({length(grid_.axes[0]), length(grid_.axes[1]), length(grid_.axes[2])})),
        foot_(nearest_of_skin()) {
    if (!(off_skin() > asked_.radius + asked_.height + kInOtherCoordinates * largest_)) return;
    throw OptionError(fmt::format(
        "`electrode`: {} is {:.4g} from the skin, which is nearest at {}. Points are in the image's coordinates, RAS "
        "or LPS as octafront info says; between these x and y change their signs",
        at_point(asked_.at), off_skin(), at_point(foot_)));
  }

  /// The voxels of the disc: outside, no farther from the skin than it is high, and from its axis than its radius.
  std::vector<std::size_t> voxels() const {
    const Vec3 axis = outward();
    std::vector<std::size_t> all;
    for_each_near(foot_, asked_.radius + asked_.height, [&](std::size_t voxel, Vec3 p) {
      const Vec3 from = p - foot_;
      const double along = dot(from, axis);
      if (is_body(voxel) || length(from - axis * along) > asked_.radius) return;
      // Not what lies on the other side of a thin part.
      if (along > -asked_.radius && away_from_body(p) <= asked_.height) all.push_back(voxel);
    });
    return all;
  }

  /// Where it stands, as far as that is not where it was asked for.
  std::string place() const {
    if (off_skin() <= kFarFromSkin * largest_) return "";
    return fmt::format(" at {}, {:.4g} from {}", at_point(foot_), off_skin(), at_point(asked_.at));
  }

 private:
  bool is_body(std::size_t voxel) const { return regions_[voxel] != LabelImage::kNoRegion; }
  double off_skin() const { return distance(foot_, asked_.at); }

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

  /// Whether a voxel of the body has a face to one outside in the image.
  bool is_skin(std::size_t voxel, const std::array<std::uint32_t, 3>& at) const {
    std::size_t step = 1;
    for (std::size_t a = 0; a < 3; step *= grid_.size[a++]) {
      if (at[a] > 0 && !is_body(voxel - step)) return true;
      if (at[a] + 1 < grid_.size[a] && !is_body(voxel + step)) return true;
    }
    return false;
  }

  Vec3 nearest_of_skin() const {
    Vec3 nearest;
    double least = HUGE_VAL;
    std::size_t voxel = 0;
    for (std::uint32_t k = 0; k < grid_.size[2]; ++k)
      for (std::uint32_t j = 0; j < grid_.size[1]; ++j)
        for (std::uint32_t i = 0; i < grid_.size[0]; ++i, ++voxel) {
          if (!is_body(voxel)) continue;
          const Vec3 p = middle(i, j, k);
          if (const double d = distance(p, asked_.at); d < least && is_skin(voxel, {i, j, k})) least = d, nearest = p;
        }
    if (least == HUGE_VAL)
      throw OptionError("`electrode`: the labels leave no voxel outside of the body; pad the image, or `ignore` some");
    return nearest;
  }

  /// From the body's voxels around the foot to those outside.
  Vec3 outward() const {
    Vec3 body, outside;
    double in = 0, out = 0;
    const double around = std::max(asked_.radius + asked_.height, kAroundFoot * largest_);
    for_each_near(foot_, around, [&](std::size_t voxel, Vec3 p) {
      if (distance(p, foot_) > around) return;
      if (is_body(voxel))
        body += p, ++in;
      else
        outside += p, ++out;
    });
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
  double least_, largest_;  ///< distance of voxels
  Vec3 foot_;               ///< the middle of a voxel
};

/// What became of the voxels of one disc.
struct Given {
  std::size_t got = 0;
  std::map<std::uint16_t, std::size_t> taken = {};  ///< by electrodes before it

  /// "electrode 1 has 30 and electrode 2 has 5".
  std::string others(const LabelImage& image) const {
    std::string words;
    for (const auto& [region, voxels] : taken)
      words += (words.empty() ? "" : " and ") + fmt::format("{} has {}", image.labels[region].name, voxels);
    return words;
  }
};

Given set_on(LabelImage& image, const std::vector<std::size_t>& disc, std::uint16_t number) {
  Given share;
  for (const std::size_t voxel : disc) {
    std::uint16_t& region = image.regions[voxel];
    if (region == LabelImage::kNoRegion)
      region = number, ++share.got;
    else
      ++share.taken[region];
  }
  return share;
}

[[noreturn]] void fail_without_voxels(const LabelImage& image, const Electrode& electrode, const Given& share) {
  if (share.taken.empty())
    throw OptionError(
        fmt::format("`electrode`: no voxel of the disc at {} lies in the image and outside of the body; "
                    "pad the image, or make it larger",
                    at_point(electrode.at)));
  throw OptionError(
      fmt::format("`electrode`: {} at {} gets no voxel, for of its disc {}, all of it: move it, or make it higher than "
                  "what was set there before",
                  image.labels.back().name, at_point(electrode.at), share.others(image)));
}

}  // namespace

LabelImage with_electrodes(LabelImage image, const std::vector<Electrode>& electrodes) {
  std::vector<std::vector<std::size_t>> discs;
  std::vector<std::string> places;
  for (const Electrode& electrode : electrodes) {
    const Disc disc(image, electrode);
    discs.push_back(disc.voxels());
    places.push_back(disc.place());
  }
  std::int64_t last = kFirstElectrode - 1;
  for (const LabelImage::Label& label : image.labels) last = std::max(last, label.value);
  for (std::size_t e = 0; e < discs.size(); ++e) {
    const auto number = static_cast<std::uint16_t>(image.labels.size());
    image.labels.push_back({++last, electrodes.size() == 1 ? "electrode" : fmt::format("electrode {}", e + 1)});
    const Given share = set_on(image, discs[e], number);
    if (share.got == 0) fail_without_voxels(image, electrodes[e], share);
    std::string words =
        fmt::format("{}: {} on the skin{}", image.labels.back().name, counted(share.got, "voxel"), places[e]);
    if (!share.taken.empty()) words += fmt::format("; of its disc {}", share.others(image));
    image.notes.push_back(std::move(words));
  }
  return image;
}

}  // namespace octafront
