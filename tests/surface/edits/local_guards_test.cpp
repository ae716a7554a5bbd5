#include "surface/edits/local_guards.h"

#include "base/geometry/measures.h"
#include "surface/edits/walk.h"

#include <gtest/gtest.h>

namespace octafront::surface {
namespace {

/// A bar whose top is two fans of n triangles on both sides of a diagonal: what is between two divided lines.
SurfaceMesh bar_with_fans(VertexIndex n, double width) {
  SurfaceMesh s;
  for (const double y : {0.0, width})
    for (VertexIndex i = 0; i <= n; ++i) s.points.push_back({static_cast<double>(i) / n, y, 0});
  const auto front = [](VertexIndex i) { return i; };
  const auto back = [n](VertexIndex i) { return n + 1 + i; };
  const auto below = static_cast<VertexIndex>(s.points.size());
  for (const double y : {0.0, width})
    for (const double x : {0.0, 1.0}) s.points.push_back({x, y, -width});
  for (VertexIndex i = 0; i < n; ++i) {
    s.triangles.push_back({front(i), front(i + 1), back(0)});
    s.triangles.push_back({back(i), front(n), back(i + 1)});
    s.triangles.push_back({front(i + 1), front(i), below});
    s.triangles.push_back({back(i), back(i + 1), below + 3});
  }
  const VertexIndex a = below, b = below + 1, c = below + 3, d = below + 2;  // around, from above
  s.triangles.insert(s.triangles.end(), {{a, b, front(n)}, {c, d, back(0)}, {b, c, back(n)}, {b, back(n), front(n)}});
  s.triangles.insert(s.triangles.end(), {{d, a, front(0)}, {d, front(0), back(0)}, {a, d, c}, {a, c, b}});
  return s;
}

// That takes n * n / 2 flips: where they ran out, needles as long as the bar were left.
TEST(LocalGuards, FansOnBothSidesOfALongEdgeBecomeAStrip) {
  constexpr VertexIndex kN = 300;
  const KnownSurface bar(bar_with_fans(kN, 3e-3), 40);
  InputSurface input = make_input_surface(bar.mesh(), bar.edges());
  set_features(input, bar.features().edges);
  WorkingMesh mesh(input);
  std::vector<HalfEdge> edges;
  for (HalfEdge h = 0; h < mesh.start.size(); ++h)
    if (h < mesh.twin[h]) edges.push_back(h);
  EXPECT_GT(make_delaunay(mesh, edges, {0.7, 0.2}), kN * kN / 3);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto [a, b, c] = mesh.triangle(t);
    const Vec3 p = mesh.points[a], q = mesh.points[b], r = mesh.points[c];
    if (p.z != 0 || q.z != 0 || r.z != 0) continue;
    EXPECT_LT(squared_distance(p, q), 1e-3);
  }
}

}  // namespace
}  // namespace octafront::surface
