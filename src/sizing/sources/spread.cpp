#include "base/core/parallel.h"
#include "sizing/field/expected_tets.h"
#include "sizing/sources/make_size_field.h"
#include "sizing/sources/source_grid.h"

#include <algorithm>
#include <array>

namespace octafront {

namespace {

/// What is chosen from: above, elements in between lose more than their number saves. Of second order they lose less:
/// stress at notches of a plate, a shaft and a cavity comes as near with two thirds of the unknowns.
constexpr std::array kGradations{kDefaultGradation, 0.15, 0.2, 0.25, 0.3, kSteepestGradation, 0.6, kSteepestCurved};
/// Sizes that rise so fast are everywhere about what is asked for there.
constexpr double kAtOnce = 4;
/// The part of elements that may lie where sizes only rise.
constexpr double kMostBetween = 0.3;
/// Leaves of the grid that this is judged on, over those of the one to be made.
constexpr double kCoarserToJudge = 2;

/// About the field of this gradation, on the leaves of one of kDefaultGradation.
OctreeField rising_by(const OctreeField& grid, double gradation) {
  const double steeper = gradation / kDefaultGradation;
  return with_sizes(grid, [&](std::size_t l, int k) {
    const double source = grid.source[l][k];
    return std::min(grid.high, source + (grid.h[l][k] - source) * steeper);
  });
}

}  // namespace

double gradation_by_spread(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                           double steepest, const RunContext& context) {
  if (wanted.even) return kDefaultGradation;
  SizeOptions plain = options;
  plain.gradation = kDefaultGradation;
  plain.regions.clear();
  const SizeField coarse = source_grid(surface, wanted, plain, context, {kCoarserToJudge, true});
  const OctreeField& grid = *as_octree_field(coarse);
  if (grid.low == grid.high) return kDefaultGradation;
  const TetPrediction expected(surface);
  const auto expected_here = expected.on_leaves_of(grid);
  const double most = expected_here(rising_by(grid, kAtOnce)) / (1 - kMostBetween);
  const auto end = std::ranges::find(kGradations, steepest);
  return *std::find_if(kGradations.begin(), end, [&](double g) { return expected_here(rising_by(grid, g)) <= most; });
}

}  // namespace octafront
