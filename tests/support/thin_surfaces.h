#pragma once

// Thin round bodies, closed and outward, along the z axis from 0 on; without patches.

#include <octafront/surface_mesh.h>

namespace octafront::testing {

/// A prism of so many sides, each two triangles.
SurfaceMesh rod(VertexIndex sides, double radius, double length);
/// A pyramid: each side is one triangle.
SurfaceMesh needle(VertexIndex sides, double radius, double length);

}  // namespace octafront::testing
