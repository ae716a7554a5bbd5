#include "improve/shape/feature_curves.h"

#include <octafront/surface_mesh.h>

namespace octafront::improve {

FeatureCurves::FeatureCurves(const SurfaceMesh& surface, const Features& features)
    : surface_(surface),
      edges_(features.edges),
      at_vertex_(surface.points.size(), {kNone, kNone}),
      tree_(tree_of_segments(surface.points, features.edges)) {
  std::vector<std::uint8_t> valence(surface.points.size(), 0);
  for (std::uint32_t e = 0; e < edges_.size(); ++e)
    for (const VertexIndex v : edges_[e]) {
      if (valence[v] < 2) at_vertex_[v][valence[v]] = e;
      if (valence[v] < 3) ++valence[v];
    }
  for (VertexIndex v = 0; v < valence.size(); ++v)
    if (valence[v] != 2) at_vertex_[v] = {kNone, kNone};
  for (const VertexIndex v : features.corners) at_vertex_[v] = {kNone, kNone};
}

std::optional<FeatureCurves::Place> FeatureCurves::nearest(Vec3 p, double limit) const {
  const auto found = tree_.nearest(p, limit * limit);
  if (found.triangle == kNone) return std::nullopt;
  return Place{found.point, found.triangle};
}

Vec3 FeatureCurves::tangent(const Place& place) const {
  const auto& [a, b] = edges_[place.edge];
  return normalized(point(b) - point(a));
}

std::uint32_t FeatureCurves::next_edge(VertexIndex v, std::uint32_t edge) const {
  const auto& [first, second] = at_vertex_[v];
  return first == edge ? second : second == edge ? first : kNone;
}

std::optional<FeatureCurves::Place> FeatureCurves::walk(const Place& place, double by) const {
  Place at = place;
  double left = std::abs(by);
  VertexIndex ahead = edges_[at.edge][by >= 0 ? 1 : 0];
  for (std::size_t steps = 0; steps <= edges_.size(); ++steps) {
    const double here = distance(at.at, point(ahead));
    if (left <= here) {
      if (here > 0) at.at += (point(ahead) - at.at) * (left / here);
      return at;
    }
    left -= here;
    at.at = point(ahead);
    at.edge = next_edge(ahead, at.edge);
    if (at.edge == kNone) return std::nullopt;
    const auto& [a, b] = edges_[at.edge];
    ahead = a == ahead ? b : a;
  }
  return std::nullopt;
}

}  // namespace octafront::improve
