#pragma once

#include <octafront/vec.h>

#include <TopoDS_Shape.hxx>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace octafront::cad {

/// A piece of space that some of several solids fill: which, by their places, ascending.
struct Cell {
  TopoDS_Shape solid;
  double volume = 0;
  std::vector<std::size_t> owners;
};

/// Several solids as pieces that share faces.
struct Cells {
  std::vector<Cell> cells;
  std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> faces;  ///< before, after
};

/// By the library's general fuse. Nothing where it fails: each solid's volume is that of its pieces, within a
/// thousandth. `only_touch`: by its quicker way for solids that have no space in common.
std::optional<Cells> cells_of(const std::vector<TopoDS_Shape>& solids, bool only_touch);

/// Where faces of two cells are tangent along a line, and the library found no line but crumbs of it.
struct Crumbs {
  std::size_t a, b;  ///< cells
  int pieces = 0;
  double shortest = 0;
  Vec3 at;
};
std::vector<Crumbs> crumbs_of(const Cells& cells);

/// Several cells as one solid, without the walls between them.
TopoDS_Shape united(const std::vector<const Cell*>& cells);

}  // namespace octafront::cad
