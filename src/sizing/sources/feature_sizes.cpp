#include <octafront/surface_mesh.h>

#include "base/core/groups.h"
#include "sizing/sources/sources.h"

#include <algorithm>

namespace octafront {

namespace {

class CurveWalker {
 public:
  CurveWalker(const SurfaceMesh& surface, const Features& features)
      : surface_(surface),
        edges_(features.edges),
        at_(rows_at_vertices(surface.points.size(), features.edges)),
        used_(features.edges.size(), 0),
        is_end_(surface.points.size(), 0) {
    for (const VertexIndex v : features.corners) is_end_[v] = 1;
    for (VertexIndex v = 0; v < surface.points.size(); ++v) {
      const std::size_t n = at_[v].size();
      if (n != 0 && n != 2) is_end_[v] = 1;
    }
  }

  std::vector<FeatureCurve> run() {
    std::vector<FeatureCurve> curves;
    for (VertexIndex v = 0; v < surface_.points.size(); ++v) {
      if (!is_end_[v]) continue;
      for (const std::uint32_t e : at_[v]) {
        if (!used_[e]) curves.push_back(walk(v, e));
      }
    }
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      if (!used_[e]) curves.push_back(walk(edges_[e][0], e));
    }
    return curves;
  }

 private:
  FeatureCurve walk(VertexIndex start, std::uint32_t edge) {
    FeatureCurve curve;
    curve.vertices.push_back(start);
    for (VertexIndex v = start;;) {
      used_[edge] = 1;
      const VertexIndex next = edges_[edge][0] == v ? edges_[edge][1] : edges_[edge][0];
      curve.length += distance(surface_.points[v], surface_.points[next]);
      curve.vertices.push_back(next);
      if (next == start || is_end_[next]) return curve;
      edge = at_[next][0] == edge ? at_[next][1] : at_[next][0];
      v = next;
    }
  }

  const SurfaceMesh& surface_;
  const std::vector<Edge>& edges_;
  Groups<> at_;  ///< the feature edges at each vertex
  std::vector<std::uint8_t> used_, is_end_;
};

}  // namespace

std::vector<FeatureCurve> feature_curves(const SurfaceMesh& surface, const Features& features) {
  return CurveWalker(surface, features).run();
}

std::vector<SizeSample> feature_samples(const SurfaceMesh& surface, const std::vector<FeatureCurve>& curves,
                                        double elements, double floor, double ceiling) {
  std::vector<SizeSample> samples;
  for (const FeatureCurve& curve : curves) {
    const bool closed = curve.vertices.front() == curve.vertices.back();
    const double h = std::max(floor, curve.length / (closed ? std::max(3.0, 2 * elements) : elements));
    if (h >= ceiling) continue;
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) {
      const Vec3 a = surface.points[curve.vertices[i]], b = surface.points[curve.vertices[i + 1]];
      const int parts = static_cast<int>(std::ceil(distance(a, b) / h)) + 1;
      for (int k = 0; k < parts; ++k) samples.push_back({a + (b - a) * (double(k) / parts), {}, h, 0.5 * h});
    }
    samples.push_back({surface.points[curve.vertices.back()], {}, h, 0.5 * h});
  }
  return samples;
}

}  // namespace octafront
