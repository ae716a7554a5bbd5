#include "adapt/ground/given.h"

#include "base/geometry/nearest_that.h"
#include "base/mesh/surface_topology.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octafront::adapt {
namespace {

/// What is turned farther (cosine) is another side of the body, or another line.
constexpr double kLeastAgreement = 0.5;
/// The true geometry is no farther from its triangles than this part of their longest edge; else it is another sheet.
constexpr double kFarthestOfTruth = 0.5;

}  // namespace

GivenSurface::GivenSurface(SurfaceMesh surface, const TrueGeometry* geometry, double feature_angle, double reach)
    : surface_(std::move(surface)),
      geometry_(geometry),
      reach_(reach),
      tree_(surface_),
      line_tree_(SurfaceMesh{}),
      corner_tree_(SurfaceMesh{}) {
  const EdgeTable edges = make_edge_table(surface_.points.size(), surface_.triangles);
  lines_ = detect_features(surface_, edges, feature_angle);
  line_tree_ = tree_of_segments(surface_.points, lines_.edges);
  corner_tree_ = tree_of_points(surface_.points, lines_.corners);
  if (geometry_) {
    std::size_t e = 0;
    for (const Edge& line : lines_.edges) {
      while (edges.edges[e] < line) ++e;
      std::vector<std::uint32_t> patches;
      for (const std::uint32_t h : edges.uses(e)) patches.push_back(surface_.patch.empty() ? 0 : surface_.patch[h / 3]);
      std::sort(patches.begin(), patches.end());
      patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
      patches_at_.push_back(std::move(patches));
    }
  }
  find_outside();
}

void GivenSurface::find_outside() {
  outside_.assign(surface_.triangles.size(), 0);
  if (!surface_.sides.empty()) {
    for (std::size_t t = 0; t < outside_.size(); ++t) {
      const Sides sides = surface_.sides[t];
      if ((sides[0] == kNone) != (sides[1] == kNone)) outside_[t] = sides[0] == kNone ? 1 : -1;
    }
    return;
  }
  // Which side is outside is known of what is closed and turned one way.
  const EdgeTable edges = make_edge_table(surface_.points.size(), surface_.triangles);
  if (!is_turned_one_way(surface_.triangles, edges, true)) return;
  double volume = 0;
  const Vec3 from = surface_.points.empty() ? Vec3{} : surface_.points[0];
  for (const auto& [a, b, c] : surface_.triangles)
    volume += dot(cross(surface_.points[a] - from, surface_.points[b] - from), surface_.points[c] - from);
  std::fill(outside_.begin(), outside_.end(), static_cast<std::int8_t>(volume > 0 ? 1 : volume < 0 ? -1 : 0));
}

double GivenSurface::agreement(std::uint32_t triangle, Vec3 own, Vec3 normal, bool outer) const {
  const double product = dot(own, normal);
  return outer && outside_[triangle] != 0 ? outside_[triangle] * product : std::abs(product);
}

std::optional<GivenSurface::Place> GivenSurface::on_surface(Vec3 p, Vec3 normal, bool outer, double reach) const {
  const double least = kLeastAgreement * length(normal);
  const auto fits = [&](std::uint32_t t, const TriangleCorners& c) {
    const Vec3 own = double_area_normal(c[0], c[1], c[2]);
    return agreement(t, own, normal, outer) >= least * length(own);
  };
  const TriangleTree::Nearest nearest = nearest_that(tree_, p, reach, fits);
  if (nearest.triangle == kNone) return std::nullopt;
  const TriangleCorners& c = tree_.corners(nearest.triangle);
  Vec3 own = double_area_normal(c[0], c[1], c[2]);
  if (dot(own, normal) < 0) own = -own;
  // The geometry is asked about p itself, so that what lies on it stays.
  if (geometry_)
    if (const auto on = geometry_->on_face(surface_.patch.empty() ? 0 : surface_.patch[nearest.triangle], p);
        on && is_finite(*on) &&
        distance(*on, nearest.point) <= kFarthestOfTruth * std::sqrt(longest_squared_edge(c[0], c[1], c[2])))
      return Place{*on, own};
  return Place{nearest.point, own};
}

Vec3 GivenSurface::over(std::uint32_t triangle, Vec3 p) const {
  if (!geometry_) return p;
  const TriangleCorners& c = tree_.corners(triangle);
  const auto on = geometry_->on_face(surface_.patch.empty() ? 0 : surface_.patch[triangle], p);
  const bool near =
      on && is_finite(*on) && distance(*on, p) <= kFarthestOfTruth * std::sqrt(longest_squared_edge(c[0], c[1], c[2]));
  return near ? *on : p;
}

std::optional<Vec3> GivenSurface::on_line(Vec3 p, Vec3 direction, double reach) const {
  const auto fits = [&](std::uint32_t, const TriangleCorners& c) {
    const Vec3 own = c[1] - c[0];
    return std::abs(dot(own, direction)) >= kLeastAgreement * length(own) * length(direction);
  };
  const TriangleTree::Nearest nearest = nearest_that(line_tree_, p, reach, fits);
  if (nearest.triangle == kNone) return std::nullopt;
  if (!geometry_ || patches_at_[nearest.triangle].size() < 2) return nearest.point;
  const TriangleCorners& c = line_tree_.corners(nearest.triangle);
  const auto on = geometry_->on_edge(patches_at_[nearest.triangle], p);
  const bool near = on && is_finite(*on) && distance(*on, nearest.point) <= kFarthestOfTruth * distance(c[0], c[1]);
  return near ? *on : nearest.point;
}

std::optional<Vec3> GivenSurface::corner(Vec3 p, double reach) const {
  const TriangleTree::Nearest nearest = corner_tree_.nearest(p, reach * reach);
  if (nearest.triangle == kNone) return std::nullopt;
  return surface_.points[lines_.corners[nearest.triangle]];
}

}  // namespace octafront::adapt
