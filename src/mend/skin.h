#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include "arrangement/arrange.h"
#include "cells/find_cells.h"
#include "mend/label.h"

#include <cstdint>
#include <vector>

namespace octafront::mend {

/// The surface between inside and outside: walls of an arrangement, and what closes it where there are none.
struct Skin {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;  ///< the outside in front
  std::vector<std::uint32_t> wall;  ///< per triangle: that of the arrangement which it is; kNone: invented
  double wall_area = 0;             ///< of all walls
  double idle_area = 0;             ///< of walls with outside on both sides
};

/// By cells of the arrangement: nothing is invented.
Skin skin_of_cells(const Arrangement& arranged, const Cells& cells, const Labels& labels);

/// By tetrahedra: space is divided into such as have the walls for faces; those that the walls wind around are inside,
/// and where there is no wall between inside and outside the cut is as small as may be (minimal cut). For walls that
/// enclose a body but leave gaps of any shape. Throws MeshingError if there is no such division in doubles.
Skin skin_of_tets(const Arrangement& arranged, const RunContext& context);

}  // namespace octafront::mend
