// Sizes given for places where the model is not: mostly another unit, or another model.

#include <octafront/error.h>

#include "base/core/wording.h"
#include "sizing/make_size_field.h"
#include "sizing/octree_field.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Points so far outside the box, in parts of its diagonal, still speak of this model: coarse surfaces stick out.
constexpr double kBeside = 0.1;

std::string in_words(const Box3& box) {
  return fmt::format("{} to {}", at_point(box.lo), at_point(box.hi));
}

double distance_to(const Box3& box, Vec3 lo, Vec3 hi) {
  return length(max(max(lo - box.hi, box.lo - hi), Vec3{}));
}

void note_regions_outside(const Box3& model, const std::vector<SizeRegion>& regions, const Stage& stage) {
  std::size_t outside = 0;
  std::string first;
  for (const SizeRegion& r : regions) {
    const double away = distance_to(model, r.lo, r.hi) - r.radius;
    if (!(away > 0)) continue;
    if (outside++ == 0)
      first = fmt::format("{} from {} to {}, {:.4g} away", outside == regions.size() ? "it lies" : "the first lies",
                          at_point(r.lo), at_point(r.hi), away);
  }
  if (outside == 0) return;
  stage.note(fmt::format("{} of {} in `regions` {} outside of the model, whose box is {}: {}", outside,
                         counted(regions.size(), "region"), outside == 1 ? "lies" : "lie", in_words(model), first));
}

void note_points_outside(const Box3& model, const std::vector<PointSize>& points, const Stage& stage) {
  const double beside = kBeside * model.diagonal();
  const auto is_outside = [&](const PointSize& s) { return distance_to(model, s.p, s.p) > beside; };
  const auto first = std::find_if(points.begin(), points.end(), is_outside);
  if (first == points.end()) return;
  const auto outside = std::count_if(first, points.end(), is_outside);
  stage.note(fmt::format(
      "{} of {} in `point_sizes` {} outside of the model, whose box is {}: the first at {}, {:.4g} away. The nearest "
      "point speaks for each place of the surface",
      outside, counted(points.size(), "point"), outside == 1 ? "lies" : "lie", in_words(model), at_point(first->p),
      distance_to(model, first->p, first->p)));
}

void judge_cover(const SurfaceMesh& surface, const Box3& model, const SizeField& field, const Stage& stage) {
  const OctreeField* grid = as_octree_field(field);
  if (grid == nullptr) return;
  const double side = grid->root.side;
  const Box3 cover{grid->root.lo, grid->root.lo + Vec3{side, side, side}};
  const auto outside =
      std::count_if(surface.points.begin(), surface.points.end(), [&](Vec3 p) { return distance_to(cover, p, p) > 0; });
  if (outside == 0) return;
  if (distance_to(cover, model.lo, model.hi) > 0)
    throw OptionError(fmt::format(
        "`field` covers {}, and the model lies elsewhere, {}: give the field that was made for it, in its unit",
        in_words(cover), in_words(model)));
  stage.note(fmt::format(
      "{:.2g} % of the surface's vertices lie outside of what `field` covers, {}: sizes there are those of the "
      "nearest place in it",
      100.0 * static_cast<double>(outside) / static_cast<double>(surface.points.size()), in_words(cover)));
}

}  // namespace

void note_misplaced_sizes(const SurfaceMesh& surface, const SizeOptions& options, const Stage& stage) {
  const Box3 model = bounding_box(surface.points);
  note_regions_outside(model, options.regions, stage);
  note_points_outside(model, options.point_sizes, stage);
  if (options.field) judge_cover(surface, model, *options.field, stage);
}

}  // namespace octafront
