
#include "sizing/sources/make_size_field.h"

#include <octafront/error.h>

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "sizing/field/affordable.h"
#include "sizing/field/change_size_field.h"
#include "sizing/field/expected_tets.h"
#include "sizing/sources/budget.h"
#include "sizing/sources/source_grid.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/core.h>

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

/// The gradation that the spread of sizes asks for: the least that leaves no more than a part of the elements to places
/// where sizes only rise, by the prediction on a coarse grid, and no more than `steepest`. kDefaultGradation where all
/// sizes are alike.
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

/// --elements: sizes are scaled until the expected number is this close.
constexpr double kCountTolerance = 0.02;
constexpr int kMostScalings = 10;
/// A number that stays farther off, in logarithms, is told to the user.
constexpr double kWorthANote = 0.05;
/// The slope of counts over sizes (CountSearch) on average over models.
constexpr double kMeanSlope = -2.3;
/// Leaves of the first look, over those of the grid: a quarter of its time, for a count that is off by up to 10 %.
constexpr double kFirstLook = 2;
/// A count off by less, in logarithms, is mended on the leaves that there are: sizes change by a third of it.
constexpr double kOnSameLeaves = 0.15;
constexpr double kSlopeOfWhole = -3;
/// CAD has few small details, which are exact: sizes may rise faster from them. Fifteen parts have 12 % fewer elements
/// than at .4, as good ones; at .7 one falls below 10 degrees.
constexpr double kSteepestOfGeometry = 0.6;
/// How often the scale is corrected on the grid that there is, before a new one is made.
constexpr int kForesteps = 2;

WantedSizes scaled(const WantedSizes& wanted, double factor, const SizeOptions& options) {
  return wanted.with([factor, low = options.min_size.value_or(0), high = options.max_size.value_or(HUGE_VAL)](
                         double h) { return std::clamp(h * factor, low, high); });
}

/// The field that comes out, about, if all sources ask for `factor` times their size: on the same leaves, each size by
/// the same source as before.
OctreeField with_scaled_sources(const OctreeField& grid, double factor, const SizeOptions& options) {
  const double low = options.min_size.value_or(0) / grid.root.side,
               high = options.max_size.value_or(HUGE_VAL) / grid.root.side;
  const bool is_flat = options.interior == SizeOptions::Interior::kUniform;
  const double ceiling = is_flat ? std::clamp(grid.high * factor, low, high) : HUGE_VAL;
  return with_sizes(grid, [&](std::size_t l, int k) {
    const double source = grid.source[l][k], growth = grid.h[l][k] - source;
    return std::min(ceiling, std::clamp(source * factor, low, high) + growth);
  });
}

/// The slope of counts over a factor on all sources, on the way to a number that is larger by `more`, a logarithm.
double slope_of_sources(const SizeField& sizes, double more, const TetPrediction& expected,
                        const SizeOptions& options) {
  const OctreeField& grid = *as_octree_field(sizes);
  double slope = kMeanSlope;
  if (grid.source.empty() || more == 0) return slope;
  const auto expected_here = expected.on_leaves_of(grid);
  const double here = elementary::log(expected_here(grid));
  for (int i = 0; i < kForesteps; ++i) {
    const double step = more / slope;
    const double there = elementary::log(expected_here(with_scaled_sources(grid, elementary::exp(step), options)));
    slope = CountSearch::slope_between(step, there - here);
  }
  return slope;
}

/// Whether a field multiplied by a factor is the one that multiplied sources give: nothing in it stays what it is.
bool scales_as_a_whole(const SizeOptions& options) {
  return !options.min_size && !options.max_size && options.regions.empty();
}

