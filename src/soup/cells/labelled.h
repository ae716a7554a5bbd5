#pragma once

#include <octafront/complex.h>

#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"

#include <functional>
#include <string>
#include <vector>

namespace octafront::cells {

/// Arranged triangles, their cells, and the region of each cell (kNone: empty; so is cell 0).
struct Labelled {
  const Arrangement& arranged;
  const Cells& cells;
  std::vector<std::uint32_t> region;
  std::vector<std::string> names;  ///< of regions; empty where nobody gave one
  /// Per triangle: it stays where one region is on both sides, too, whatever its cells. Empty: none does.
  std::vector<char> embedded = {};
  std::vector<std::int64_t> labels = {};  ///< SurfaceMesh::region_labels
  /// Of closed bodies no triangle with one cell on both sides is a sheet: what is left of walls that came together.
  bool has_sheets = true;
};

/// A place that means one cell. Throws InputError if it lies on a wall; `what` names it for messages.
std::uint32_t cell_of_seed(const Cells& cells, Vec3 at, const std::string& what);

/// Gives the cells of seeds their names and empties those of voids. Throws LeakError, InputError where two of different
/// names share a cell or lie outside.
void apply_seeds(Labelled& labelled, const ComplexOptions& options);

/// Patch and source of a triangle whose sides are known.
struct Face {
  std::uint32_t patch, source;
};

/// The complex: triangles between different regions, with outside in front, and those with one cell of a region on
/// both sides, as sheets. Regions without cells are left out. `face_of` is asked once for each triangle that stays.
Complex complex_of(const Labelled& labelled, const std::function<Face(std::size_t, Sides)>& face_of);

}  // namespace octafront::cells
