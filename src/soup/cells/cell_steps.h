#pragma once

#include <octafront/complex.h>
#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/vec.h>

#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"
#include "soup/cells/misfit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace octafront::cells {

/// Which cells the walls of one file mean to be filled.
struct FilledCells {
  /// Per cell: how often it is inside; 0: empty, as cell 0 is. Below 0 in bodies that are inside out.
  std::vector<int> times;
  /// Enclosed cells that stay empty: the walls do not wind around them; or, where walls do not agree on their outer
  /// side, an even number of walls lies around them.
  std::uint64_t cavities_by_winding = 0, cavities_by_nesting = 0;
  std::uint64_t filled_shells = 0;  ///< pieces of the surface inside others that fill what they enclose
};

/// Piece by piece of the surface, from outside inwards. Where the triangles of a piece agree on their outer side around
/// every edge, also around those of four triangles and more, cells are inside as often as it winds around them; else,
/// where each edge has an even number of triangles, by nesting; else all cells of the piece are inside. `nested`:
/// kCavity goes by nesting wherever that is possible, kRegion leaves no cell empty.
FilledCells filled_cells(const Arrangement& arranged, const Cells& cells, ComplexOptions::Nested nested,
                         const RunContext& context);

/// A triangle of a body, and which one of the soup it is part of.
struct BodyFace {
  Triangle corners;
  std::uint32_t body, source;
};

/// Where a body lies on earlier ones, all its corners there theirs, its wall becomes theirs, triangle by triangle; what
/// it was between the corners does not count. Only where the body stays closed: else nothing changes.
void share_walls(const std::vector<Vec3>& points, const std::vector<BodyFace>& earlier, std::vector<BodyFace>& later,
                 const Misfits& misfits, const RunContext& context);

/// The same triangles, brought together.
struct ClosedGaps {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> source;  ///< per triangle: which one of the soup it is part of; ascending
  std::uint64_t moved = 0;            ///< vertices
  double largest_move = 0;
};

/// Where the wall of a later body turns away from an earlier one: it goes through vertices and edges of that which are
/// near beside its own edges, or stays in its plane.
enum class Rims { kBend, kKeep };

/// Brings walls of bodies together that are nearer than their misfit: vertices of later bodies move onto vertices,
/// edges and faces of earlier ones, which stay where they are, and faces of each get the vertices and edges of the
/// other that lie on them. What is left between is cells thinner than the misfit. Without any nothing changes.
ClosedGaps close_gaps(const BodySoup& soup, const Misfits& misfits, Rims rims, const RunContext& context);

/// Takes vertices out of a complex that only the meeting of walls made: each goes to a neighbour, along its line where
/// it is on one, if nothing deviates from where it was by more than `most`, folds, or crosses. Others stay where they
/// are. Regions, patches and lines stay what they are. Returns how many went.
std::uint64_t dissolve(SurfaceMesh& complex, const std::vector<char>& may_go, double most, const RunContext& context);

/// The sine of 20 degrees: wider wedges are none.
inline constexpr double kWideWedge = 0.34;

/// What elements suffer from, of walls that came together: short edges, flat triangles and narrow wedges.
struct WallShape {
  double shortest = HUGE_VAL;     ///< edge
  double thinnest = HUGE_VAL;     ///< height of a triangle
  double narrowest = kWideWedge;  ///< sine of a wedge, up to that
  Edge at{};                      ///< the edge of that wedge; of none, the shortest
  /// Triangles within walls are made anew, where edges between these stay: their heights count less.
  double worth() const {
    constexpr double kWithinWalls = 4;
    return std::min(shortest, kWithinWalls * thinnest) * narrowest;
  }
  bool has_no_wedge() const { return narrowest >= kWideWedge; }
};

WallShape shape_of_walls(const SurfaceMesh& complex);

/// Whether two bodies, whose walls may be meant to be one, face each other across nothing there, no farther apart than
/// their misfit. Regions have the numbers of the bodies.
bool leave_gaps(const SurfaceMesh& complex, const Misfits& misfits);

}  // namespace octafront::cells
