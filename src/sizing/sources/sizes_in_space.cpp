#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/complex.h"
#include "base/places/places.h"
#include "sizing/field/affordable.h"
#include "sizing/field/mesh_sizes.h"
#include "sizing/field/octree.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
/// Samples inside are no farther apart than this, in sizes: between them sizes grow by a tenth.
constexpr double kInsideStep = 1.5;
/// The inside is divided among threads in cells of this level.
constexpr int kLevelOfParts = 3;
/// Places of the surface that lie farther from options.mesh than this part of the diagonal are outside of it: chords of
/// a coarse mesh cut as much off.
constexpr double kOutside = 0.01;

/// A region, a patch, a curve, a point, a box or a ball.
class Nearby {
 public:
  Nearby(const SurfacePlaces& places, const SurfaceMesh& surface, const NearSize& near) {
    if (near.name.empty()) {
      points_.push_back(near.point);
      triangles_.push_back({0, 0, 0});
    } else if (const Place place = place_of("size_near", near.name); place.is_in_space()) {
      if (const auto* box = std::get_if<Box3>(&place.where)) box_ = *box;
      if (const auto* ball = std::get_if<GroupRule::Sphere>(&place.where))
        box_ = Box3{ball->center, ball->center}, radius_ = ball->radius;
    } else {
      const SurfaceItems items = places.at("size_near", place);
      for (const std::uint32_t region : items.regions) inside_.emplace_back(boundary_of_region(surface, region));
      add(surface, items.triangles, items.edges);
    }
    tree_.emplace(points_, triangles_);
  }

  double distance(Vec3 p) const {
    if (box_) return std::max(0.0, length(max(max(p - box_->hi, box_->lo - p), Vec3{})) - radius_);
    double nearest = tree_->empty() ? kNothing : std::sqrt(tree_->nearest(p).squared_distance);
    for (const TriangleTree& region : inside_) {
      if (nearest == 0 || region.contains(p)) return 0;
      nearest = std::min(nearest, std::sqrt(region.nearest(p).squared_distance));
    }
    return nearest;
  }

 private:
  /// Edges are triangles without area.
  void add(const SurfaceMesh& surface, const std::vector<std::uint32_t>& patch, const std::vector<Edge>& curve) {
    const auto add_triangle = [&](VertexIndex a, VertexIndex b, VertexIndex c) {
      const auto first = static_cast<VertexIndex>(points_.size());
      for (const VertexIndex v : {a, b, c}) points_.push_back(surface.points[v]);
      triangles_.push_back({first, first + 1, first + 2});
    };
    for (const std::uint32_t t : patch)
      add_triangle(surface.triangles[t][0], surface.triangles[t][1], surface.triangles[t][2]);
    for (const Edge& edge : curve) add_triangle(edge[0], edge[1], edge[1]);
  }

  std::vector<Vec3> points_;
  std::vector<Triangle> triangles_;
  std::optional<TriangleTree> tree_;
  std::vector<TriangleTree> inside_;  ///< of regions
  std::optional<Box3> box_;           ///< a box; a ball is a point with a radius
  double radius_ = 0;
};

/// The law of NearSize.
double size_at_distance(const NearSize& near, double distance) {
  return distance < near.distance ? near.size / (1 - distance / near.distance) : kNothing;
}

std::string name_of(const NearSize& near) {
  return near.name.empty()
             ? fmt::format("`size_near` ({:.6g}, {:.6g}, {:.6g})", near.point.x, near.point.y, near.point.z)
             : fmt::format("`size_near` \"{}\"", near.name);
}

SizeInSpace near_place(const SurfacePlaces& places, const SurfaceMesh& surface, const NearSize& near) {
  const auto place = std::make_shared<const Nearby>(places, surface, near);
  return {name_of(near), [place, near](Vec3 p) { return size_at_distance(near, place->distance(p)); },
          [place, near](const Box3& box) {
            return size_at_distance(near, std::max(0.0, place->distance(box.center()) - box.diagonal() / 2));
          }};
}

SizeInSpace on_mesh(const std::shared_ptr<const SizeMesh>& mesh) {
  const auto sizes = std::make_shared<const MeshSizes>(mesh);
  return {fmt::format("`size_field` {}", mesh->name), [sizes](Vec3 p) { return sizes->at(p).size; },
          [sizes](const Box3& box) { return sizes->least_in(box); }};
}

/// The triangles between all regions and what is outside of them.
std::optional<TriangleTree> outer_boundary(const SurfaceMesh& surface) {
  if (surface.sides.empty()) return std::nullopt;
  std::vector<Triangle> outer;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if ((surface.sides[t][0] == kNone) != (surface.sides[t][1] == kNone)) outer.push_back(surface.triangles[t]);
  return TriangleTree(surface.points, outer);
}

/// Samples in the cells of an octree whose sides follow the least size in them.
class InsideSampler {
 public:
  InsideSampler(const KnownSurface& surface, const std::vector<SizeInSpace>& sources, double floor,
                const RunContext& context)
      : outer_(outer_boundary(surface.mesh())),
        tree_(outer_ ? *outer_ : surface.tree()),
        root_(RootCube::around(bounding_box(surface.mesh().points), 0)),
        sources_(sources),
        floor_(floor),
        context_(context) {}

