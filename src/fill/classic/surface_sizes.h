#pragma once

#include <octafront/size_field.h>

namespace octafront {

struct SurfaceMesh;

/// Sizes without a background grid: at a vertex of the surface the mean length of its edges, on a triangle
/// interpolated, and at any other point what they are at the nearest point of the surface. They follow the surface
/// alone, with no bound on how fast they change across the middle of a body.
SizeField sizes_from_surface(const SurfaceMesh& surface);

}  // namespace octafront
