#include <octafront/error.h>
#include <octafront/option_table.h>

#include "base/core/index_range.h"
#include "base/core/wording.h"
#include "sizing/field/octree_field.h"
#include "sizing/sources/make_size_field.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

namespace octafront {

namespace {

void require(bool holds, const std::string& sentence) {
  if (!holds) throw OptionError(sentence);
}

void require_order(const char* low_name, const std::optional<double>& low, const char* name,
                   const std::optional<double>& high) {
  require(!low || !high || *low <= *high,
          fmt::format("`{}` {} is larger than `{}` {}", low_name, low.value_or(0), name, high.value_or(0)));
}

// Sizes given for places where the model is not are mostly in another unit, or for another model.

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

namespace {

void check_near(const NearSize& near) {
  const std::string what = near.name.empty() ? "the point" : fmt::format("\"{}\"", near.name);
  require(near.name.empty() ? is_finite(near.point) : true, "`size_near` names a point at no finite place");
  require(std::isfinite(near.size) && near.size > 0,
          fmt::format("the size near {} must be a number above 0, but is {}", what, near.size));
  require(std::isfinite(near.distance) && near.distance > 0,
          fmt::format("the distance up to which the size near {} rises must be a number above 0, but is {}", what,
                      near.distance));
}

template <class Elements>
void require_points_of(const Elements& elements, std::size_t points) {
  for (const auto& element : elements)
    for (const VertexIndex v : element)
      require(v < points,
              fmt::format("the mesh with sizes has an element with the point {}, but {} points", v, points));
}

void check_mesh(const SizeMesh& mesh) {
  const std::size_t elements = mesh.tets.empty() ? mesh.triangles.size() : mesh.tets.size();
  require(elements > 0, "the mesh with sizes has no elements");
  require_points_of(mesh.tets, mesh.points.size());
  require_points_of(mesh.triangles, mesh.points.size());
  for (const Vec3 p : mesh.points) require(is_finite(p), "the mesh with sizes has a point at no finite place");
  const bool at_points = !mesh.point_sizes.empty();
  require(at_points ? mesh.point_sizes.size() == mesh.points.size() : mesh.element_sizes.size() == elements,
          fmt::format("the mesh with sizes has {} points and {} elements, but {} sizes", mesh.points.size(), elements,
                      at_points ? mesh.point_sizes.size() : mesh.element_sizes.size()));
  for (const double h : at_points ? mesh.point_sizes : mesh.element_sizes)
    require(std::isfinite(h) && h > 0, fmt::format("the mesh with sizes has size {}: sizes must be above 0", h));
}

}  // namespace

void check_size_options(const SizeOptions& o) {
  Options ranges;
  ranges.size = o;
  check_ranges(ranges);
  require(!o.elements || *o.elements <= kMostElements,
          fmt::format("`elements` is {}, but a mesh can hold {} at most", o.elements.value_or(0), kMostElements));
  require(!(o.size && o.elements), "`size` and `elements` contradict each other: give one of them");
  require_order("min_size", o.min_size, "max_size", o.max_size);
  require_order("min_size", o.min_size, "size", o.size);
  require_order("size", o.size, "max_size", o.max_size);
  const bool has_source = o.size || o.elements || o.curvature || o.gap || o.feature_elements || o.facets ||
                          o.min_size || o.max_size || !o.regions.empty() || !o.point_sizes.empty() ||
                          !o.named.empty() || o.callback || o.through || !o.near.empty() || o.mesh;
  require(!(o.field && has_source),
          "a size grid is all there is to say about the sizes: no other source or limit of sizes can be given with it");
  for (const NamedSize& n : o.named)
    require(std::isfinite(n.size) && n.size > 0,
            fmt::format("the size of \"{}\" must be a number above 0, but is {}", n.name, n.size));
  for (const NamedSize& n : o.named)
    require(
        n.of_thickness == 0 ||
            (n.of_thickness > 0 && std::isfinite(n.of_thickness) && n.most >= n.size && std::isfinite(n.most)),
        fmt::format("the sizes of \"{}\" by thickness go from {} to {}, with a factor of {}: give a range upwards and "
                    "a factor above 0",
                    n.name, n.size, n.most, n.of_thickness));
  for (const NearSize& n : o.near) check_near(n);
  if (o.mesh) check_mesh(*o.mesh);
  for (const PointSize& s : o.point_sizes) {
    require(is_finite(s.p) && std::isfinite(s.size) && s.size > 0,
            fmt::format("the size {} at the point ({}, {}, {}) must be above 0, at a finite place", s.size, s.p.x,
                        s.p.y, s.p.z));
  }
  for (const SizeRegion& r : o.regions) {
    require(is_finite(r.lo) && is_finite(r.hi) && r.lo.x <= r.hi.x && r.lo.y <= r.hi.y && r.lo.z <= r.hi.z,
            fmt::format("the region from ({}, {}, {}) to ({}, {}, {}) is no box", r.lo.x, r.lo.y, r.lo.z, r.hi.x,
                        r.hi.y, r.hi.z));
    require(
        std::isfinite(r.size) && r.size > 0 && std::isfinite(r.radius) && r.radius >= 0,
        fmt::format("the region at ({}, {}, {}) has size {} and radius {}: the size must be above 0, the radius not "
                    "below",
                    r.lo.x, r.lo.y, r.lo.z, r.size, r.radius));
  }
}

void note_misplaced_sizes(const SurfaceMesh& surface, const SizeOptions& options, const Stage& stage) {
  const Box3 model = bounding_box(surface.points);
  note_regions_outside(model, options.regions, stage);
  note_points_outside(model, options.point_sizes, stage);
  note_outside_of_mesh(surface, options, stage);
  if (options.field) judge_cover(surface, model, *options.field, stage);
}

}  // namespace octafront
