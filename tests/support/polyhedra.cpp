#include "support/nasty_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace octafront::testing {

namespace {

// Triangles of a polygon in the plane, counter-clockwise, by ear clipping.
void clip_ears(std::vector<VertexIndex> polygon, const std::vector<std::pair<double, double>>& at,
               std::vector<Triangle>& triangles) {
  const auto turn = [&](VertexIndex a, VertexIndex b, VertexIndex c) {
    return (at[b].first - at[a].first) * (at[c].second - at[a].second) -
           (at[b].second - at[a].second) * (at[c].first - at[a].first);
  };
  while (polygon.size() > 2) {
    const std::size_t n = polygon.size();
    std::size_t ear = 0;
    for (; ear < n; ++ear) {
      const VertexIndex a = polygon[(ear + n - 1) % n], b = polygon[ear], c = polygon[(ear + 1) % n];
      if (turn(a, b, c) <= 0) continue;
      const bool empty = std::ranges::none_of(polygon, [&](VertexIndex v) {
        return v != a && v != b && v != c && turn(a, b, v) >= 0 && turn(b, c, v) >= 0 && turn(c, a, v) >= 0;
      });
      if (empty) break;
    }
    if (ear == n) return;
    triangles.push_back({polygon[(ear + n - 1) % n], polygon[ear], polygon[(ear + 1) % n]});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
}

}  // namespace

SurfaceMesh twisted_prism(int n, double twist_degrees, double height, int levels) {
  SurfaceMesh s;
  constexpr double kPi = std::numbers::pi;
  for (int level = 0; level <= levels; ++level) {
    for (int i = 0; i < n; ++i) {
      const double a = 2 * kPi * i / n + level * twist_degrees * kPi / 180;
      s.points.push_back({std::cos(a), std::sin(a), level * height});
    }
  }
  const auto at = [n](int i, int level) { return static_cast<VertexIndex>(level * n + i % n); };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < levels; ++k) {
      // The longer diagonal makes the side concave.
      s.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      s.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
    if (i < 2) continue;
    s.triangles.push_back({at(0, 0), at(i, 0), at(i - 1, 0)});
    s.triangles.push_back({at(0, levels), at(i - 1, levels), at(i, levels)});
  }
  return s;
}

SurfaceMesh chazelle_polyhedron(int n, double gap) {
  SurfaceMesh s;
  const double end = n + 1, width = 0.01, far = 2 * end * end;
  // One height field with ridges along y; the other is the same turned by a quarter and mirrored.
  struct Row {
    double x, z0, z1;
  };
  const auto rows = [&](double sign) {
    std::vector<Row> list{{0, sign * far, sign * far}};
    for (int i = 1; i <= n; ++i) {
      list.push_back({i - width, sign * far, sign * far});
      list.push_back({double(i), sign * gap, i * end + sign * gap});
      list.push_back({i + width, sign * far, sign * far});
    }
    list.push_back({end, sign * far, sign * far});
    return list;
  };
  const std::vector<Row> top = rows(1), bottom = rows(-1);
  const auto m = static_cast<VertexIndex>(top.size());
  for (const Row& r : top) s.points.push_back({r.x, 0, r.z0});
  for (const Row& r : top) s.points.push_back({r.x, end, r.z1});
  for (const Row& r : bottom) s.points.push_back({0, r.x, r.z0});
  for (const Row& r : bottom) s.points.push_back({end, r.x, r.z1});
  for (VertexIndex i = 0; i + 1 < m; ++i) {
    s.triangles.push_back({i, i + 1, m + i + 1});
    s.triangles.push_back({i, m + i + 1, m + i});
    s.triangles.push_back({2 * m + i, 2 * m + i + 1, 3 * m + i + 1});
    s.triangles.push_back({2 * m + i, 3 * m + i + 1, 3 * m + i});
  }
  // The four walls: one jagged rim and two corners of the other height field.
  const auto wall = [&](VertexIndex first, VertexIndex a, VertexIndex b, int axis, bool turned) {
    std::vector<VertexIndex> polygon{a, b};
    for (VertexIndex i = m; i-- > 0;) polygon.push_back(first + i);
    std::vector<std::pair<double, double>> at;
    for (const Vec3& p : s.points) at.emplace_back(p[axis], first >= 2 * m ? -p.z : p.z);
    std::vector<Triangle> triangles;
    clip_ears(polygon, at, triangles);
    for (const Triangle& t : triangles) s.triangles.push_back(turned ? Triangle{t[0], t[2], t[1]} : t);
  };
  wall(0, 2 * m, 3 * m, 0, false);
  wall(m, 3 * m - 1, 4 * m - 1, 0, true);
  wall(2 * m, 0, m, 1, false);
  wall(3 * m, m - 1, 2 * m - 1, 1, true);
  return s;
}

}  // namespace octafront::testing
