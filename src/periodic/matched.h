#pragma once

// One division of two faces that lie opposite to each other.

#include <octafront/surface_mesh.h>

#include "periodic/face_maker.h"
#include "periodic/periodic_cell.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace octafront::periods {

/// A triangle of a division: nodes, counter-clockwise seen along the axis, and the parts of both faces that it is of.
struct CommonPiece {
  std::array<std::uint32_t, 3> nodes;
  std::array<std::uint32_t, 2> part;
};

/// What both faces are divided into, seen on the low one.
struct CommonDivision {
  std::vector<Vec3> nodes;
  std::vector<CommonPiece> pieces;
  /// Of both faces, per border edge that has nodes between its ends: these, from the lower vertex of the edge on.
  std::array<std::map<Edge, std::vector<std::uint32_t>>, 2> between;
};

/// Divides the faces at both ends of the axis by the borders of the parts of both. Borders within `tolerance` of each
/// other become one. Throws InputError, with a place, where something lies on one face only.
CommonDivision divide_alike(const SurfaceMesh& surface, const PeriodicCell& cell, int axis,
                            const std::array<FaceParts, 2>& faces, double tolerance);

}  // namespace octafront::periods
