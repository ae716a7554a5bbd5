#pragma once

// Which parts of a surface a map leads onto each other.

#include <octafront/surface_mesh.h>

#include "periodic/periodic_cell.h"
#include "periodic/periods_asked.h"

#include <vector>

namespace octafront::periods {

/// Per triangle the face of the cell that it lies on; kNone: on none. `surface`: with patches and sides. Throws
/// InputError where a map leads nothing onto the surface, or a triangle would lie on two faces; OptionError for names
/// of patches that there are not.
std::vector<CellFace> mapped_faces(const SurfaceMesh& surface, const PeriodicCell& cell,
                                   const std::vector<AskedMap>& asked, double tolerance);

}  // namespace octafront::periods
