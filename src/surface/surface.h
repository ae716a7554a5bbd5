#pragma once

// surface: everything that happens to the input before there is a volume. Takes triangles as a file has them; repairs
// them without moving a vertex and says what keeps them from being meshed (repair.h, both in one: examine.h), finds the
// lines and points that must stay (features.h), and triangulates the surface anew to the size field (remesh.h). Leaves
// a clean surface: closed, outward, manifold, free of self-intersections, which surface_check.h verifies.

#include <octafront/repair.h>

#include "mesh/features.h"
#include "surface/examine.h"
#include "surface/remeshing/remesh.h"
#include "surface/surface_check.h"
