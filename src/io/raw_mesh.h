#pragma once

#include <octafront/tet_mesh.h>

#include "io/input.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace octafront::io {

/// A mesh as a file has it: before orientation, boundary and numbering are put in order.
struct RawMesh {
  std::vector<Vec3> points;
  std::vector<Tet> tets;                              ///< indices are known to be in range
  std::vector<std::int64_t> tet_ref;                  ///< one per tet
  std::vector<Triangle> triangles;                    ///< indices are known to be in range
  std::vector<std::int64_t> triangle_ref;             ///< one per triangle
  std::vector<std::uint32_t> triangle_source;         ///< one per triangle, or empty
  std::map<std::int64_t, std::string> surface_names;  ///< by reference
  std::uint64_t other_elements = 0;                   ///< of kinds that a TetMesh does not hold
};

/// Turns inverted tetrahedra, drops unused vertices and triangles that bound nothing, adds boundary faces that are
/// missing (in a patch of their own), turns triangles outward, and numbers regions and patches: reference r becomes
/// r - 1 where all references are small and positive, else they are counted through in increasing order.
/// Throws InputError if there are no tetrahedra.
TetMesh ordered_mesh(RawMesh raw, const Input& input);

}  // namespace octafront::io
