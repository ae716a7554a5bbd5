#pragma once

// A complex (octafront/surface_mesh.h) as the stages see it: which of its triangles bound what, and which faces and
// regions a mesh that fills it has. A surface without `sides` is the complex of one region.

#include <octafront/ids.h>
#include <octafront/tet_mesh.h>

#include "base/mesh/face_table.h"

#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// Whether the surface has more than one region, or sheets, or triangles that do not face outward.
bool is_complex(const SurfaceMesh& surface);

/// Turns triangles such that the outside, or else the region of the higher number, lies in front.
void face_lower_regions_behind(SurfaceMesh& complex);

/// One more than the largest number of a region.
std::uint32_t region_count(const SurfaceMesh& complex);

/// What each region encloses, by number; of a surface without `sides` that of its one region. Small ones keep their
/// digits however far away the others are. Unit: input unit cubed.
std::vector<double> volumes_of_regions(const SurfaceMesh& complex);

/// What a region is called: region_label().
std::string region_name(const SurfaceMesh& complex, std::uint32_t region);

/// What lies between the regions and the outside, facing outward; a surface without `sides`, on the same points.
SurfaceMesh hull_of(const SurfaceMesh& complex);

/// All that bounds one region, facing away from it; sheets inside it twice. A closed surface that may touch itself; on
/// the same points, without `sides`.
SurfaceMesh boundary_of_region(const SurfaceMesh& complex, std::uint32_t region);

/// Makes the triangles of the complex the boundary and the interfaces of a mesh, in their order, with their patches.
/// REQUIRES that the complex's points are the mesh's first ones, and that its higher regions lie in front.
void list_faces(const SurfaceMesh& complex, TetMesh& mesh);

/// Per vertex, whether a triangle has it.
std::vector<std::uint8_t> corners_of(std::size_t points, const std::vector<Triangle>& triangles);

/// Walls lie between vertices of walls: a vertex that is on none has one region all around it. So only faces between
/// vertices of walls need a table. Calls add(corners, number) for these, the number being twice that of the
/// tetrahedron, and one more where its face is even (is_even).
template <class Add>
void for_each_face_between(const TetMesh& mesh, const std::vector<std::uint8_t>& on_wall, const Add& add) {
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    if (on_wall[tet[0]] + on_wall[tet[1]] + on_wall[tet[2]] + on_wall[tet[3]] < 3) continue;
    for (int i = 0; i < 4; ++i) {
      const Triangle corners = face_of(tet, i);
      if (on_wall[corners[0]] != 0 && on_wall[corners[1]] != 0 && on_wall[corners[2]] != 0)
        add(corners, 2 * t + static_cast<std::uint32_t>(is_even(corners)));
    }
  }
}

/// The region of each tetrahedron of a mesh whose faces include the triangles of the complex, vertex for vertex.
/// Throws MeshingError if two regions, or a region and the outside, meet without a triangle between them.
std::vector<std::uint32_t> regions_within(const SurfaceMesh& complex, const TetMesh& mesh);

}  // namespace octafront
