#pragma once

#include <octafront/poly_mesh.h>

#include "base/core/groups.h"

#include <cstdint>
#include <span>

namespace octafront::dual {

/// The faces of each cell, ascending.
Groups<> faces_of_cells(const PolyMesh& mesh);

/// Of a face, by the triangles around the mean of its points.
struct FaceMeasure {
  Vec3 area;    ///< outward of the owner, as long as the area is large
  Vec3 middle;  ///< weighted by area
};
FaceMeasure measure(const PolyMesh& mesh, std::size_t face);

/// Whether each edge of its faces is passed once in either direction.
bool is_closed(const PolyMesh& mesh, std::uint32_t cell, std::span<const std::uint32_t> faces);

/// The mean of the points of a face.
Vec3 mean_of(const PolyMesh& mesh, std::size_t face);
double volume_of(const PolyMesh& mesh, std::uint32_t cell, std::span<const std::uint32_t> faces);
/// The centre of mass.
Vec3 middle_of_cell(const PolyMesh& mesh, std::uint32_t cell, std::span<const std::uint32_t> faces);

}  // namespace octafront::dual
