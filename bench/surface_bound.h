#pragma once

#include <octafront/surface_mesh.h>

/// What a kept surface allows at best, whatever mesh fills it.
struct SurfaceBound {
  double dihedral = 180;  ///< degrees: the smallest angle inside between two triangles; some element has no larger one
  double beta = 1;        ///< the best beta of an element on the worst of the triangles
};

/// Requires a clean surface. The search for the best element on a triangle is numerical: a lower estimate of the bound.
SurfaceBound bound_of(const octafront::SurfaceMesh& surface);
