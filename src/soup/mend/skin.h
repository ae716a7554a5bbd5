#pragma once

#include <octafront/ids.h>

#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"
#include "soup/mend/label.h"

#include <cstdint>
#include <vector>

namespace octafront::mend {

/// The surface between inside and outside: walls of an arrangement.
struct Skin {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;  ///< the outside in front
  std::vector<std::uint32_t> wall;  ///< per triangle: that of the arrangement which it is
  double wall_area = 0;             ///< of all walls
  double idle_area = 0;             ///< of walls with outside on both sides
};

/// By cells of the arrangement. Faces of which nothing is missing are in it as they were `given` to be arranged.
Skin skin_of_cells(const Arrangement& arranged, const std::vector<Triangle>& given, const Cells& cells,
                   const Labels& labels, const RunContext& context);

}  // namespace octafront::mend
