#pragma once

#include <octafront/tet_mesh.h>

#include <span>
#include <vector>

namespace octafront::io {

/// Per face of `faces` the first tetrahedron that has it as a face (in either orientation), or kNone. O(tets + faces).
std::vector<TetIndex> tets_of_faces(std::span<const Tet> tets, std::span<const Triangle> faces, std::size_t points);

/// The faces that belong to one tetrahedron only, counter-clockwise seen from outside if the tetrahedra are positive,
/// in order of their smallest vertices. O(tets).
std::vector<Triangle> boundary_of(std::span<const Tet> tets, std::size_t points);

}  // namespace octafront::io