  std::vector<SizeSample> run() const {
    std::vector<OctreeKey> parts{OctreeKey::root()};
    for (int level = 0; level < kLevelOfParts; ++level) {
      std::vector<OctreeKey> finer;
      for (const OctreeKey cell : parts)
        for (int i = 0; i < 8; ++i) finer.push_back(cell.child(i));
      parts = std::move(finer);
    }
    return parallel_collect<SizeSample>(parts.size(), 1,
                                        [&](std::size_t begin, std::size_t end, std::vector<SizeSample>& part) {
                                          for (std::size_t i = begin; i < end; ++i) sample(parts[i], false, part);
                                        });
  }

 private:
  double floored(double size) const { return std::max(floor_, size); }

  double at(Vec3 p) const {
    double least = kNothing;
    for (const SizeInSpace& source : sources_) least = std::min(least, source.at(p));
    return floored(least);
  }

  double least_in(const Box3& box) const {
    double least = kNothing;
    for (const SizeInSpace& source : sources_) least = std::min(least, source.least_in(box));
    return floored(least);
  }

  /// `is_inside`: the whole cell is known to be.
  void sample(OctreeKey cell, bool is_inside, std::vector<SizeSample>& samples) const {
    const Vec3 lo = root_.corner_of(cell);
    const double side = root_.side_of(cell);
    const Box3 box{lo, lo + Vec3{side, side, side}};
    const bool meets_surface =
        !is_inside && !tree_.for_each_box_near(box, [](std::uint32_t, const TriangleCorners&) { return false; });
    if (!is_inside && !meets_surface && !tree_.contains(box.center())) return;
    const double least = least_in(box);
    if (least == kNothing) return;
    if (side > kInsideStep * least && cell.level() < OctreeKey::kMaxLevel) {
      context_.check();
      for (int i = 0; i < 8; ++i) sample(cell.child(i), !meets_surface, samples);
      return;
    }
    const double h = at(box.center());
    if (h == kNothing || (meets_surface && !tree_.contains(box.center()))) return;
    samples.push_back({box.center(), {}, h, box.diagonal() / 2});
    if (samples.size() > kMostInPart)
      throw OptionError(fmt::format(
          "sizes as small as {:.4g} near ({:.6g}, {:.6g}, {:.6g}) are too small for this body; ask for larger sizes or "
          "give a `min_size`",
          h, box.center().x, box.center().y, box.center().z));
  }

  static constexpr std::size_t kMostInPart = 20'000'000;

  std::optional<TriangleTree> outer_;
  const TriangleTree& tree_;
  RootCube root_;
  const std::vector<SizeInSpace>& sources_;
  double floor_;
  const RunContext& context_;
};

}  // namespace

std::vector<SizeInSpace> sizes_in_space(const KnownSurface& surface, const SizeOptions& options) {
  std::vector<SizeInSpace> sources;
  if (options.mesh) sources.push_back(on_mesh(options.mesh));
  if (options.near.empty()) return sources;
  const SurfacePlaces places(surface.mesh(), &surface.edges());
  for (const NearSize& near : options.near) sources.push_back(near_place(places, surface.mesh(), near));
  return sources;
}

SizeAtPlace least_at_places(const std::vector<SizeInSpace>& sources, double floor) {
  if (sources.empty()) return {};
  SizeAtPlace least;
  least.at = [sources, floor](const PlaceOnSurface& place) {
    double size = kNothing;
    for (const SizeInSpace& source : sources) size = std::min(size, source.at(place.p));
    return std::max(floor, size);
  };
  return least;
}

std::vector<SizeSample> samples_inside(const KnownSurface& surface, const std::vector<SizeInSpace>& sources,
                                       double floor, const RunContext& context) {
  if (sources.empty()) return {};
  std::vector<SizeSample> samples = InsideSampler(surface, sources, floor, context).run();
  constexpr double kOfSpacing = kInsideStep * kInsideStep * kInsideStep;
  require_affordable("sizes inside the body", kTetsPerCube * kOfSpacing * static_cast<double>(samples.size()));
  return samples;
}

void note_outside_of_mesh(const SurfaceMesh& surface, const SizeOptions& options, const Stage& stage) {
  if (!options.mesh) return;
  const MeshSizes sizes(options.mesh);
  const Box3 model = bounding_box(surface.points);
  const double beside = kOutside * model.diagonal();
  double outside = 0, farthest = 0, nearest = kNothing;
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[k];
    const double away = sizes.at(centroid(a, b, c)).away;
    nearest = std::min(nearest, away);
    if (away <= beside) continue;
    outside += triangle_area(a, b, c);
    farthest = std::max(farthest, away);
  }
  if (outside == 0) return;
  const auto in_words = [](const Box3& box) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", box.lo.x, box.lo.y, box.lo.z, box.hi.x,
                       box.hi.y, box.hi.z);
  };
  if (nearest > model.diagonal())
    throw OptionError(fmt::format(
        "the mesh with sizes {} lies elsewhere, {}, than the model, {}: give one of this model, in its unit",
        options.mesh->name, in_words(sizes.box()), in_words(model)));
  stage.note(fmt::format(
      "{:.2g} % of the surface lie outside of the mesh with sizes {}, by up to {:.3g}: there its nearest point speaks",
      100 * outside / area(surface), options.mesh->name, farthest));
}

}  // namespace octafront
