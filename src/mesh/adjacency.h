#pragma once

#include <octafront/tet_mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// Face i of tet t, as h = 4 * t + i; see tet_mesh.h. Meshes of 2^30 tets and more have no
/// half-faces in 32 bits: what makes them throws MeshingError (mesh/index_range.h).
using HalfFace = std::uint32_t;

/// Corners of a half-face, counter-clockwise seen from outside its tet.
inline Triangle corners_of(std::span<const Tet> tets, HalfFace h) {
  const Tet& t = tets[h / 4];
  const auto& f = kTetFaces[h % 4];
  return {t[f[0]], t[f[1]], t[f[2]]};
}

/// A triangle's vertices in ascending order, and whether the order given is an even permutation of that.
struct FaceKey {
  VertexIndex low, middle, high;
  bool even;

  explicit FaceKey(const Triangle& t);
  friend bool operator==(const FaceKey&, const FaceKey&) = default;
};

/// All half-faces of a mesh, those on the same three vertices side by side.
struct FaceTable {
  struct Entry {
    VertexIndex middle, high;  ///< of the key; the lowest vertex is the bucket
    HalfFace half_face;
  };
  std::vector<std::uint64_t> first_of_vertex;  ///< points + 1: entries whose lowest vertex is v start here
  std::vector<Entry> entries;                  ///< in each bucket sorted by middle, high, half_face

  /// Requires vertex indices in range. O(tets), some 40 ns a tet.
  FaceTable(std::span<const Tet> tets, std::size_t vertex_count);

  /// Calls visit(lowest vertex, entries on one face) for each face in the order of its key.
  template <class Visit>
  void for_each_face(Visit&& visit) const {
    for (std::size_t v = 0; v + 1 < first_of_vertex.size(); ++v) {
      const std::size_t end = first_of_vertex[v + 1];
      for (std::size_t i = first_of_vertex[v], j = i; i < end; i = j) {
        while (j < end && entries[j].middle == entries[i].middle && entries[j].high == entries[i].high) ++j;
        visit(static_cast<VertexIndex>(v), std::span(entries).subspan(i, j - i));
      }
    }
  }
};

/// For each half-face the one on the other side, kNone on the boundary: across[across[h]] = h. Faces of more than two
/// tets have no neighbours either. Requires vertex indices in range.
std::vector<HalfFace> half_face_neighbors(std::span<const Tet> tets, std::size_t vertex_count);

/// The half-faces without a neighbour as triangles that face outward, in order of half-face.
std::vector<Triangle> boundary_triangles(std::span<const Tet> tets, std::span<const HalfFace> across);

}  // namespace octafront
