#include "surface/remeshing/deviation.h"

#include "core/parallel.h"

namespace octafront::remeshing {

namespace {

/// Appends the points among `points` that are farther from the surface than `limit`, in their order.
void look(const std::vector<Vec3>& points, const TriangleTree& to, double limit, std::vector<Vec3>& places) {
  std::vector<std::uint8_t> is_far(points.size());
  parallel_for(points.size(),
               [&](std::size_t i) { is_far[i] = to.nearest(points[i], limit * limit).triangle == kNone; });
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_far[i]) places.push_back(points[i]);
  }
}

/// Vertices, middles of edges and perhaps centroids.
std::vector<Vec3> samples_of(const SurfaceMesh& surface, bool at_centroids) {
  std::vector<Vec3> samples = surface.points;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 pa = surface.points[a], pb = surface.points[b], pc = surface.points[c];
    if (at_centroids) samples.push_back((pa + pb + pc) / 3);
    if (a < b) samples.push_back((pa + pb) * 0.5);
    if (b < c) samples.push_back((pb + pc) * 0.5);
    if (c < a) samples.push_back((pc + pa) * 0.5);
  }
  return samples;
}

}  // namespace

std::vector<Vec3> places_beyond(double limit, const SurfaceMesh& made, const SurfaceMesh& input,
                                const TriangleTree& input_tree) {
  std::vector<Vec3> places;
  look(samples_of(made, true), input_tree, limit, places);
  look(samples_of(input, false), TriangleTree(made), limit, places);
  return places;
}

}  // namespace octafront::remeshing
