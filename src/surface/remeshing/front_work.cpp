#include "surface/remeshing/front_work.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

namespace octafront::surface {

double ElementBudget::expected(const SizeField& sizes) {
  if (!expected_) expected_.emplace(surface_);
  return (*expected_)(sizes);
}

SizeField ElementBudget::affordable(const SizeField& finer, const SizeField& first, int round) {
  if (!is_limited()) return finer;
  if (!expected_) expected_.emplace(surface_);
  const WithinCount met = within_count(finer, first, *expected_, most_, stage_.context());
  if (met.floor == 0) return finer;
  if (!is_spent()) spent_in_round_ = round;
  asked_ = std::max(asked_, met.asked);
  floor_ = met.floor;
  return met.sizes;
}

void ElementBudget::note(std::size_t far, double farthest, double deviation) const {
  std::string left, by;
  if (far > 0) {
    left =
        fmt::format(", and {} places lie farther than {:.4g} from the input, up to {:.4g}", far, deviation, farthest);
    by = fmt::format("`max_deviation` {:.4g} or ", deviation);
  }
  stage_.note(
      fmt::format("this surface asks for {:.2g} million elements, and the automatic size has a budget of {:.2g} "
                  "million: it stops at {:.4g}{}. For more ask for it, e.g. with {}`automatic_factor` 0.7",
                  asked_ / 1e6, most_ / 1e6, floor_, left, by));
}

void FrontCounts::start_round(std::uint64_t points_placed, std::uint64_t places_tried) {
  placed = points_placed;
  tried = places_tried;
  insertion = {};
  coarsen = {};
  improve = {};
  places_mended = 0;
  approached = 0;
}

void FrontCounts::report(const Stage& stage) const {
  stage.count("points placed", static_cast<double>(placed));
  stage.count("places tried", static_cast<double>(tried));
  stage.count("points inserted", static_cast<double>(insertion.inserted));
  stage.count("points skipped", static_cast<double>(insertion.skipped));
  stage.count("collapses", static_cast<double>(coarsen.collapses));
  stage.count("flips", static_cast<double>(coarsen.flips + improve.flips));
  stage.count("smoothing moves", static_cast<double>(improve.moves));
  if (divided_edges > 0) stage.count("edges divided between seams", static_cast<double>(divided_edges));
  stage.count("lines merged", static_cast<double>(merged_lines));
  stage.count("places mended", static_cast<double>(places_mended));
  stage.count("changes judged", static_cast<double>(changes_judged));
  stage.count("points against deviation", static_cast<double>(approached));
  stage.count("input vertices left", static_cast<double>(coarsen.input_vertices_left));
  stage.count("crossing pairs mended", static_cast<double>(crossings));
  stage.count("places left as in the input", static_cast<double>(kept_places));
  stage.count("rounds", rounds);
  stage.count("triangles of all rounds", static_cast<double>(triangles));
  stage.count("rounds for deviation", deviation_rounds);
}

void FrontWork::progress(double part_of_round) const {
  stage.progress(1 - std::ldexp(1 - part_of_round / 2, 1 - counts.rounds));
}

}  // namespace octafront::surface
