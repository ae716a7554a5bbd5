#pragma once

#include <octafront/surface_mesh.h>

namespace octafront::mend {

/// Takes out triangles that are lower than `reach`, which cuts that nearly meet leave: their short edges shrink to a
/// point, or their long edges are turned to pass through the vertex beside them. What cannot be taken out without
/// folding the surface stays. Nothing moves by more than a few times `reach`; whether it crosses itself then is for the
/// caller to see. Requires a clean surface. Returns the number of triangles that were there in excess or turned.
std::uint64_t drop_dust(SurfaceMesh& surface, double reach);

}  // namespace octafront::mend
