#pragma once

#include <octafront/tet_mesh.h>

#include "fill/front/front_task.h"
#include "fill/front/work_mesh.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

namespace octafront {

/// Closes what the front has left open, rung by rung: backtracking with other choices and growing rings, a kernel point
/// with growth, and at last recovery of the cavity's walls in a Delaunay mesh. `mesh` fills `surface`, whose points
/// come first, but for what the walls enclose; they face it. Points that the closing leaves without a tetrahedron go.
/// What comes out depends on no order, of tetrahedra or walls. Reports which rung closed how many. Throws
/// OpenCavityError with the first cavity that stays open, or has more walls than the surface has triangles: then
/// recovery of the whole surface is less work.
void close_cavities(TetMesh& mesh, std::vector<Wall> walls, const SurfaceMesh& surface, const FrontTask& task);

/// A tetrahedron by its place in the order in which a front alone would have left it.
struct NumberedTet {
  std::uint64_t number = 0;
  Tet tet{};
};

/// What a rank has of a front's tetrahedra.
struct FrontTets {
  /// From tets[first] on, numbers count up from `number`.
  struct Stretch {
    std::size_t first = 0;
    std::uint64_t number = 0;
  };
  std::vector<Tet> tets;
  std::vector<Stretch> stretches;  ///< ascending

  std::uint64_t number(std::size_t t) const {
    const auto after = std::ranges::upper_bound(stretches, t, {}, &Stretch::first);
    return std::prev(after)->number + (t - std::prev(after)->first);
  }
};

/// close_cavities(), where each of several ranks has a share of the tetrahedra: what is around cavities is brought to
/// all. No points are dropped.
void close_cavities_of_shares(std::vector<Vec3>& points, FrontTets& share, std::vector<Wall> walls,
                              const SurfaceMesh& surface, const FrontTask& task);

}  // namespace octafront
