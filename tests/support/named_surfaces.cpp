#include "support/named_surfaces.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace octafront::testing {

SurfaceMesh cube(int n) {
  SurfaceMesh s;
  std::map<std::array<int, 3>, VertexIndex> index;
  const auto vertex = [&](std::array<int, 3> g) {
    const auto [it, is_new] = index.try_emplace(g, static_cast<VertexIndex>(s.points.size()));
    if (is_new) s.points.push_back({double(g[0]) / n, double(g[1]) / n, double(g[2]) / n});
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (int high = 0; high < 2; ++high) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          std::array<VertexIndex, 4> q{};
          constexpr int kCorner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> g{};
            g[axis] = high * n;
            g[u] = i + kCorner[k][0];
            g[v] = j + kCorner[k][1];
            q[k] = vertex(g);
          }
          if (!high) std::swap(q[1], q[3]);
          s.triangles.push_back({q[0], q[1], q[2]});
          s.triangles.push_back({q[0], q[2], q[3]});
          s.patch.insert(s.patch.end(), 2, static_cast<std::uint32_t>(2 * axis + high));
        }
      }
    }
  }
  return s;
}

SurfaceMesh box(double a, double b, double c, int n) {
  SurfaceMesh s = cube(n);
  for (Vec3& p : s.points) p = {a * p.x, b * p.y, c * p.z};
  return s;
}

SurfaceMesh unit_tetrahedron() {
  SurfaceMesh s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  s.triangles = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  return s;
}

SurfaceMesh icosphere(int levels, double r) {
  SurfaceMesh s;
  const double g = std::numbers::phi;
  s.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  s.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<Edge, VertexIndex> middle;
    const auto mid = [&](VertexIndex a, VertexIndex b) {
      const auto [it, is_new] =
          middle.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<VertexIndex>(s.points.size()));
      if (is_new) s.points.push_back((normalized(s.points[a]) + normalized(s.points[b])) * 0.5);
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const VertexIndex ab = mid(a, b), bc = mid(b, c), ca = mid(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    s.triangles = std::move(finer);
  }
  for (Vec3& p : s.points) p = normalized(p) * r;
  return s;
}

SurfaceMesh torus(int n, int m, double major, double minor) {
  SurfaceMesh s;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
      const double rho = major + minor * std::cos(v);
      s.points.push_back({rho * std::cos(u), rho * std::sin(u), minor * std::sin(v)});
    }
  }
  const auto at = [&](int i, int j) { return static_cast<VertexIndex>((i % n) * m + j % m); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return s;
}

SurfaceMesh hollow_sphere(int levels, double outer, double inner) {
  return joined(icosphere(levels, outer), reversed(icosphere(levels, inner)));
}

SurfaceMesh joined(SurfaceMesh a, const SurfaceMesh& b) {
  const auto shift = static_cast<VertexIndex>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + shift, j + shift, k + shift});
  if (!a.patch.empty() || !b.patch.empty()) {
    a.patch.resize(a.triangles.size() - b.triangles.size());
    for (std::size_t t = 0; t < b.triangles.size(); ++t) a.patch.push_back(b.patch_of(t));
  }
  return a;
}

SurfaceMesh pipe(int around, int along) {
  SurfaceMesh s;
  const auto at = [&](int i, int k) { return static_cast<VertexIndex>(k * around + (i % around + around) % around); };
  for (int k = 0; k <= along; ++k)
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * std::numbers::pi * i / around;
      s.points.push_back({std::cos(turn), std::sin(turn), 4.0 * k / along});
    }
  const auto add = [&](Triangle t, std::uint32_t patch) { s.triangles.push_back(t), s.patch.push_back(patch); };
  for (int k = 0; k < along; ++k)
    for (int i = 0; i < around; ++i) {
      add({at(i, k), at(i + 1, k), at(i + 1, k + 1)}, 0);
      add({at(i, k), at(i + 1, k + 1), at(i, k + 1)}, 0);
    }
  const auto low = static_cast<VertexIndex>(s.points.size()), high = low + 1;
  s.points.push_back({0, 0, 0});
  s.points.push_back({0, 0, 4});
  for (int i = 0; i < around; ++i)
    add({low, at(i + 1, 0), at(i, 0)}, 1), add({high, at(i, along), at(i + 1, along)}, 2);
  s.patch_names = {"wall", "inlet", "outlet"};
  return s;
}

SurfaceMesh reversed(SurfaceMesh surface) {
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

SurfaceMesh transformed(SurfaceMesh surface, double scale, Vec3 shift) {
  for (Vec3& p : surface.points) p = p * scale + shift;
  return surface;
}

SurfaceMesh permuted(const SurfaceMesh& surface, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<VertexIndex> new_to_old(surface.points.size());
  for (VertexIndex v = 0; v < new_to_old.size(); ++v) new_to_old[v] = v;
  std::shuffle(new_to_old.begin(), new_to_old.end(), random);
  std::vector<VertexIndex> old_to_new(new_to_old.size());
  SurfaceMesh out;
  for (VertexIndex v = 0; v < new_to_old.size(); ++v) {
    old_to_new[new_to_old[v]] = v;
    out.points.push_back(surface.points[new_to_old[v]]);
  }
  for (const auto& [a, b, c] : surface.triangles)
    out.triangles.push_back({old_to_new[b], old_to_new[c], old_to_new[a]});
  std::shuffle(out.triangles.begin(), out.triangles.end(), random);
  return out;
}

}  // namespace octafront::testing
