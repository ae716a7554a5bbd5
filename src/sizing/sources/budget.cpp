#include "sizing/sources/budget.h"

#include "base/core/elementary.h"
#include "sizing/field/affordable.h"
#include "sizing/field/change_size_field.h"
#include "sizing/sources/model_extent.h"
#include "sizing/sources/source_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {
namespace {

/// From the least slope on a step would go nowhere.
constexpr double kFirstSlope = -3, kSteepest = -4, kFlattest = -0.5;
/// Counts that change by less than this part of the least slope stand still.
constexpr double kStandsStill = 0.1;
/// A flatter slope is believed towards larger sizes for so long a step at most, or as long as the first slope makes it:
/// where details of the surface decide, the count falls off a cliff once sizes outgrow them.
constexpr double kFlat = -0.9, kMostBeyond = 0.693;  // twice the size
/// So many steps in turn must have changed nothing.
constexpr int kStillSteps = 2;
/// Smaller steps say nothing: the lattice's cells may double with them, or not.
constexpr double kTellingStep = 0.1;

}  // namespace

CountSearch::CountSearch(double wanted, double scale)
    : wanted_(elementary::log(wanted)), scale_(scale), slope_(kFirstSlope), least_miss_(HUGE_VAL) {}

double CountSearch::factor() const {
  return elementary::exp(scale_);
}

double CountSearch::slope_between(double scale_change, double count_change) {
  return std::clamp(count_change / scale_change, kSteepest, kFlattest);
}

void CountSearch::came_out(double count) {
  before_ = last_;
  last_ = {scale_, elementary::log(count), true};
  (is_above(last_) ? above_ : below_) = last_;
  if (before_.is_known && before_.scale != scale_)
    slope_ = slope_between(scale_ - before_.scale, last_.count - before_.count);
  still_ = did_nothing() ? still_ + 1 : 0;
  is_best_ = std::abs(missing()) < least_miss_;
  if (is_best_) least_miss_ = std::abs(missing());
}

void CountSearch::step() {
  if (!above_.is_known || !below_.is_known)
    step_beyond();
  else if (is_above(before_) == is_above(last_))
    scale_ = 0.5 * (above_.scale + below_.scale);
  else
    scale_ = above_.scale + (below_.scale - above_.scale) * (above_.count - wanted_) / (above_.count - below_.count);
}

void CountSearch::step_beyond() {
  const double most = std::max(kMostBeyond, std::abs(missing() / kFirstSlope));
  const double step = missing() / slope_;
  scale_ += slope_ > kFlat ? std::min(step, most) : step;
}

bool CountSearch::did_nothing() const {
  const double step = last_.scale - before_.scale;
  return before_.is_known && std::abs(step) > kTellingStep &&
         (last_.count - before_.count) / step > kStandsStill * kFlattest;
}

bool CountSearch::stands_still() const {
  return still_ >= kStillSteps;
}

