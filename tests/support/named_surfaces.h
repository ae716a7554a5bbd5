#pragma once

// The little closed surfaces that tests name. All are clean: closed, outward, manifold, not self-intersecting.

#include <octafront/surface_mesh.h>

namespace octafront::testing {

/// [0, 1]^3, each side divided into n x n squares of two triangles; patch = side 0..5.
SurfaceMesh cube(int n = 1);

/// [0, a] x [0, b] x [0, c], divided and with patches as the cube.
SurfaceMesh box(double a, double b, double c, int n = 1);

/// The regular tetrahedron-like corner (0,0,0) (1,0,0) (0,1,0) (0,0,1).
SurfaceMesh unit_tetrahedron();

/// Icosahedron divided `levels` times, projected to the sphere of radius r about the origin: 20 * 4^levels triangles.
SurfaceMesh icosphere(int levels, double r = 1);

/// Torus about the z axis, n segments around and m segments of the tube.
SurfaceMesh torus(int n, int m, double major = 1, double minor = 0.35);

/// A pipe of radius 1 and length 4 along z: the patches wall, inlet and outlet.
SurfaceMesh pipe(int around, int along);

/// A sphere with a concentric spherical cavity.
SurfaceMesh hollow_sphere(int levels, double outer = 1, double inner = 0.5);

/// `b` appended to `a`, indices shifted; nothing is merged.
SurfaceMesh joined(SurfaceMesh a, const SurfaceMesh& b);

/// The same surface facing the other way.
SurfaceMesh reversed(SurfaceMesh surface);

/// Each vertex p becomes scale * p + shift.
SurfaceMesh transformed(SurfaceMesh surface, double scale, Vec3 shift);

/// The same surface with its vertices and triangles in another order, by chance, each triangle from another corner on.
SurfaceMesh permuted(const SurfaceMesh& surface, unsigned seed);

}  // namespace octafront::testing
