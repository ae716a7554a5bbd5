#include "surface/remeshing/front_work.h"

#include <cmath>

namespace octafront::surface {

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
