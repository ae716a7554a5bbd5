#pragma once

#include <octafront/run_context.h>

#include "base/mesh/tet_complex.h"
#include "fill/recovery/exact_points.h"

#include <vector>

namespace octafront::recovery {

/// The frame: the corners of a large tetrahedron around the surface.
inline constexpr VertexIndex kFrameVertices = 4;

/// The Delaunay tetrahedralisation of the given vertices and of those of the frame, which are added to `points` behind
/// all others; the first of them is returned. Four or more cospherical points are joined in one of the possible ways
/// (deterministic). `same_as[v]` becomes the vertex inserted in the place of v where another one has the same
/// coordinates, else v. `used[v]` tells which vertices take part.
VertexIndex delaunay(ExactPoints& points, const std::vector<bool>& used, TetComplex& mesh,
                     std::vector<VertexIndex>& same_as, const RunContext& context);

}  // namespace octafront::recovery
