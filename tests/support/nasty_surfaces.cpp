#include "support/nasty_surfaces.h"

#include "support/named_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace octafront::testing {

namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 0x1234567u) {}
  std::uint64_t bits() {
    std::uint64_t x = state_ += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
  }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  double magnitude(double lo, double hi) { return lo * std::pow(hi / lo, unit()); }
  int integer(int lo, int hi) { return lo + static_cast<int>(bits() % static_cast<std::uint64_t>(hi - lo + 1)); }

 private:
  std::uint64_t state_;
};

// A sphere of rings and segments: needles at the poles.
SurfaceMesh globe(int rings, int segments) {
  SurfaceMesh s;
  constexpr double kPi = std::numbers::pi;
  s.points.push_back({0, 0, 1});
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const double a = kPi * i / rings, b = 2 * kPi * j / segments;
      s.points.push_back({std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
    }
  }
  s.points.push_back({0, 0, -1});
  const auto last = static_cast<VertexIndex>(s.points.size() - 1);
  const auto at = [&](int ring, int j) { return static_cast<VertexIndex>(1 + (ring - 1) * segments + j % segments); };
  for (int j = 0; j < segments; ++j) {
    s.triangles.push_back({0, at(1, j), at(1, j + 1)});
    s.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
    for (int i = 1; i + 1 < rings; ++i) {
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return s;
}

// Each vertex goes to a random distance from the origin: star-shaped, so never self-intersecting.
SurfaceMesh spiky(SurfaceMesh s, double spread, Random& random) {
  for (Vec3& p : s.points) p *= random.magnitude(1 / spread, spread);
  return s;
}

// A slab over an n x n grid between two height fields.
SurfaceMesh slab(int n, double z, double thickness, double noise, Random& random) {
  SurfaceMesh s;
  const auto at = [n](int i, int j, int top) { return static_cast<VertexIndex>(2 * (i * (n + 1) + j) + top); };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double base = z + noise * random.unit();
      s.points.push_back({double(i) / n, double(j) / n, base});
      s.points.push_back({double(i) / n, double(j) / n, base + thickness * random.between(0.5, 1)});
    }
  }
  const auto quad = [&](VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) {
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < n; ++i) {
    quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
    quad(at(i + 1, n, 0), at(i, n, 0), at(i, n, 1), at(i + 1, n, 1));
    quad(at(0, i + 1, 0), at(0, i, 0), at(0, i, 1), at(0, i + 1, 1));
    quad(at(n, i, 0), at(n, i + 1, 0), at(n, i + 1, 1), at(n, i, 1));
    for (int j = 0; j < n; ++j) {
      quad(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
      quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
    }
  }
  return s;
}

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

SurfaceMesh shells(int count, double gap, double spread, Random& random) {
  const SurfaceMesh shape = spiky(icosphere(random.integer(0, 1)), spread, random);
  SurfaceMesh all = shape;
  double scale = 1;
  for (int k = 1; k < count; ++k) {
    scale *= 1 - gap;
    const SurfaceMesh inner = transformed(shape, scale, {});
    all = joined(all, k % 2 ? reversed(inner) : inner);
  }
  return all;
}

}  // namespace

