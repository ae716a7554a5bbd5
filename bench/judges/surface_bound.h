#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <cstddef>

/// What a kept surface allows at best, whatever mesh fills it.
struct SurfaceBound {
  double dihedral = 180;  ///< degrees: the smallest angle inside between two triangles; some element has no larger one
  double beta = 1;        ///< the best beta of an element on the worst of the triangles
};

/// The elements of a mesh below a beta, by what the kept surface has to do with it.
struct PoorElements {
  std::size_t all = 0;
  std::size_t forced = 0;  ///< on a triangle on which no element inside the surface reaches that beta
  std::size_t beside = 0;  ///< with an edge of such a triangle, or at an edge where the surface turns too sharply
  double worst_other = 1;  ///< the least beta of the others, which nothing forces
};

/// Requires a clean surface. The search for the best element on a triangle is numerical: a lower estimate of the bound.
SurfaceBound bound_of(const octafront::SurfaceMesh& surface);

/// Requires a mesh whose boundary triangles are those of the surface, one for one. An element on a triangle must see
/// it: its apex lies where segments from the triangle cross no other one. The element on a needle has a second needle
/// among its inner faces, so that the element behind it, which shares an edge with the triangle, is poor too.
PoorElements poor_elements(const octafront::TetMesh& mesh, double beta);
