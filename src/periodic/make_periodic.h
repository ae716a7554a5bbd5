#pragma once

// Opposite faces made the same. Takes a clean surface or complex, leaves one whose flat faces at both
// ends of an axis are the same triangles, the one moved onto the other bit for bit: matched.cpp finds what each face is
// divided into by the lines of both, same_faces.cpp puts it into the surface. By other maps mapped_faces.cpp: it finds
// the faces (map_finder.cpp), brings their lines together and copies what is between them.

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include "periodic/periodic_cell.h"
#include "periodic/periods_asked.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// What make_periodic() did.
struct MadePeriodic {
  PeriodicCell cell;
  std::vector<std::uint32_t> origin;  ///< per triangle of the result: one of the input that it is a part of
  std::uint64_t moved = 0;            ///< vertices that were brought onto a face, or to their copies
  double largest_move = 0;            ///< input units
  std::uint64_t imprinted = 0;        ///< triangles of faces that are new
};

/// Vertices this near to a face of the bounding box, as a part of its diagonal, lie on it, and lines of opposite faces
/// this near to each other are one: single precision keeps seven digits.
inline constexpr double kSamePlace = 1e-6;

/// Makes the surface one cell of a periodic one along the axes: triangles on opposite faces of its bounding box are the
/// same. Where they are so already they stay; where their lines differ, both faces get the lines of both, and new
/// triangles. Each face becomes a patch, or several: by the patches and regions on it and on the opposite one; the
/// patch of a face is of no other. Names of patches that lie on one face alone stay; others become "x_min", "x_max",
/// ...
///
/// REQUIRES a clean surface or complex. Throws InputError, with a place, where opposite faces are not the same, or
/// there is no flat face.
MadePeriodic make_periodic(SurfaceMesh& surface, const std::array<bool, 3>& along, const RunContext& context = {});

/// The same by maps other than those along the axes of a box. What a map leads onto another part of the surface that
/// looks the other way are its faces, or the patches that are named. The high face gets the triangles of the low one;
/// where lines end on one of them only (within kSamePlace of the diagonal), the other gets a vertex. Vertices of low
/// faces come to the grid of the cell (2^-44 of the largest coordinate), those of high ones are what the map makes of
/// them. Faces are called "periodic_1_low", ... where they have no names of their own.
///
/// Throws InputError, with a place, where a map leads nothing onto the surface, or lines of faces are not the same;
/// OptionError for names that there are not.
MadePeriodic make_periodic(SurfaceMesh& surface, const std::vector<AskedMap>& maps, const RunContext& context = {});

}  // namespace octafront