SurfaceMesh twisted_prism(int n, double twist_degrees, double height) {
  SurfaceMesh s;
  constexpr double kPi = std::numbers::pi;
  for (const int level : {0, 1}) {
    for (int i = 0; i < n; ++i) {
      const double a = 2 * kPi * i / n + level * twist_degrees * kPi / 180;
      s.points.push_back({std::cos(a), std::sin(a), level * height});
    }
  }
  const auto at = [n](int i, int level) { return static_cast<VertexIndex>(level * n + i % n); };
  for (int i = 0; i < n; ++i) {
    // The longer diagonal makes the side concave.
    s.triangles.push_back({at(i, 0), at(i + 1, 0), at(i + 1, 1)});
    s.triangles.push_back({at(i, 0), at(i + 1, 1), at(i, 1)});
    if (i < 2) continue;
    s.triangles.push_back({at(0, 0), at(i, 0), at(i - 1, 0)});
    s.triangles.push_back({at(0, 1), at(i - 1, 1), at(i, 1)});
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

SurfaceMesh random_voxels(int n, double density, double jitter, std::uint64_t seed) {
  Random random(seed);
  std::vector<bool> full(static_cast<std::size_t>(n * n * n));
  for (std::size_t i = 0; i < full.size(); ++i) full[i] = random.unit() < density;
  full[0] = true;
  const auto filled = [&](std::array<int, 3> c) {
    for (const int x : c) {
      if (x < 0 || x >= n) return false;
    }
    return static_cast<bool>(full[static_cast<std::size_t>(c[0] + n * (c[1] + n * c[2]))]);
  };
  SurfaceMesh s;
  std::map<std::array<int, 3>, VertexIndex> index;
  const auto vertex = [&](std::array<int, 3> g) {
    const auto [it, is_new] = index.try_emplace(g, static_cast<VertexIndex>(s.points.size()));
    if (is_new) {
      const auto coordinate = [&](int k) { return g[k] + jitter * random.between(-1, 1); };
      const double x = coordinate(0), y = coordinate(1), z = coordinate(2);
      s.points.push_back({x, y, z});
    }
    return it->second;
  };
  for (int cell = 0; cell < n * n * n; ++cell) {
    const std::array<int, 3> c{cell % n, cell / n % n, cell / (n * n)};
    if (!filled(c)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> next = c;
        next[axis] += side ? 1 : -1;
        if (filled(next)) continue;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<VertexIndex, 4> q{};
        constexpr int kCorner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (int k = 0; k < 4; ++k) {
          std::array<int, 3> g = c;
          g[axis] += side;
          g[u] += kCorner[k][0];
          g[v] += kCorner[k][1];
          q[k] = vertex(g);
        }
        if (!side) std::swap(q[1], q[3]);
        if (random.unit() < 0.5) std::rotate(q.begin(), q.begin() + 1, q.end());
        s.triangles.push_back({q[0], q[1], q[2]});
        s.triangles.push_back({q[0], q[2], q[3]});
      }
    }
  }
  return s;
}

NastySurface nasty_surface(std::uint64_t seed) {
  Random random(seed);
  NastySurface n;
  switch (seed % 10) {
    case 0:
      n = {"spiky sphere", spiky(icosphere(random.integer(0, 2)), random.magnitude(1.1, 100), random)};
      break;
    case 1:
      n = {"needles at the poles",
           spiky(globe(random.integer(2, 6), random.integer(3, 120)), random.magnitude(1.0001, 5), random)};
      break;
    case 2:
      n = {"near-coplanar slab",
           slab(random.integer(1, 10), 0, random.magnitude(1e-6, 1), random.magnitude(1e-12, 1e-3), random)};
      break;
    case 3: {
      const double gap = random.magnitude(1e-6, 0.1);
      n = {"stacked slabs", slab(random.integer(1, 6), 0, gap, gap / 10, random)};
      for (int k = 1; k < 4; ++k)
        n.surface = joined(n.surface, slab(random.integer(1, 6), 2 * k * gap, gap, gap / 10, random));
      break;
    }
    case 4:
      n = {"nested shells",
           shells(random.integer(2, 5), random.magnitude(1e-6, 0.3), random.magnitude(1.01, 4), random)};
      break;
    case 5: {
      const int sides = random.integer(3, 24);
      n = {"twisted prism", twisted_prism(sides, random.between(0, 170.0 / sides), random.magnitude(0.01, 100))};
      break;
    }
    case 6:
      n = {"voxels", random_voxels(random.integer(2, 5), random.between(0.2, 0.8), 0, random.bits())};
      break;
    case 7:
      n = {"jittered voxels",
           random_voxels(random.integer(2, 5), random.between(0.2, 0.8), random.magnitude(1e-12, 0.1), random.bits())};
      break;
    case 8:
      n = {"Chazelle", chazelle_polyhedron(random.integer(1, 5), random.magnitude(1e-5, 0.1))};
      break;
    default:
      n = {"flat globe", spiky(globe(random.integer(2, 10), random.integer(3, 40)), random.magnitude(1, 1.5), random)};
      for (Vec3& p : n.surface.points) p.z *= 1e-3;
      break;
  }
  n.name += " of seed " + std::to_string(seed);
  // Powers of two keep the shape exactly.
  n.surface = transformed(n.surface, std::ldexp(1.0, random.integer(-20, 20)), {});
  return n;
}

}  // namespace octafront::testing
