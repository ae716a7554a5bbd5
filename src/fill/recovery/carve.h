#pragma once

#include <octafront/surface_mesh.h>

#include "fill/recovery/exact_points.h"
#include "fill/recovery/labelled_complex.h"
#include "fill/recovery/subdivided_surface.h"

namespace octafront::recovery {

/// The triangles of `surface` as seen from each region at them: in their order as they are, then, in their order, the
/// backs of all that have a region in front. `triangles` are those of the surface, perhaps on other vertices.
std::vector<Triangle> with_backs(std::vector<Triangle> triangles, const SurfaceMesh& surface);

/// Drops all tets outside the surface, whose facets must all be labelled faces of the mesh, and parts its regions.
/// Across the new boundary lies the number of the triangle in with_backs(). Throws MeshingError, with the place, if
/// inside and outside, or two regions, meet without a facet between: then the surface is open or its sides do not
/// agree. `input` says what lies on the sides of the triangles.
void carve(const ExactPoints& points, const SubdividedSurface& surface, const SurfaceMesh& input,
           LabelledComplex& mesh);

}  // namespace octafront::recovery
