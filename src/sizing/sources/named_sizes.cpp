#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/complex.h"
#include "base/places/places.h"
#include "sizing/field/affordable.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Samples inside a region lie on a grid of this spacing, in sizes: between them sizes grow by a tenth.
constexpr double kInside = 1.5;
/// The same along a curve.
constexpr double kAlong = 0.5;

class Named {
 public:
  Named(const KnownSurface& known, const SizeOptions& options)
      : surface_(known.mesh()), tree_(known.tree()), options_(options), places_(known.mesh(), &known.edges()) {
    result_.face.assign(surface_.triangles.size(), std::numeric_limits<double>::infinity());
  }

  NamedSizes run() {
    for (const NamedSize& named : options_.named) {
      const double h = std::max(named.size, options_.min_size.value_or(0));
      const SurfaceItems items = places_.at("size_of", place_of("size_of", named.name));
      if (named.of_thickness > 0) {
        if (items.regions.empty())
          throw OptionError(
              fmt::format("`size_of`: \"{}\" is no region: only regions have sizes by their thickness", named.name));
        for (const std::uint32_t region : items.regions) ask_by_thickness(region, named, h);
        continue;
      }
      for (const std::uint32_t region : items.regions) ask_region(region, named.name, h);
      for (const std::uint32_t t : items.triangles) result_.face[t] = std::min(result_.face[t], h);
      for (const Edge& edge : items.edges) ask_edge(edge, h);
    }
    return std::move(result_);
  }

 private:
  void ask_region(std::uint32_t region, const std::string& name, double h) {
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
      for (const std::uint32_t side : surface_.sides_of(t))
        if (side == region) result_.face[t] = std::min(result_.face[t], h);
    add_inside(boundary_of_region(surface_, region), name, h);
  }

  void ask_by_thickness(std::uint32_t region, const NamedSize& named, double least) {
    const double most = std::max(named.most, least);
    parallel_for(surface_.triangles.size(), [&](std::size_t t) {
      const auto [front, behind] = surface_.sides_of(static_cast<std::uint32_t>(t));
      for (const auto& [side, into] : {std::pair{front, 1.0}, {behind, -1.0}})
        if (side == region)
          result_.face[t] = std::min(
              result_.face[t],
              std::clamp(named.of_thickness * thickness(t, into, least, most / named.of_thickness), least, most));
    });
    add_inside(boundary_of_region(surface_, region), named.name, most);
  }

  /// From the middle of a triangle along its normal, or against it, to what faces it: within 60 degrees, for walls of
  /// voxels are rough. `reach` where there is nothing nearer.
  double thickness(std::size_t t, double into, double least, double reach) const {
    constexpr double kFacing = 0.5;
    const auto normal_of = [&](std::size_t f) {
      const auto& [i, j, k] = surface_.triangles[f];
      return unit_normal(surface_.points[i], surface_.points[j], surface_.points[k]);
    };
    const auto& [a, b, c] = surface_.triangles[t];
    const double skipped = 0.05 * std::min(least, reach);  // its own triangle and its neighbours lie there
    const Vec3 direction = normal_of(t) * into;
    const Vec3 from = centroid(surface_.points[a], surface_.points[b], surface_.points[c]) + direction * skipped;
    const TriangleTree::RayHit hit = tree_.first_hit(from, direction, reach - skipped);
    if (hit.triangle == kNone || std::abs(dot(normal_of(hit.triangle), direction)) < kFacing) return reach;
    return skipped + hit.t;
  }

  /// Points all over the inside of a region, so that its size holds in the middle too.
  void add_inside(const SurfaceMesh& boundary, const std::string& name, double h) {
    const double count = kTetsPerCube * std::abs(enclosed_volume(boundary)) / (h * h * h);
    require_affordable(fmt::format("size {:.4g} in \"{}\"", h, name), count);
    const TriangleTree tree(boundary);
    const Box3 box = tree.box();
    const double step = kInside * h;
    for (double z = box.lo.z + step / 2; z < box.hi.z; z += step)
      for (double y = box.lo.y + step / 2; y < box.hi.y; y += step)
        for (double x = box.lo.x + step / 2; x < box.hi.x; x += step)
          if (tree.contains({x, y, z})) result_.points.push_back({{x, y, z}, {}, h});
  }

  void ask_edge(const Edge& edge, double h) {
    const Vec3 a = surface_.points[edge[0]], b = surface_.points[edge[1]];
    const int parts = std::max(1, static_cast<int>(std::min(1e6, std::ceil(distance(a, b) / (kAlong * h)))));
    for (int i = 0; i <= parts; ++i) result_.points.push_back({a + (b - a) * (i / double(parts)), {}, h});
  }

  const SurfaceMesh& surface_;
  const TriangleTree& tree_;
  const SizeOptions& options_;
  SurfacePlaces places_;
  NamedSizes result_;
};

}  // namespace

void take_places_in_space(SizeOptions& options) {
  std::erase_if(options.named, [&](const NamedSize& named) {
    const Place place = place_of("size_of", named.name);
    if (place.is_in_space() && named.of_thickness > 0)
      throw OptionError("`size_of`: a box or ball has no thickness: give a region");
    if (const auto* box = std::get_if<Box3>(&place.where)) options.regions.push_back({box->lo, box->hi, 0, named.size});
    if (const auto* ball = std::get_if<GroupRule::Sphere>(&place.where))
      options.regions.push_back({ball->center, ball->center, ball->radius, named.size});
    return place.is_in_space();
  });
}

NamedSizes named_sizes(const KnownSurface& surface, const SizeOptions& options) {
  return options.named.empty() ? NamedSizes{} : Named(surface, options).run();
}

}  // namespace octafront
