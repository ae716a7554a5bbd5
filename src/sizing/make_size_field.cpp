#include "sizing/make_size_field.h"

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "base/mesh/index_range.h"
#include "sizing/affordable.h"
#include "sizing/background_grid.h"
#include "sizing/region_caps.h"
#include "sizing/size_sources.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/core.h>

namespace octafront {

namespace {

/// --elements: sizes are scaled until the expected number is this close.
constexpr double kCountTolerance = 0.02;
constexpr int kMostScalings = 10;
/// A number that stays farther off, in logarithms, is told to the user.
constexpr double kWorthANote = 0.05;
/// The count falls with the third power of the sizes, less what gradation decides: so much on average over models.
constexpr double kMeanSlope = -2.3, kSteepest = -4, kFlattest = -1;
/// Leaves of the first look, over those of the grid: a quarter of its time, for a count that is off by up to 10 %.
constexpr double kFirstLook = 2;
/// A count off by less, in logarithms, is mended on the leaves that there are: sizes change by a third of it.
constexpr double kOnSameLeaves = 0.15;
constexpr double kSlopeOfWhole = -3;
/// How often the scale is corrected on the grid that there is, before a new one is made.
constexpr int kForesteps = 2;
/// Elements that sizes of our own choice come to at most, about: some ten seconds of work, and more than most models
/// need; for each triangle of the input twenty more.
constexpr double kBudget = 1e6, kBudgetPerTriangle = 20, kMostBudget = 3e6;
/// Of these what details get before the surface is made, which takes the rest for what it has to follow: strips between
/// lines, and places where it would stray.
constexpr double kForDetails = 400'000;
/// For that small sizes are raised by this factor at most: real details, such as a thousand small holes, would
/// be lost.
constexpr double kMostSmallRaised = 2.7;
constexpr int kBudgetSteps = 6;
/// Details that ask for so many budgets, as thousands of small bodies do, are counted on the surface alone: their grid
/// would take more time and memory than the mesh.
constexpr double kFarBeyond = 3;
/// No floor needs to be above the model's extent, which is thirty base sizes.
constexpr double kLargestFloor = 30;
constexpr double kNearBudget = 0.07;
/// Samples along the side of the root cube where one size holds everywhere: two to a leaf of GridRules::plain_level.
constexpr double kPlainSamples = 64;

GridRules rules_for(const WantedSizes& wanted, const SizeOptions& options, const RootCube& root) {
  GridRules rules;
  rules.gradation = options.gradation;
  rules.interior_below_surface = options.interior == SizeOptions::Interior::kUniform;
  rules.resolve_surface = !rules.interior_below_surface;
  rules.ceiling = std::min(wanted.ceiling, root.side);
  rules.keep_sources = options.elements.has_value();
  return rules;
}

WantedSizes scaled(const WantedSizes& wanted, double factor, const SizeOptions& options) {
  const double low = options.min_size.value_or(0), high = options.max_size.value_or(HUGE_VAL);
  WantedSizes result = wanted;
  for (double& h : result.face) h = std::clamp(h * factor, low, high);
  for (SizeSample& s : result.points) s.h = std::clamp(s.h * factor, low, high);
  result.ceiling = std::clamp(result.ceiling * factor, low, high);
  if (wanted.at_place) {
    result.at_place.at = [f = wanted.at_place.at, factor, low, high](const PlaceOnSurface& p) {
      return std::clamp(f(p) * factor, low, high);
    };
  }
  return result;
}

/// Where one size holds everywhere the grid has a plain level of leaves, and samples need be no denser than these.
std::vector<SizeSample> even_samples(const SurfaceMesh& surface, double h, const RootCube& root,
                                     const RunContext& context) {
  const double spacing = std::max(h, root.side / kPlainSamples);
  std::vector<SizeSample> samples =
      sample_surface(surface, std::vector<double>(surface.triangles.size(), spacing), {}, context);
  for (SizeSample& s : samples) s.h = h;
  return samples;
}

/// `coarser`: leaves so many times larger than they are to be.
SizeField grid_field(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                     const RunContext& context, double coarser = 1) {
  const RootCube root = RootCube::around(bounding_box(surface.points), kRootMargin);
  GridRules rules = rules_for(wanted, options, root);
  rules.leaf_per_size *= coarser;
  std::vector<SizeSample> samples = wanted.even && !rules.resolve_surface
                                        ? even_samples(surface, wanted.face.front(), root, context)
                                        : sample_surface(surface, wanted.face, wanted.at_place, context);
  samples.insert(samples.end(), wanted.points.begin(), wanted.points.end());
  auto grid = make_background_grid(root, samples, rules, context);
  return SizeFunction::field(with_regions(std::move(grid), options, context));
}

/// The field that comes out, about, if all sources ask for `factor` times their size: on the same leaves, each size by
/// the same source as before.
OctreeField with_scaled_sources(const OctreeField& grid, double factor, const SizeOptions& options) {
  const double low = options.min_size.value_or(0) / grid.root.side,
               high = options.max_size.value_or(HUGE_VAL) / grid.root.side;
  const bool is_flat = options.interior == SizeOptions::Interior::kUniform;
  const double ceiling = is_flat ? std::clamp(grid.high * factor, low, high) : HUGE_VAL;
  OctreeField result = grid;
  parallel_for(grid.h.size(), [&](std::size_t l) {
    for (int k = 0; k < 8; ++k) {
      const double source = grid.source[l][k], growth = grid.h[l][k] - source;
      result.h[l][k] = std::min(ceiling, std::clamp(source * factor, low, high) + growth);
    }
  });
  result.find_range();
  return result;
}

/// By how much to scale all sources so that the expected number of elements grows by `more`, all in logarithms.
double step_to_count(const SizeField& sizes, double more, const TetPrediction& expected, const SizeOptions& options) {
  const OctreeField& grid = *as_octree_field(sizes);
  double step = more / kMeanSlope;
  if (grid.source.empty() || step == 0) return step;
  const auto expected_here = expected.on_leaves_of(grid);
  const double here = std::log(expected_here(grid));
  for (int i = 0; i < kForesteps; ++i) {
    const double there = std::log(expected_here(with_scaled_sources(grid, std::exp(step), options)));
    step = more / std::clamp((there - here) / step, kSteepest, kFlattest);
  }
  return step;
}

/// Whether a field multiplied by a factor is the one that multiplied sources give: nothing in it stays what it is.
bool scales_as_a_whole(const SizeOptions& options) {
  return !options.min_size && !options.max_size && options.regions.empty();
}

// A first look on larger leaves tells the scale but for some percent, a grid is made at that scale, and what is left is
// taken off it as it is: one grid of full resolution.
SizeField scaled_to_count(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                          const Stage& stage) {
  const double target = std::log(static_cast<double>(*options.elements));
  std::optional<TetPrediction> prediction;
  std::optional<SizeField> first_look;
  parallel_invoke([&] { prediction.emplace(surface); },
                  [&] { first_look = grid_field(surface, wanted, options, stage.context(), kFirstLook); });
  const TetPrediction& expected = *prediction;
  SizeField last = *first_look, best = last;
  double scale = 0, more = target - std::log(expected(last)), least_miss = HUGE_VAL;
  int steps = 0;
  for (; least_miss > kCountTolerance && steps < kMostScalings; ++steps) {
    const bool on_same_leaves = steps > 0 && std::abs(more) < kOnSameLeaves && scales_as_a_whole(options);
    if (on_same_leaves) {
      scale += more / kSlopeOfWhole;
      last = octafront::scaled(last, std::exp(more / kSlopeOfWhole), stage.context());
    } else {
      scale += step_to_count(last, more, expected, options);
      last = grid_field(surface, scaled(wanted, std::exp(scale), options), options, stage.context());
    }
    more = target - std::log(expected(last));
    if (std::abs(more) < least_miss) {
      least_miss = std::abs(more);
      best = last;
    } else if (on_same_leaves && least_miss < kWorthANote) {
      break;  // the lattice's cells double here or there: counts jump
    }
  }
  stage.count("scalings", steps);
  if (least_miss > kWorthANote) {
    stage.note(fmt::format("{} elements were asked for, but the limits on the size give {:.3g}", *options.elements,
                           expected(best)));
  }
  return best;
}

WantedSizes raised_wanted(const WantedSizes& wanted, double floor) {
  WantedSizes result = wanted;
  for (double& h : result.face) h = std::max(h, floor);
  for (SizeSample& s : result.points) s.h = std::max(s.h, floor);
  result.ceiling = std::max(result.ceiling, floor);
  if (wanted.at_place) {
    result.at_place.at = [f = wanted.at_place.at, floor](const PlaceOnSurface& p) { return std::max(f(p), floor); };
  }
  return result;
}

/// Raised to the least of some floors between `low` and `high` that leaves no more than `most` elements; to `high`
/// where even that leaves more.
struct Raised {
  SizeField field;
  double count;
};
Raised raised_to_count(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                       const TetPrediction& expected, double most, double low, double high, const RunContext& context) {
  std::optional<Raised> best;
  for (int step = 0; step < kBudgetSteps; ++step) {
    const double floor = step == 0 ? high : std::sqrt(low * high);
    SizeField coarser = grid_field(surface, raised_wanted(wanted, floor), options, context);
    const double count = expected(coarser);
    const bool is_within = count <= most, is_near = std::abs(count / most - 1) < kNearBudget;
    (is_within ? high : low) = floor;
    if (is_within || is_near || step == 0) best = {std::move(coarser), count};
    if (is_near || (step == 0 && !is_within)) break;
  }
  return std::move(*best);
}

/// Elements that a largest size alone makes: they are the user's own choice.
double forced_by_largest(const SurfaceMesh& surface, const SizeOptions& options) {
  if (!options.max_size) return 0;
  const double h = *options.max_size;
  return kTetsPerCube * std::abs(enclosed_volume(surface)) / (h * h * h) + kTetsPerSquare * area(surface) / (h * h);
}

/// Sizes of our own choice must not make a large mesh that nobody asked for, as the noise of a scan does, or a thousand
/// small holes: then the smallest sizes are raised until the number of elements is within the budget.
SizeField within_budget(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                        double budget, const Stage& stage) {
  const TetPrediction expected(surface);
  const double for_details = kForDetails / std::pow(options.automatic_factor, 3) + forced_by_largest(surface, options);
  double first = Affordable(surface, options).tets_by(wanted.face), low = *std::ranges::min_element(wanted.face);
  if (!(first > kFarBeyond * budget)) {
    SizeField field = grid_field(surface, wanted, options, stage.context());
    first = expected(field);
    if (first <= for_details) return field;
    low = field.min_size();
  }
  const double high = std::min(wanted.ceiling, kMostSmallRaised * low);
  Raised made = raised_to_count(surface, wanted, options, expected, for_details, low, high, stage.context());
  if (made.count > budget)
    made = raised_to_count(
        surface, wanted, options, expected, budget, high,
        std::min(kLargestFloor * *std::ranges::max_element(wanted.face), options.max_size.value_or(HUGE_VAL)),
        stage.context());
  const std::string in_all =
      std::isfinite(budget) ? fmt::format(" (with what the surface takes, at most {:.2g} million)", budget / 1e6) : "";
  stage.note(fmt::format(
      "the details of this surface ask for sizes down to {:.3g}, which is {:.3g} million elements: automatic sizes are "
      "no smaller than {:.3g}, which is about {:.3g} million{}. For more of the details ask for them, e.g. with "
      "`automatic_factor`, `elements`, `curvature`, `gap` or `min_size`",
      low, first / 1e6, made.field.min_size(), made.count / 1e6, in_all));
  return std::move(made.field);
}

void refuse_huge_counts(const SurfaceMesh& surface, const WantedSizes& wanted) {
  const double largest = *std::max_element(wanted.face.begin(), wanted.face.end());
  const double by_volume = kTetsPerCube * std::abs(enclosed_volume(surface)) / (largest * largest * largest);
  const double count = std::max(by_volume, kTetsPerSquare * area(surface) / (largest * largest));
  if (count <= static_cast<double>(kMostElements)) return;
  throw OptionError(fmt::format(
      "a size of {:.4g} would give about {:.3g} elements, more than the {} that a mesh can hold: ask for a larger size",
      largest, count, kMostElements));
}

}  // namespace

double automatic_budget(const SurfaceMesh& surface, const SizeOptions& options) {
  if (!has_no_size_source(options)) return HUGE_VAL;
  const double budget = kBudget + kBudgetPerTriangle * static_cast<double>(surface.triangles.size());
  return std::min(budget, kMostBudget) / std::pow(options.automatic_factor, 3) + forced_by_largest(surface, options);
}

SizeField make_size_field(const KnownSurface& known, const SizeOptions& options, const Stage& stage,
                          const FaceRules& rules, double budget) {
  const SurfaceMesh& surface = known.mesh();
  check_size_options(options);
  if (surface.triangles.empty()) throw InputError("the surface has no triangles: there is nothing to choose sizes for");
  if (options.field) return *options.field;
  WantedSizes wanted = wanted_sizes(known, options, stage, rules);
  if (wanted.automatic && !options.elements && options.automatic_factor != 1)
    wanted = scaled(wanted, options.automatic_factor, options);
  if (!options.elements) refuse_huge_counts(surface, wanted);
  SizeField field = options.elements   ? scaled_to_count(surface, wanted, options, stage)
                    : wanted.automatic ? within_budget(surface, wanted, options, budget, stage)
                                       : grid_field(surface, wanted, options, stage.context());
  const OctreeField& grid = *as_octree_field(field);
  stage.count("leaves", static_cast<double>(grid.tree.size()));
  stage.count("levels", grid.tree.depth());
  stage.count("smallest size", field.min_size());
  stage.count("largest size", field.max_size());
  return field;
}

}  // namespace octafront
