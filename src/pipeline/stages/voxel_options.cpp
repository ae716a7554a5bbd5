#include <octafront/generate.h>

#include <algorithm>

#include <fmt/format.h>

namespace octafront {

namespace {

// Smoothed surfaces pass up to .87 voxels from the corners of voxels that stick out; with this on top nothing is
// farther from the voxels than one. In voxels.
constexpr double kDeviation = 0.16;

// Where a size is given that is coarser than voxels, the size rules: elements may stray from the net by this part of
// what it exceeds the voxels by, and where layers and details force smaller ones, none is below this part of the size.
// Ten labels in 256^3 voxels then have .15 more elements than the size alone would make, where .16 voxels and a gap of
// one made 1.3 times more.
constexpr double kDeviationOfSize = 0.25, kLeastOfSize = 0.5;

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
      "and thin layers get none below {:.4g}. `max_deviation` {:.3g} follows the voxels, `gap` and `min_size` the "
      "layers",
      *options.size.size, spacing, strays, used.size.min_size.value_or(0), close);
}

// Only a method whose surface front triangulates the net anew can follow it more or less closely.
Options options_for_voxels(Options options, double spacing) {
  options.surface.keep_volumes = true;
  SizeOptions& sizes = options.size;
  const bool follows = !options.surface.keep && options.method != Method::kRecover && options.method != Method::kOctree;
  if (follows && !options.surface.max_deviation && !sizes.elements) {
    if (sizes.size)
      options.surface.max_deviation = std::max(kDeviation * spacing, kDeviationOfSize * (*sizes.size - spacing));
    else if (!sizes.chord_error)
      sizes.chord_error = kDeviation * spacing;
  }
  if (!options.surface.feature_angle) options.surface.feature_angle = kBoxAngle;
  if (!sizes.size && !sizes.elements) return options;
  if (!sizes.gap) sizes.gap = 1;
  double least = std::max(spacing, kLeastOfSize * sizes.size.value_or(0));
  for (const NamedSize& named : sizes.named) least = std::min(least, named.size);  // who names a place means it
  if (!sizes.min_size) sizes.min_size = std::min(least, sizes.size.value_or(spacing));
  return options;
}

}  // namespace octafront
