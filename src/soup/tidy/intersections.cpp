#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"
#include "soup/tidy/defect_steps.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace octafront::tidy {
namespace {

constexpr std::size_t kShown = 10;

/// All faces of an edge are near each other. Where they are more than this they are left out, since comparing every two
/// would take minutes; such an edge is a defect already.
constexpr std::size_t kMostFacesOfEdge = 1000;

TriangleCorners corners_of(const SurfaceMesh& mesh, std::uint32_t t) {
  const auto [a, b, c] = mesh.triangles[t];
  return {mesh.points[a], mesh.points[b], mesh.points[c]};
}

bool has_vertex(const Triangle& t, VertexIndex v) {
  return std::find(t.begin(), t.end(), v) != t.end();
}

/// Where an edge of s, one that the triangles do not share, passes through t.
std::optional<Vec3> crossing_point(const SurfaceMesh& mesh, std::uint32_t s, std::uint32_t t) {
  const TriangleCorners plane = corners_of(mesh, t);
  const Vec3 normal = cross(plane[1] - plane[0], plane[2] - plane[0]);
  for (int i = 0; i < 3; ++i) {
    const VertexIndex a = mesh.triangles[s][i], b = mesh.triangles[s][(i + 1) % 3];
    if (has_vertex(mesh.triangles[t], a) || has_vertex(mesh.triangles[t], b)) continue;
    const Vec3 p = mesh.points[a], q = mesh.points[b];
    if (segment_triangle_hit(p, q, plane).kind != SegmentHit::Kind::kPoint) continue;
    const double before = dot(p - plane[0], normal), after = dot(q - plane[0], normal);
    return before == after ? p : p + (q - p) * std::clamp(before / (before - after), 0., 1.);
  }
  return std::nullopt;
}

/// A point to look at, near where the two triangles meet.
Vec3 meeting_point(const SurfaceMesh& mesh, std::uint32_t s, std::uint32_t t) {
  if (const auto p = crossing_point(mesh, s, t)) return *p;
  if (const auto p = crossing_point(mesh, t, s)) return *p;
  Box3 a, b;
  for (const Vec3 p : corners_of(mesh, s)) a.add(p);
  for (const Vec3 p : corners_of(mesh, t)) b.add(p);
  return (max(a.lo, b.lo) + min(a.hi, b.hi)) * 0.5;
}

}  // namespace

void find_self_intersections(const RepairedSurface& repaired, const EdgeTable& table, const RunContext& context,
                             SurfaceDefects& defects) {
  const SurfaceMesh& mesh = repaired.surface;
  std::vector<char> left_out(mesh.triangles.size(), 0);
  for (std::size_t e = 0; e < table.size(); ++e)
    if (table.uses(e).size() > kMostFacesOfEdge)
      for (const std::uint32_t h : table.uses(e)) left_out[h / 3] = 1;
  std::vector<std::uint32_t> proper;
  std::vector<Triangle> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    if (left_out[t] || collinear(a, b, c)) continue;  // faces without area are a defect of their own
    proper.push_back(t);
    triangles.push_back(mesh.triangles[t]);
  }
  auto pairs = self_intersections(mesh.points, triangles, kMostPairs, context);
  for (auto& [s, t] : pairs) {
    s = proper[s];
    t = proper[t];
    if (repaired.surface.source_of(s) > repaired.surface.source_of(t)) std::swap(s, t);
  }
  const auto faces_of = [&](const std::array<std::uint32_t, 2>& pair) {
    return std::pair{repaired.surface.source_of(pair[0]), repaired.surface.source_of(pair[1])};
  };
  const std::size_t shown = std::min(kShown, pairs.size());
  std::partial_sort(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(shown), pairs.end(),
                    [&](const auto& p, const auto& q) {
                      return std::pair{faces_of(p), p} < std::pair{faces_of(q), q};
                    });
  FirstPlaces places(defects.self_intersections);
  for (std::size_t k = 0; k < shown; ++k) {
    const auto [s, t] = pairs[k];
    places.add({repaired.surface.source_of(s), repaired.surface.source_of(t)}, meeting_point(mesh, s, t));
  }
  defects.self_intersections.count = pairs.size();
}

}  // namespace octafront::tidy
