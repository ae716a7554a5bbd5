#include <octafront/image_surface.h>

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "doors/intake/intake.h"
#include "images/labels/label_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace octafront::intake {

namespace {

/// Two triangles for a face between voxels, and so many elements for a triangle, where elements are as small as voxels
/// (five bands of a skull, 4.5 to 5.5).
constexpr double kElementsPerFace = 10;
/// From this part of the faces on that bound layers of one voxel triangles of a net are too small to be joined: 0.02 -
/// 0.16 in scans by one value, 0.24 of raw noise, 0.4 in bands that run along each other's edges.
constexpr double kMostlyThin = 0.2;
/// Beyond so many times what is allowed: a budget is met within that.
constexpr double kNearBudget = 1.3;
/// Who gives a size may get so many times the elements that it asks for.
constexpr double kTimesAsked = 3;
/// How the number of faces falls with the spacing, at least by measure; and the least step of it.
constexpr double kFallOfFaces = 3, kLeastStep = 1.05;

LabelImage bands_of(const Image& image, const ImageRegions& regions, const RunContext& context) {
  LabelImage labels = labels_of_bands(image, regions.bands);
  return regions.clean.any() ? cleaned(labels, regions.clean, context) : labels;
}

double elements_of(const image::Thinness& found) {
  return kElementsPerFace * static_cast<double>(found.faces);
}

/// Elements of the size that fill what is in a band.
double needed_for(double size, const LabelImage& bands) {
  const ImageGrid& grid = bands.grid;
  const double voxel = std::abs(dot(cross(grid.axes[0], grid.axes[1]), grid.axes[2]));
  const auto outside = std::ranges::count(bands.regions, LabelImage::kNoRegion);
  return static_cast<double>(bands.regions.size() - static_cast<std::size_t>(outside)) * voxel /
         (kRegularTet * size * size * size);
}

/// Per band, its part of the image.
std::vector<double> parts_of(const LabelImage& image) {
  std::vector<double> parts(image.labels.size(), 0);
  for (const std::uint16_t region : image.regions)
    if (region != LabelImage::kNoRegion) parts[region] += 1 / static_cast<double>(image.regions.size());
  return parts;
}

/// The band whose volume changes most, in words.
std::string most_changed(const LabelImage& before, const LabelImage& after) {
  const std::vector<double> was = parts_of(before), is = parts_of(after);
  std::size_t worst = 0;
  const auto change = [&](std::size_t b) { return was[b] == 0 ? 0 : is[b] / was[b] - 1; };
  for (std::size_t b = 1; b < was.size(); ++b)
    if (std::abs(change(b)) > std::abs(change(worst))) worst = b;
  return fmt::format("the volume of \"{}\" by {:+.3g} %, no other's by more", before.labels[worst].name,
                     100 * change(worst));
}

Vec3 spacing_along(const ImageGrid& grid) {
  return {length(grid.axes[0]), length(grid.axes[1]), length(grid.axes[2])};
}

}  // namespace

std::optional<Image> coarsened_for_budget(const Image& image, const ImageIntake& asked, const ImageRegions& regions,
                                          const RunContext& context) {
  const bool has_size = asked.size && *asked.size > 0;
  if ((!std::isfinite(asked.most_elements) && !has_size) || regions.bands.empty() ||
      kind_of(image, regions) != ImageRegions::Kind::kGrey)
    return {};
  const LabelImage bands = bands_of(image, regions, context);
  const double most = has_size ? kTimesAsked * needed_for(*asked.size, bands) : asked.most_elements;
  const image::Thinness found = image::thinness_of(bands);
  const double elements = elements_of(found);
  if (found.part() < kMostlyThin || elements < kNearBudget * most) return {};
  const Vec3 own = spacing_along(image.grid);
  const double coarsest = has_size ? *asked.size : HUGE_VAL;
  double spacing = std::min({own.x, own.y, own.z}), beyond = elements / most;
  if (spacing >= coarsest) return {};
  Image made;
  LabelImage coarse;
  while (beyond > 1 && spacing < coarsest) {
    spacing = std::min(coarsest, spacing * std::max(kLeastStep, elementary::pow(beyond, 1 / kFallOfFaces)));
    made = resampled(image, {std::max(spacing, own.x), std::max(spacing, own.y), std::max(spacing, own.z)}, false,
                     context);
    coarse = bands_of(made, regions, context);
    beyond = elements_of(image::thinness_of(coarse)) / most;
  }
  made.notes = image.notes;
  made.notes.push_back(fmt::format(
      "much of these bands is a voxel thick, and their surfaces alone would make about {:.2g} million elements, where "
      "{} {:.2g} million: they are taken from means of voxels, {:.3g} apart, and so "
      "lose what is thinner. That changes {}. For all voxels give e.g. `resample` {:.6g},{:.6g},{:.6g}; `islands` and "
      "`holes` remove noise",
      elements / 1e6, has_size ? "the size asks for" : "the automatic size has a budget of",
      most / (has_size ? kTimesAsked : 1) / 1e6, spacing, most_changed(bands, coarse), own.x, own.y, own.z));
  return made;
}

}  // namespace octafront::intake
