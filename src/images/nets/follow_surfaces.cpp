// Voxels near surfaces of labels get the label of the side on which their middles lie.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "base/core/wording.h"
#include "images/nets/given_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace octafront::nets {

namespace {

/// In voxels. A segmentation and a surface of one scan are a voxel apart, seldom two, where both are right; farther off
/// they mean different things (pial surfaces leave out the cerebellum), and labels know better.
constexpr double kBand = 2;
/// What is outside of the surface and has its label gets another one that is no farther, in bands: where the label goes
/// on for longer it is something that the surface does not speak of.
constexpr double kMostBandsAway = 2;
/// In voxels beyond the band: how far a search looks, so that what lies farther is passed in steps of so many.
constexpr double kLook = 16;

enum State : std::uint8_t { kInside = 1, kNear = 2 };

/// Where each voxel's middle lies.
std::vector<std::uint8_t> states_of(const ImageGrid& grid, const GivenSurface& surface, double band) {
  std::vector<std::uint8_t> states(grid.voxels());
  const double step = length(grid.axes[0]), reach = band + kLook * step;
  parallel_for(std::size_t{grid.size[1]} * grid.size[2], [&](std::size_t row) {
    const auto j = static_cast<std::uint32_t>(row % grid.size[1]), k = static_cast<std::uint32_t>(row / grid.size[1]);
    std::uint8_t* const state = states.data() + row * grid.size[0];
    bool was_far = false;
    std::uint8_t side = 0;
    for (std::uint32_t i = 0; i < grid.size[0];) {
      const Vec3 p = grid.to_world({static_cast<double>(i), static_cast<double>(j), grid.slice(k)});
      const TriangleTree::Nearest nearest = surface.tree.nearest(p, reach * reach);
      const double away = nearest.triangle == kNone ? reach : std::sqrt(nearest.squared_distance);
      const bool is_far = away > band;
      // A step between two that are far off passes no surface.
      if (!is_far || !was_far) side = surface.contains(p) ? kInside : 0;
      was_far = is_far;
      const auto same = 1 + static_cast<std::uint32_t>(is_far ? (away - band) / step : 0);
      const std::uint32_t end = std::min(grid.size[0], i + same);
      std::fill(state + i, state + end, static_cast<std::uint8_t>(side | (is_far ? 0 : kNear)));
      i = end;
    }
  });
  return states;
}

/// Per label: whether most of its voxels are inside. The label itself always is.
std::vector<std::uint8_t> held_by(const LabelImage& image, const std::vector<std::uint8_t>& states, Label own) {
  std::vector<std::int64_t> more_inside(image.labels.size(), 0);
  for (std::size_t v = 0; v < states.size(); ++v)
    if (image.regions[v] != LabelImage::kNoRegion) more_inside[image.regions[v]] += (states[v] & kInside) != 0 ? 1 : -1;
  std::vector<std::uint8_t> within;
  for (const std::int64_t more : more_inside) within.push_back(more > 0);
  within[own] = 1;
  return within;
}

/// Looks for the nearest voxel that a surface does not hold.
class Surroundings {
 public:
  Surroundings(const LabelImage& image, const GivenSurface& surface, double voxel)
      : image_(image), grid_(image.grid), surface_(surface), voxel_(voxel) {}

  /// The label of that voxel; `else_one` if none is so near.
  Label nearest(std::size_t voxel, double most, Label else_one) const {
    const std::array<std::int64_t, 3> at = {static_cast<std::int64_t>(voxel % grid_.size[0]),
                                            static_cast<std::int64_t>(voxel / grid_.size[0] % grid_.size[1]),
                                            static_cast<std::int64_t>(voxel / grid_.size[0] / grid_.size[1])};
    for (double reach = voxel_; reach < 2 * most; reach *= 2) {
      const Found found = nearest_within(at, std::min(reach, most));
      if (found.away <= std::min(reach, most)) return found.label;
    }
    return else_one;
  }

