#pragma once

#include "recovery/exact_point.h"
#include "recovery/labelled_complex.h"
#include "recovery/subdivided_surface.h"

namespace octafront::recovery {

/// Drops all tets outside the surface, whose facets must all be labelled faces of the mesh. Across the new
/// boundary lies the number of the input triangle. Throws MeshingError, with the place, if inside and outside meet
/// without a facet between: then the surface is open or not oriented outward.
void carve(const ExactPoints& points, const SubdividedSurface& surface, LabelledComplex& mesh);

}  // namespace octafront::recovery
