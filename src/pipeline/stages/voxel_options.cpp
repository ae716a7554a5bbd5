#include <octafront/generate.h>

#include <algorithm>

#include <fmt/format.h>

namespace octafront {

namespace {

// Smoothed surfaces pass up to .87 voxels from the corners of voxels that stick out; with this on top nothing is
// farther from the voxels than one. In voxels.
constexpr double kDeviation = 0.16;

// Where a size is given that is coarser than voxels, the size rules: elements may stray from the net by this part of
// what it exceeds the voxels by, and what details force is no smaller than this part of the size. Six segmentations
// then have a quarter to a half of the elements that a gap of one element and a quarter of the size made, and Dice's
// coefficient is within .01 of all but one (docs/measured/images-needed.md).
constexpr double kDeviationOfSize = 0.5, kLeastOfSize = 0.5;

// Creases of nets are steps of voxels that smoothing could not level, not edges of a body: only those of the image's
// box are. Degrees.
constexpr double kBoxAngle = 85;

}  // namespace

std::string given_up_for_size(const Options& options, double spacing) {
  const Options used = options_for_voxels(options, spacing);
  if (!options.size.size || options.surface.max_deviation || !used.surface.max_deviation) return {};
  const double strays = *used.surface.max_deviation, close = kDeviation * spacing;
  if (strays <= close) return {};
  return fmt::format(
      "elements of {:.4g} are coarser than voxels of {:.4g}: their surfaces may stray by {:.3g} from those of the "
      "voxels, "
      "and layers thinner than elements get flat ones. `max_deviation` {:.3g} follows the voxels, `gap` 1 the layers",
      *options.size.size, spacing, strays, close);
}

// Only a method whose surface front triangulates the net anew can follow it more or less closely.
Options options_for_voxels(Options options, double spacing) {
  options.surface.keep_volumes = true;
  SizeOptions& sizes = options.size;
  const bool follows = !options.surface.keep && options.method != Method::kRecover && options.method != Method::kOctree;
  const bool is_bounded = options.surface.max_deviation.has_value();
  if (follows && !is_bounded && !sizes.elements) {
    if (sizes.size)
      options.surface.max_deviation = std::max(kDeviation * spacing, kDeviationOfSize * (*sizes.size - spacing));
    else if (!sizes.chord_error)
      sizes.chord_error = kDeviation * spacing;
  }
  if (!options.surface.feature_angle) options.surface.feature_angle = kBoxAngle;
  if (is_bounded)
    options.surface.finest = std::min(spacing, *options.surface.max_deviation);
  else if (sizes.size || sizes.elements)
    options.surface.finest =
        std::min(sizes.size.value_or(spacing), std::max(spacing, kLeastOfSize * sizes.size.value_or(0)));
  return options;
}

}  // namespace octafront
