#pragma once

#include <octafront/tet_mesh.h>

#include <array>
#include <utility>

namespace octafront::improve {

/// The corners of face i of a tet, ascending: the same for both tets at a face.
inline std::array<VertexIndex, 3> sorted_face(const Tet& t, int i) {
  VertexIndex a = t[kTetFaces[i][0]], b = t[kTetFaces[i][1]], c = t[kTetFaces[i][2]];
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c};
}

/// The same for a triangle by itself.
inline std::array<VertexIndex, 3> sorted_face(const Triangle& t) {
  return sorted_face(Tet{kNone, t[0], t[1], t[2]}, 0);
}

}  // namespace octafront::improve
