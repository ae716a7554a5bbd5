#include "adapt/schedule/rim_metric.h"

#include "base/core/elementary.h"
#include "base/core/flat_map.h"
#include "base/geometry/measures.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// The means of logarithms that are added at vertices; where none was it is 0.
class MeanLogs {
 public:
  explicit MeanLogs(std::size_t vertices) : sum_(vertices, Metric{0, 0, 0, 0, 0, 0}), count_(vertices, 0) {}
  void add(VertexIndex v, const Metric& log) { sum_[v] = sum_[v] + log, count_[v] += 1; }
  std::vector<Metric> means() && {
    for (VertexIndex v = 0; v < sum_.size(); ++v)
      if (count_[v] > 0) sum_[v] = (1 / count_[v]) * sum_[v];
    return std::move(sum_);
  }

 private:
  std::vector<Metric> sum_;
  std::vector<double> count_;
};

/// By the elements around.
std::vector<Metric> logs_of_tets(const TetMesh& mesh, std::span<const Triangle> faces, bool isotropic) {
  std::vector<std::uint8_t> asked(mesh.points.size(), 0);
  for (const Triangle& f : faces)
    for (const VertexIndex v : f) asked[v] = 1;
  MeanLogs logs(mesh.points.size());
  for (const Tet& t : mesh.tets) {
    if (std::none_of(t.begin(), t.end(), [&](VertexIndex v) { return asked[v] != 0; })) continue;
    const Metric implied = implied_metric(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
    // What is flat to rounding says nothing.
    const double density = density_of(implied);
    if (!(density > 0) || !std::isfinite(density)) continue;
    const Metric log = isotropic ? log_of(Metric::of_size(1 / elementary::cbrt(density))) : log_of(implied);
    for (const VertexIndex v : t) logs.add(v, log);
  }
  return std::move(logs).means();
}

/// By the lengths of the edges of the faces.
std::vector<Metric> logs_of_faces(const TetMesh& mesh, std::span<const Triangle> faces) {
  MeanLogs logs(mesh.points.size());
  for (const Triangle& f : faces)
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexIndex a = f[i], b = f[(i + 1) % 3];
      const Metric log = log_of(Metric::of_size(distance(mesh.points[a], mesh.points[b])));
      logs.add(a, log), logs.add(b, log);
    }
  return std::move(logs).means();
}

}  // namespace

RimMetric::RimMetric(const TetMesh& mesh, const std::vector<Triangle>& faces, const std::vector<Metric>& logs,
                     const MetricField& wanted)
    : wanted_(wanted), tree_(mesh.points, faces) {
  for (const Triangle& f : faces) faces_.push_back({logs[f[0]], logs[f[1]], logs[f[2]]});
}

RimMetric::RimMetric(const TetMesh& mesh, std::span<const std::uint8_t> frozen, const MetricField& wanted)
    : RimMetric(mesh, rim_faces(mesh, frozen), logs_of_tets(mesh, rim_faces(mesh, frozen), wanted.is_isotropic()),
                wanted) {}

RimMetric::RimMetric(const TetMesh& mesh, const std::vector<Triangle>& faces, const MetricField& wanted)
    : RimMetric(mesh, faces, wanted.is_isotropic() ? logs_of_faces(mesh, faces) : logs_of_tets(mesh, faces, false),
                wanted) {}

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
