#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/stage.h"

#include <cstdint>

namespace octafront {

/// What avoid_bridges() found and did.
struct Bridges {
  std::uint64_t had = 0, left = 0;  ///< elements with all four corners on walls, before and after
  std::uint64_t vertices = 0;       ///< new ones, behind all others
};

/// Gives elements with all four corners on walls (boundary, interfaces) a vertex inside, for a problem with its values
/// given there would know nothing of them: the edge inside, the face inside or the element itself is divided that
/// leaves the best worst element, and the new vertices move to where that is better still. Faces, borders of regions
/// and of sets of elements, edges of curves and vertices that were there stay as they are; no element is inverted
/// (exact signs). Elements of wedges and pyramids stay. Requires a valid linear mesh. Serial; the same for any number
/// of threads. Throws Cancelled.
Bridges avoid_bridges(TetMesh& mesh, const Stage& stage);

}  // namespace octafront
