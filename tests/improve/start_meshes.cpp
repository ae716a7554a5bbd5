#include "improve/start_meshes.h"

#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace octafront::testing {
namespace {

bool positive(const TetMesh& mesh, const Tet& t) {
  return orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) > 0;
}

std::uint32_t side_of(const TetMesh& mesh, const Triangle& t) {
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end)
      if (std::all_of(t.begin(), t.end(), [&](VertexIndex v) { return mesh.points[v][axis] == end; }))
        return static_cast<std::uint32_t>(2 * axis + end);
  return 6;
}

}  // namespace

TetMesh with_boundary(TetMesh mesh) {
  std::map<std::array<VertexIndex, 3>, Triangle> open;
  for (const Tet& t : mesh.tets)
    for (const auto& f : kTetFaces) {
      const Triangle face{t[f[0]], t[f[1]], t[f[2]]};
      std::array<VertexIndex, 3> key = face;
      std::sort(key.begin(), key.end());
      if (!open.emplace(key, face).second) open.erase(key);
    }
  for (const auto& [key, face] : open) mesh.boundary.push_back(face);
  return mesh;
}

TetMesh kuhn_cube(int n) {
  TetMesh mesh;
  const auto id = [n](int i, int j, int k) { return static_cast<VertexIndex>((k * (n + 1) + j) * (n + 1) + i); };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.points.push_back({double(i) / n, double(j) / n, double(k) / n});
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          std::array<int, 3> at{i, j, k};
          Tet t;
          t[0] = id(i, j, k);
          for (int s = 0; s < 3; ++s) {
            ++at[order[s]];
            t[s + 1] = id(at[0], at[1], at[2]);
          }
          if (!positive(mesh, t)) std::swap(t[2], t[3]);
          mesh.tets.push_back(t);
        }
  } while (std::next_permutation(order.begin(), order.end()));
  mesh = with_boundary(std::move(mesh));
  for (const Triangle& t : mesh.boundary) mesh.patch.push_back(side_of(mesh, t));
  for (std::uint32_t b = 0; b < mesh.boundary.size(); ++b) mesh.source.push_back(b);
  return mesh;
}

TetMesh perturbed(TetMesh mesh, double amount, std::uint32_t seed) {
  std::vector<std::vector<TetIndex>> star(mesh.points.size());
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (const VertexIndex v : mesh.tets[t]) star[v].push_back(t);
  std::vector<char> fixed(mesh.points.size(), 0);
  for (const Triangle& t : mesh.boundary)
    for (const VertexIndex v : t) fixed[v] = 1;
  const double spacing = 1 / std::cbrt(double(mesh.tets.size()) / 6);
  std::mt19937 random(seed);
  const auto next = [&] { return (double(random()) / 4294967296.0 * 2 - 1) * amount * spacing; };
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (fixed[v]) continue;
    const Vec3 p = mesh.points[v];
    Vec3 by{next(), next(), next()};
    for (int halving = 0; halving < 20; ++halving, by *= 0.5) {
      mesh.points[v] = p + by;
      if (std::all_of(star[v].begin(), star[v].end(), [&](TetIndex t) { return positive(mesh, mesh.tets[t]); })) break;
      mesh.points[v] = p;
    }
  }
  return mesh;
}

TetMesh edge_ring_mesh(int ring, double offset) {
  TetMesh mesh;
  mesh.points = {{offset, 0, -1}, {offset, 0, 1}};
  for (int k = 0; k < ring; ++k) {
    const double angle = 2 * std::numbers::pi * k / ring;
    mesh.points.push_back({std::cos(angle), std::sin(angle), 0});
  }
  for (int k = 0; k < ring; ++k)
    mesh.tets.push_back({0, 1, static_cast<VertexIndex>(2 + k), static_cast<VertexIndex>(2 + (k + 1) % ring)});
  return with_boundary(std::move(mesh));
}

TetMesh transformed(TetMesh mesh, double scale, Vec3 shift) {
  for (Vec3& p : mesh.points) p = scale * p + shift;
  return mesh;
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets)
    sum += signed_volume(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
  return sum;
}

}  // namespace octafront::testing
