#include <octafront/surface_mesh.h>

#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "sizing/sources/model_extent.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <memory>
#include <optional>

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

/// Sizes given at points, at any place of a surface: linear on its triangles if each of its vertices has a point,
/// otherwise that of the nearest point.
class PointSizes {
 public:
  /// Requires points. Vertices and points are one if they are nearer than a millionth of the diagonal.
  PointSizes(const SurfaceMesh& surface, std::vector<PointSize> points);
  double at(const PlaceOnSurface& place) const;

 private:
  std::uint32_t nearest(Vec3 p, double limit_squared) const { return tree_->nearest(p, limit_squared).triangle; }

  const SurfaceMesh& surface_;
  std::vector<PointSize> points_;
  std::optional<TriangleTree> tree_;  ///< over the points, as triangles without extent
  std::vector<double> of_vertex_;     ///< empty: the nearest point speaks
};

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

}  // namespace

SizeAtPlace given_sizes(const SurfaceMesh& surface, const SizeOptions& options) {
  SizeAtPlace points, callback;
  if (!options.point_sizes.empty()) {
    const auto sizes = std::make_shared<PointSizes>(surface, options.point_sizes);
    points.at = [sizes](const PlaceOnSurface& s) { return sizes->at(s); };
  }
  if (options.callback) {
    callback.batched = std::make_shared<BatchedSizes>(options.callback);
    callback.at = [sizes = callback.batched](const PlaceOnSurface& s) { return sizes->at(s.p); };
    callback.spacing = base_size(surface);
  }
  return least_of(points, callback);
}

std::vector<SizeSample> samples_of_points(const SizeOptions& options, double floor) {
  std::vector<SizeSample> samples;
  for (const PointSize& s : options.point_sizes) {
    const double h = std::max(floor, s.size);
    samples.push_back({s.p, {}, h, 0});
  }
  return samples;
}

}  // namespace octafront
