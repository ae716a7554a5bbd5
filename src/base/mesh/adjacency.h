#pragma once

#include <octafront/tet_mesh.h>

#include "base/mesh/face_table.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// Face i of tet t, as h = 4 * t + i; see tet_mesh.h. Meshes of 2^30 tets and more have no
/// half-faces in 32 bits: what makes them throws MeshingError (base/core/index_range.h).
using HalfFace = std::uint32_t;

/// Corners of a half-face, counter-clockwise seen from outside its tet.
inline Triangle corners_of(std::span<const Tet> tets, HalfFace h) {
  return face_of(tets[h / 4], static_cast<int>(h % 4));
}

/// All half-faces of a mesh. Requires vertex indices in range. Some 40 ns a tet.
FaceTable half_face_table(std::span<const Tet> tets, std::size_t vertex_count);

/// For each half-face the one on the other side, kNone on the boundary: across[across[h]] = h. Faces of more than two
/// tets have no neighbours either. Requires vertex indices in range.
std::vector<HalfFace> half_face_neighbors(std::span<const Tet> tets, std::size_t vertex_count);

/// The half-faces without a neighbour as triangles that face outward, in order of half-face.
std::vector<Triangle> boundary_triangles(std::span<const Tet> tets, std::span<const HalfFace> across);

}  // namespace octafront
