#pragma once

// Valid tetrahedral meshes, made without the mesher.

#include <octafront/tet_mesh.h>

#include "base/mesh/adjacency.h"

#include <array>

namespace octafront::testing {

/// [0, n]^3 as n^3 cubes of six tets each, all around the diagonals of the cubes; patches are left out.
inline TetMesh tet_cube(int n) {
  TetMesh mesh;
  const auto at = [n](std::array<int, 3> g) {
    return static_cast<VertexIndex>((g[0] * (n + 1) + g[1]) * (n + 1) + g[2]);
  };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) mesh.points.push_back({double(i), double(j), double(k)});
  constexpr int kPaths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (int path = 0; path < 6; ++path) {
          std::array<int, 3> g{i, j, k};
          Tet t{at(g)};
          for (int step = 0; step < 3; ++step) {
            ++g[kPaths[path][step]];
            t[step + 1] = at(g);
          }
          if (path >= 3) std::swap(t[0], t[1]);
          mesh.tets.push_back(t);
        }
  mesh.boundary = boundary_triangles(mesh.tets, half_face_neighbors(mesh.tets, mesh.points.size()));
  return mesh;
}

}  // namespace octafront::testing
