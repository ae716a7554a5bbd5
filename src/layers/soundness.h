#pragma once

#include "layers/columns.h"
#include "layers/layered_walls.h"

#include <vector>

namespace octafront {
struct RunContext;
}

namespace octafront::layers {

/// Least scaled Jacobian, over its six corners, of a prism with an equilateral base and height of 1 for 1; of the
/// layer over a triangle of the wall from whose three corners it grows.
double least_scaled_jacobian(const SurfaceMesh& wall, const Columns& columns, const Triangle& triangle,
                             std::uint32_t layer);

/// Triangles over or beside which the columns make something unsound: tetrahedra that are not positive (exactly),
/// prisms too distorted, a top that faces elsewhere, a triangle of a patch without layers turned over by its moved
/// corners. Of the triangles `asked`; ascending.
std::vector<std::uint32_t> unsound_triangles(const Walls& walls, const Columns& columns,
                                             const std::vector<std::uint32_t>& asked);

/// Triangles whose layers would meet other layers or walls (exactly) if they were `ahead` times as high; ascending,
/// each once.
std::vector<std::uint32_t> crossing_triangles(const Walls& walls, const Columns& columns, double ahead,
                                              const RunContext& context);

}  // namespace octafront::layers
