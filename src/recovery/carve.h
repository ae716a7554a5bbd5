#pragma once

#include "recovery/exact_point.h"
#include "recovery/subdivided_surface.h"
#include "recovery/tet_complex.h"

namespace octafront::recovery {

/// Drops all tets outside the surface, whose facets must all be labelled faces of the mesh. Labels become the numbers
/// of the input triangles. Throws MeshingError, with the place, if inside and outside meet without a facet between:
/// then the surface is open or not oriented outward.
void carve(const ExactPoints& points, const SubdividedSurface& surface, TetComplex& mesh);

}  // namespace octafront::recovery