 private:
  struct Found {
    Label label = 0;
    double away = HUGE_VAL;
  };

  Vec3 middle(const std::array<std::int64_t, 3>& at) const {
    return grid_.to_world(
        {static_cast<double>(at[0]), static_cast<double>(at[1]), grid_.slice(static_cast<std::uint32_t>(at[2]))});
  }
  double along(std::size_t axis, std::int64_t index) const {
    return axis == 2 ? grid_.slice(static_cast<std::uint32_t>(index)) : static_cast<double>(index);
  }

  Found nearest_within(const std::array<std::int64_t, 3>& at, double reach) const {
    std::array<std::int64_t, 3> lo = at, hi = at, n{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double steps = reach / length(grid_.axes[a]);
      while (lo[a] > 0 && along(a, at[a]) - along(a, lo[a] - 1) <= steps) --lo[a];
      while (hi[a] + 1 < grid_.size[a] && along(a, hi[a] + 1) - along(a, at[a]) <= steps) ++hi[a];
    }
    const Vec3 from = middle(at);
    Found found;
    for (n[2] = lo[2]; n[2] <= hi[2]; ++n[2])
      for (n[1] = lo[1]; n[1] <= hi[1]; ++n[1])
        for (n[0] = lo[0]; n[0] <= hi[0]; ++n[0]) {
          const Label label = image_.regions[static_cast<std::size_t>(
              n[0] + std::int64_t{grid_.size[0]} * (n[1] + std::int64_t{grid_.size[1]} * n[2]))];
          if (surface_.holds(label)) continue;
          if (const double away = distance(from, middle(n)); away < found.away) found = {label, away};
        }
    return found;
  }

  const LabelImage& image_;
  const ImageGrid& grid_;
  const GivenSurface& surface_;
  double voxel_;
};

void require_near_label(const LabelImage& image, const GivenSurface& surface, const std::vector<std::uint8_t>& states) {
  for (std::size_t v = 0; v < states.size(); ++v)
    if ((states[v] & kNear) != 0 && image.regions[v] == surface.label) return;
  const Box3 box = surface.tree.box();
  throw InputError(
      fmt::format("no voxel of \"{}\" lies within {} voxels of its surface {}, which reaches from {} to {}: it has to "
                  "be in the image's coordinates, RAS or LPS as octafront info says (FreeSurfer's own surfaces are in "
                  "another frame: mris_convert --to-scanner)",
                  surface.name, kBand, surface.from, at_point(box.lo), at_point(box.hi)));
}

std::size_t follow(LabelImage& image, GivenSurface& surface) {
  const double voxel = voxel_of(image.grid);
  const std::vector<std::uint8_t> states = states_of(image.grid, surface, kBand * voxel);
  require_near_label(image, surface, states);
  surface.within = held_by(image, states, surface.label);
  const Surroundings around(image, surface, voxel);
  std::vector<std::uint16_t> regions = image.regions;
  parallel_for(regions.size(), [&](std::size_t v) {
    const bool is_inside = (states[v] & kInside) != 0;
    if ((states[v] & kNear) == 0 || surface.holds(regions[v]) == is_inside) return;
    regions[v] = is_inside ? surface.label : around.nearest(v, kMostBandsAway * kBand * voxel, regions[v]);
  });
  std::size_t changed = 0;
  for (std::size_t v = 0; v < regions.size(); ++v) changed += regions[v] != image.regions[v];
  image.regions = std::move(regions);
  return changed;
}

}  // namespace

void follow_surfaces(LabelImage& image, std::vector<GivenSurface>& surfaces, const RunContext& context) {
  for (GivenSurface& surface : surfaces) {
    context.check();
    const std::size_t changed = follow(image, surface);
    image.notes.push_back(fmt::format("\"{}\" follows {}: {} near it another label", surface.name, surface.from,
                                      counted(changed, "voxel gets", "voxels get")));
  }
}

}  // namespace octafront::nets
