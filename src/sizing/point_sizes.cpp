#include "sizing/point_sizes.h"

#include "base/geometry/measures.h"

#include <algorithm>

namespace octafront {

namespace {

/// Vertices and points nearer than this part of the diagonal are one: files have six digits or more.
constexpr double kSame = 1e-6;

TriangleTree tree_over(const std::vector<PointSize>& points) {
  std::vector<Vec3> places;
  std::vector<Triangle> triangles;
  for (const PointSize& s : points) {
    const auto i = static_cast<VertexIndex>(places.size());
    places.push_back(s.p);
    triangles.push_back({i, i, i});
  }
  return {places, triangles};
}

}  // namespace

PointSizes::PointSizes(const SurfaceMesh& surface, std::vector<PointSize> points)
    : surface_(surface), points_(std::move(points)) {
  tree_.emplace(tree_over(points_));
  const double same = kSame * bounding_box(surface.points).diagonal();
  std::vector<double> sizes;
  for (const Vec3 p : surface.points) {
    const std::uint32_t i = nearest(p, same * same);
    if (i == kNone) return;
    sizes.push_back(points_[i].size);
  }
  of_vertex_ = std::move(sizes);
}

double PointSizes::at(const PlaceOnSurface& place) const {
  if (of_vertex_.empty()) return points_[nearest(place.p, HUGE_VAL)].size;
  const auto [i, j, k] = surface_.triangles[place.face];
  const Vec3 a = surface_.points[i], b = surface_.points[j], c = surface_.points[k];
  const double u = triangle_area(place.p, b, c), v = triangle_area(a, place.p, c), w = triangle_area(a, b, place.p);
  const double sum = u + v + w;
  if (!(sum > 0)) return std::min({of_vertex_[i], of_vertex_[j], of_vertex_[k]});
  return (u * of_vertex_[i] + v * of_vertex_[j] + w * of_vertex_[k]) / sum;
}

}  // namespace octafront
