#include "adapt/schedule/rim_metric.h"

#include "base/core/elementary.h"
#include "base/core/flat_map.h"
#include "base/geometry/measures.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <cmath>

namespace octafront::adapt {
namespace {

/// Lengths change by this part of the way, both counted in lengths of the rim.
constexpr double kGradationAtRim = 0.5;

std::vector<Triangle> rim_faces(const TetMesh& mesh, std::span<const std::uint8_t> frozen) {
  std::vector<Triangle> faces;
  for (const Tet& t : mesh.tets) {
    if (std::all_of(t.begin(), t.end(), [&](VertexIndex v) { return frozen[v] != 0; })) continue;
    for (int i = 0; i < 4; ++i) {
      const Triangle f = face_of(t, i);
      if (frozen[f[0]] && frozen[f[1]] && frozen[f[2]]) faces.push_back(f);
    }
  }
  return faces;
}

}  // namespace

RimMetric::RimMetric(const TetMesh& mesh, std::span<const std::uint8_t> frozen, const MetricField& wanted)
    : wanted_(wanted), tree_(mesh.points, rim_faces(mesh, frozen)) {
  const std::vector<Triangle> faces = rim_faces(mesh, frozen);
  const std::vector<Metric> logs = logs_at(mesh, faces);
  for (const Triangle& f : faces) faces_.push_back({logs[f[0]], logs[f[1]], logs[f[2]]});
}

std::vector<Metric> RimMetric::logs_at(const TetMesh& mesh, std::span<const Triangle> faces) const {
  std::vector<std::uint8_t> asked(mesh.points.size(), 0);
  for (const Triangle& f : faces)
    for (const VertexIndex v : f) asked[v] = 1;
  std::vector<Metric> sum(mesh.points.size(), Metric{0, 0, 0, 0, 0, 0});
  std::vector<double> count(mesh.points.size(), 0);
  for (const Tet& t : mesh.tets) {
    if (std::none_of(t.begin(), t.end(), [&](VertexIndex v) { return asked[v] != 0; })) continue;
    const Metric implied = implied_metric(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
    // What is flat to rounding says nothing.
    const double density = density_of(implied);
    if (!(density > 0) || !std::isfinite(density)) continue;
    const Metric log = is_isotropic() ? log_of(Metric::of_size(1 / elementary::cbrt(density))) : log_of(implied);
    for (const VertexIndex v : t) sum[v] = sum[v] + log, count[v] += 1;
  }
  for (VertexIndex v = 0; v < sum.size(); ++v)
    if (count[v] > 0) sum[v] = (1 / count[v]) * sum[v];
  return sum;
}

Metric RimMetric::at(Vec3 p, std::uint32_t& hint) const {
  const Metric to = wanted_.at(p, hint);
  const TriangleTree::Nearest nearest = tree_.nearest(p);
  if (nearest.triangle == kNone) return to;
  const auto& [a, b, c] = tree_.corners(nearest.triangle);
  const Vec3 q = nearest.point;
  const double u = triangle_area(q, b, c), v = triangle_area(a, q, c), w = triangle_area(a, b, q), all = u + v + w;
  const auto& log = faces_[nearest.triangle];
  const Metric rim = exp_of((u / all) * log[0] + (v / all) * log[1] + (w / all) * log[2]);
  const double change = kGradationAtRim * std::sqrt(rim.squared(p - q));
  return within(rim, to, std::max(0.0, 1 - change), 1 + change);
}

std::vector<std::uint8_t> on_walls(const TetMesh& mesh) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (const auto* faces : {&mesh.boundary, &mesh.interfaces})
    for (const Triangle& t : *faces)
      for (const VertexIndex v : t) marked[v] = 1;
  return marked;
}

}  // namespace octafront::adapt