// A first look on larger leaves tells the scale but for some percent, a grid is made at that scale, and what is left is
// taken off it as it is: one grid of full resolution.
SizeField scaled_to_count(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                          const Stage& stage) {
  const auto wanted_count = static_cast<double>(*options.elements);
  std::optional<TetPrediction> prediction;
  std::optional<SizeField> first_look;
  parallel_invoke([&] { prediction.emplace(surface); },
                  [&] { first_look = source_grid(surface, wanted, options, stage.context(), {kFirstLook}); });
  const TetPrediction& expected = *prediction;
  const double more = elementary::log(wanted_count) - elementary::log(expected(*first_look));
  CountSearch search(wanted_count, more / slope_of_sources(*first_look, more, expected, options));
  const auto grid_at_factor = [&] {
    return source_grid(surface, scaled(wanted, search.factor(), options), options, stage.context());
  };
  SizeField last = grid_at_factor(), best = last;
  search.came_out(expected(last));
  int steps = 1;
  for (; search.least_miss() > kCountTolerance && steps < kMostScalings && !search.stands_still(); ++steps) {
    const bool on_same_leaves = std::abs(search.missing()) < kOnSameLeaves && scales_as_a_whole(options);
    if (on_same_leaves) {
      last = octafront::scaled(last, elementary::exp(search.missing() / kSlopeOfWhole), stage.context());
      search.step(kSlopeOfWhole);
    } else {
      search.step(slope_of_sources(last, search.missing(), expected, options));
      last = grid_at_factor();
    }
    search.came_out(expected(last));
    if (search.is_best())
      best = last;
    else if (on_same_leaves && search.least_miss() < kWorthANote)
      break;  // the lattice's cells double here or there: counts jump
  }
  stage.count("scalings", steps);
  if (search.least_miss() > kWorthANote) {
    stage.note(fmt::format("{} elements were asked for, but the limits on the size give {:.3g}", *options.elements,
                           expected(best)));
  }
  return best;
}

double steepest_gradation(const WantedSizes& wanted, const FaceRules& rules) {
  if (rules.curved) return kSteepestCurved;
  return wanted.automatic && rules.turns > 0 ? kSteepestOfGeometry : kSteepestGradation;
}

void refuse_huge_counts(const SurfaceMesh& surface, const WantedSizes& wanted) {
  const double largest = *std::max_element(wanted.face.begin(), wanted.face.end());
  const double by_volume = kTetsPerCube * std::abs(enclosed_volume(surface)) / (largest * largest * largest);
  const double count = std::max(by_volume, kTetsPerSquare * area(surface) / (largest * largest));
  require_affordable(fmt::format("a size of {:.4g}", largest), count);
}

}  // namespace

SizeField make_size_field(const KnownSurface& known, const SizeOptions& given, const Stage& stage,
                          const FaceRules& rules, double budget) {
  const SurfaceMesh& surface = known.mesh();
  check_size_options(given);
  SizeOptions options = given;
  if (surface.triangles.empty()) throw InputError("the surface has no triangles: there is nothing to choose sizes for");
  if (options.field) return *options.field;
  WantedSizes wanted = wanted_sizes(known, options, stage, rules);
  const std::vector<double> asked = wanted.face;
  const double factor = wanted.automatic && !options.elements ? options.automatic_factor : 1;
  if (factor != 1) wanted = scaled(wanted, factor, options);
  if (!options.elements) refuse_huge_counts(surface, wanted);
  // Who names a number of elements pays for no more of them: of first order slow growth makes the better ones.
  if (!options.gradation)
    options.gradation =
        options.elements && !rules.curved
            ? kDefaultGradation
            : gradation_by_spread(surface, wanted, options, steepest_gradation(wanted, rules), stage.context());
  SizeField field = options.elements   ? scaled_to_count(surface, wanted, options, stage)
                    : wanted.automatic ? within_budget(surface, wanted, options, budget, stage)
                                       : source_grid(surface, wanted, options, stage.context());
  wanted.sources.tell(surface, asked, field, options, stage, factor);
  const OctreeField& grid = *as_octree_field(field);
  stage.count("leaves", static_cast<double>(grid.tree.size()));
  stage.count("levels", grid.tree.depth());
  stage.count("gradation", *options.gradation);
  stage.count("smallest size", field.min_size());
  stage.count("largest size", field.max_size());
  return field;
}

}  // namespace octafront
