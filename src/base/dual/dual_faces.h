#pragma once

#include <octafront/poly_mesh.h>

#include "base/dual/dual_points.h"

#include <cstdint>
#include <vector>

namespace octafront::dual {

/// A face of the dual between two cells, or of one cell and the outside (kNone).
struct DualFace {
  std::uint32_t owner, neighbour, patch;
  std::uint32_t points;  ///< how many
};

/// Faces, and their points one after the other, by DualPoints.
struct DualFaces {
  std::vector<DualFace> faces;
  std::vector<std::uint32_t> points;
};

/// The faces that vertices [begin, end) make: one around each edge to a higher vertex, and those on the faces at them
/// at which cells end.
DualFaces faces_of_vertices(const Primal& primal, const DualCells& cells, const DualPoints& points, VertexIndex begin,
                            VertexIndex end);

}  // namespace octafront::dual
