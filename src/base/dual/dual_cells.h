#pragma once

#include "base/dual/primal.h"

#include <cstdint>
#include <vector>

namespace octafront::dual {

/// Edges that bend by more are features, as they are for the surface unless an option says otherwise: 40 degrees.
inline constexpr double kFeatureCosine = 0.766044443118978;
/// Where a body bends inward by more, cells are divided: 60 degrees. At less a cell is nearly convex, and the faces
/// between its halves would be worse than it.
inline constexpr double kRidgeCosine = 0.5;

/// Which edges at a vertex divide its cells where the body bends inward.
enum class Ridges : std::uint8_t {
  kSharp,     ///< as above
  kFeatures,  ///< all that are features
  kNone
};

/// The cells of the dual: which one each corner of a tetrahedron belongs to.
struct DualCells {
  std::vector<std::uint32_t> of_corner;
  std::vector<VertexIndex> vertex;    ///< per cell
  std::vector<std::uint32_t> region;  ///< per cell
  std::vector<char> is_plain;         ///< per vertex: one cell all around it, which ends nowhere at it
};

/// The corners at a vertex make a cell, one on each side of the walls that part them; one for each side of a wall where
/// the body bends inward. Of layers a cell is what lies over a vertex, up to the next one above it: the corners there
/// belong to it, too. One choice per vertex.
DualCells make_cells(const Primal& primal, const std::vector<Ridges>& ridges);

}  // namespace octafront::dual
