#include "support/labelled_walls.h"

#include <octafront/tet_mesh.h>

#include "support/random.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace octafront::testing {

namespace {

/// Collects triangles between cells; vertices that none uses are dropped at the end.
class Walls {
 public:
  explicit Walls(std::vector<Vec3> points) { surface_.points = std::move(points); }

  void add(const Triangle& t, std::uint32_t front, std::uint32_t behind) {
    surface_.triangles.push_back(t);
    surface_.sides.push_back({front, behind});
  }

  SurfaceMesh finished() {
    std::vector<VertexIndex> number(surface_.points.size(), kNone);
    std::vector<Vec3> used;
    for (Triangle& t : surface_.triangles)
      for (VertexIndex& v : t) {
        if (number[v] == kNone) {
          number[v] = static_cast<VertexIndex>(used.size());
          used.push_back(surface_.points[v]);
        }
        v = number[v];
      }
    surface_.points = std::move(used);
    return std::move(surface_);
  }

 private:
  SurfaceMesh surface_;
};

}  // namespace

std::vector<double> even_planes(int n) {
  std::vector<double> planes;
  for (int i = 0; i < n; ++i) planes.push_back(i / double(n - 1));
  return planes;
}

SurfaceMesh box_walls(const GridPlanes& g, const Label& label, const std::function<bool(Vec3)>& is_sheet) {
  const std::array<std::vector<double>, 3> planes{g.x, g.y, g.z};
  const std::array<int, 3> n{int(g.x.size()), int(g.y.size()), int(g.z.size())};
  std::vector<Vec3> points;
  for (const double z : g.z)
    for (const double y : g.y)
      for (const double x : g.x) points.push_back({x, y, z});
  const auto vertex = [&](std::array<int, 3> i) {
    return static_cast<VertexIndex>(i[0] + n[0] * (i[1] + n[1] * i[2]));
  };
  const auto center = [&](std::array<int, 3> i) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = (planes[a][i[a]] + planes[a][i[a] + 1]) / 2;
    return p;
  };
  const auto region = [&](std::array<int, 3> i) {
    for (int a = 0; a < 3; ++a)
      if (i[a] < 0 || i[a] + 1 >= n[a]) return kNone;
    return label(center(i));
  };
  Walls walls(points);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<int, 3> i{};
    for (i[axis] = 0; i[axis] < n[axis]; ++i[axis])
      for (i[u] = 0; i[u] + 1 < n[u]; ++i[u])
        for (i[v] = 0; i[v] + 1 < n[v]; ++i[v]) {
          std::array<int, 3> below = i, b = i, c = i, d = i;
          --below[axis];
          ++b[u], ++c[u], ++c[v], ++d[v];
          const std::uint32_t front = region(i), behind = region(below);
          const Vec3 middle = (points[vertex(i)] + points[vertex(c)]) * 0.5;
          if (front == behind && (front == kNone || !is_sheet || !is_sheet(middle))) continue;
          walls.add({vertex(i), vertex(b), vertex(c)}, front, behind);
          walls.add({vertex(i), vertex(c), vertex(d)}, front, behind);
        }
  }
  return walls.finished();
}

SurfaceMesh rough_walls(int n, const Label& label, unsigned seed, double jitter) {
  Random random(seed);
  const auto vertex = [&](int x, int y, int z) { return static_cast<VertexIndex>(x + (n + 1) * (y + (n + 1) * z)); };
  std::vector<Vec3> points;
  for (int z = 0; z <= n; ++z)
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) {
        Vec3 p{x / double(n), y / double(n), z / double(n)};
        const std::array<int, 3> at{x, y, z};
        for (int a = 0; a < 3; ++a)
          if (at[a] > 0 && at[a] < n) p[a] += random.between(-jitter / n, jitter / n);
        points.push_back(p);
      }
  std::map<Triangle, std::pair<Triangle, std::uint32_t>> open;  // faces seen from one tetrahedron so far
  Walls walls(points);
  const auto add_tet = [&](const Tet& t) {
    const std::uint32_t region = label((points[t[0]] + points[t[1]] + points[t[2]] + points[t[3]]) / 4);
    for (const auto& f : kTetFaces) {
      const Triangle face{t[f[0]], t[f[1]], t[f[2]]};
      Triangle key = face;
      std::sort(key.begin(), key.end());
      const auto [at, is_new] = open.try_emplace(key, std::pair{face, region});
      if (is_new) continue;
      if (at->second.second != region) walls.add(face, at->second.second, region);
      open.erase(at);
    }
  };
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        std::array<int, 3> axes{0, 1, 2};
        do {
          std::array<int, 3> at{x, y, z};
          Tet t{vertex(x, y, z), 0, 0, 0};
          for (int k = 0; k < 3; ++k) {
            ++at[axes[k]];
            t[k + 1] = vertex(at[0], at[1], at[2]);
          }
          const bool even = (axes[1] - axes[0] + 3) % 3 == 1;
          if (!even) std::swap(t[2], t[3]);
          add_tet(t);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  for (const auto& [key, side] : open)
    if (side.second != kNone) walls.add(side.first, kNone, side.second);
  return walls.finished();
}

Label nearest_of(int cells, unsigned seed) {
  Random random(seed);
  std::vector<Vec3> seeds;
  for (int i = 0; i < cells; ++i) {
    const double x = random.unit(), y = random.unit(), z = random.unit();
    seeds.push_back({x, y, z});
  }
  return [seeds](Vec3 p) {
    const auto nearest = std::min_element(
        seeds.begin(), seeds.end(), [&](Vec3 a, Vec3 b) { return squared_length(a - p) < squared_length(b - p); });
    return static_cast<std::uint32_t>(nearest - seeds.begin());
  };
}

SurfaceMesh mapped(SurfaceMesh surface, const std::function<Vec3(Vec3)>& map) {
  for (Vec3& p : surface.points) p = map(p);
  return surface;
}

SurfaceMesh shuffled(const SurfaceMesh& complex, unsigned seed) {
  Random random(seed);
  std::vector<std::size_t> order(complex.triangles.size());
  for (std::size_t t = 0; t < order.size(); ++t) order[t] = t;
  for (std::size_t t = order.size(); t-- > 1;)
    std::swap(order[t], order[static_cast<std::size_t>(random.integer(0, static_cast<int>(t)))]);
  SurfaceMesh other = complex;
  for (std::size_t k = 0; k < order.size(); ++k) {
    other.triangles[k] = complex.triangles[order[k]];
    other.sides[k] = complex.sides[order[k]];
    if (!complex.patch.empty()) other.patch[k] = complex.patch[order[k]];
    if (random.bits() % 2 == 0) continue;
    std::swap(other.triangles[k][1], other.triangles[k][2]);
    std::swap(other.sides[k][0], other.sides[k][1]);
  }
  return other;
}

double volume_of_region(const SurfaceMesh& complex, std::uint32_t region) {
  SurfaceMesh one = complex;
  for (Sides& sides : one.sides)
    for (std::uint32_t& r : sides) r = r == region ? 0 : kNone;
  return enclosed_volume(one);
}

}  // namespace octafront::testing