namespace {

/// Some ten seconds of work, and more than most models need.
constexpr double kBudget = 3e5, kBudgetPerTriangle = 5, kMostBudget = 1.5e6;
/// Of these what details get before the surface is made. The surface takes the rest for what it has to follow: strips
/// between lines, and places where it would deviate.
constexpr double kForDetails = 200'000;
/// A body that is thinner than its base size by and large, as plates, stars, combs and wires are, gets so many times
/// what the base size alone comes to, and this much in any case: its gaps and bends ask for very many.
constexpr double kTimesBase = 4, kLeastForDetails = 50'000;
/// For details small sizes are raised by this factor at most: real details, such as a thousand small holes, would
/// be lost.
constexpr double kMostSmallRaised = 2.7;
constexpr int kBudgetSteps = 6;
/// Details that ask for so many budgets, as thousands of small bodies do, are counted on the surface alone: their grid
/// would take more time and memory than the mesh.
constexpr double kFarBeyond = 3;
/// No floor needs to be above the model's extent, which is thirty base sizes.
constexpr double kLargestFloor = 30;
constexpr double kNearBudget = 0.07;

/// Elements that a largest size alone makes: they are the user's own choice.
double forced_by_largest(const SurfaceMesh& surface, const SizeOptions& options) {
  if (!options.max_size) return 0;
  const double h = *options.max_size;
  return kTetsPerCube * std::abs(enclosed_volume(surface)) / (h * h * h) + kTetsPerSquare * area(surface) / (h * h);
}

/// A budget of the usual size, as the user's own factor changes it. What is coarse is cheap: it need not be held so far
/// down that the surface could not be made.
double with_factor(double budget, const SizeOptions& options) {
  constexpr double kLeast = 50'000;
  return std::max(budget / elementary::pow(options.automatic_factor, 3), std::min(budget, kLeast));
}

double with_choices(double budget, const SurfaceMesh& surface, const SizeOptions& options) {
  return with_factor(budget, options) + forced_by_largest(surface, options);
}

/// What details get, in proportion to the shape.
double for_details(const SurfaceMesh& surface) {
  const double h = base_size(surface), a = area(surface), v = std::abs(enclosed_volume(surface));
  const bool is_thin = 2 * v < h * a;
  const double base = kTetsPerCube * v / (h * h * h) + kTetsPerSquare * a / (h * h);
  return is_thin ? std::clamp(kTimesBase * base, kLeastForDetails, kForDetails) : kForDetails;
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
    SizeField coarser =
        source_grid(surface, wanted.with([&](double h) { return std::max(h, floor); }), options, context);
    const double count = expected(coarser);
    const bool is_within = count <= most, is_near = std::abs(count / most - 1) < kNearBudget;
    (is_within ? high : low) = floor;
    if (is_within || is_near || step == 0) best = {std::move(coarser), count};
    if (is_near || (step == 0 && !is_within)) break;
  }
  return std::move(*best);
}

/// How often the floor of sizes is corrected: to a hundredth of the way between the least and greatest size.
constexpr int kFloorSteps = 8;

/// The sizes of `grid` raised to a floor, but not above `most`.
OctreeField raised_grid(const OctreeField& grid, const RawVector<std::array<double, 8>>& most, double floor) {
  return with_sizes(grid, [&](std::size_t l, int k) { return std::max(grid.h[l][k], std::min(most[l][k], floor)); });
}

}  // namespace

double automatic_budget(const SurfaceMesh& surface, const SizeOptions& options) {
  if (!has_no_size_source(options)) return HUGE_VAL;
  const double budget = kBudget + kBudgetPerTriangle * static_cast<double>(surface.triangles.size());
  return with_choices(std::min(budget, kMostBudget), surface, options);
}

double most_automatic_budget(const SizeOptions& options) {
  return has_no_size_source(options) ? with_factor(kMostBudget, options) : HUGE_VAL;
}

SizeField within_budget(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                        double budget, const Stage& stage) {
  const TetPrediction expected(surface);
  const double most_details = with_choices(for_details(surface), surface, options);
  double first = Affordable(surface, options).tets_on_faces([&](std::size_t f) { return wanted.face[f]; });
  double low = *std::ranges::min_element(wanted.face);
  if (!(first > kFarBeyond * budget)) {
    SizeField field = source_grid(surface, wanted, options, stage.context());
    first = expected(field);
    if (first <= most_details) return field;
    low = field.min_size();
  }
  const double high = std::min(wanted.ceiling, kMostSmallRaised * low);
  Raised made = raised_to_count(surface, wanted, options, expected, most_details, low, high, stage.context());
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

WithinCount within_count(const SizeField& finer, const SizeField& first, const TetPrediction& expected, double most,
                         const RunContext& context) {
  context.check();
  const OctreeField* grid = as_octree_field(finer);
  if (grid == nullptr) return {finer, expected(finer), 0};
  const auto expected_here = expected.on_leaves_of(*grid);
  const double asked = expected_here(*grid);
  if (asked <= most) return {finer, asked, 0};
  const auto most_sizes = sizes_at_leaves(first, grid->root, grid->tree);
  double low = elementary::log(grid->low), high = elementary::log(first.max_size() / grid->root.side);
  for (int step = 0; step < kFloorSteps; ++step) {
    const double floor = 0.5 * (low + high);
    (expected_here(raised_grid(*grid, most_sizes, elementary::exp(floor))) > most ? low : high) = floor;
  }
  auto coarser = std::make_shared<OctreeField>(raised_grid(*grid, most_sizes, elementary::exp(high)));
  coarser->source = parallel_copy(grid->source);
  grade_again(*coarser, context);
  return {SizeField(SizeFunction::field(std::move(coarser))), asked, elementary::exp(high) * grid->root.side};
}

}  // namespace octafront
