#pragma once

#include "improve/edit_mesh.h"

#include <cstdint>

namespace octafront::improve {

/// Why elements stay below a score: what the boundary, which does not change, forces, and what it does not.
struct Shortfall {
  std::uint64_t elements = 0;            ///< with a score below the threshold
  std::uint64_t forced_by_angle = 0;     ///< at an edge where the boundary faces enclose too small an angle
  std::uint64_t forced_by_triangle = 0;  ///< on a boundary triangle that no better tetrahedron fits
  std::uint64_t in_thin_places = 0;  ///< with all four corners on the boundary: no room for another vertex was found
  std::uint64_t not_forced = 0;
  TetIndex worst_not_forced = kNone;  ///< slot in the mesh
};

Shortfall explain_shortfall(EditMesh& mesh, float threshold);

}  // namespace octafront::improve
