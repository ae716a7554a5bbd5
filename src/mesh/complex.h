#pragma once

// A complex (octafront/surface_mesh.h) as the stages see it: which of its triangles bound what, and which faces and
// regions a mesh that fills it has. A surface without `sides` is the complex of one region.

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// Whether the surface has more than one region, or sheets, or triangles that do not face outward.
bool is_complex(const SurfaceMesh& surface);

/// Turns triangles such that the outside, or else the region of the higher number, lies in front.
void face_lower_regions_behind(SurfaceMesh& complex);

/// One more than the largest number of a region.
std::uint32_t region_count(const SurfaceMesh& complex);

/// The name of a region, or "region 3" for the third where it has none.
std::string region_name(const SurfaceMesh& complex, std::uint32_t region);

/// What lies between the regions and the outside, facing outward; a surface without `sides`, on the same points.
SurfaceMesh hull_of(const SurfaceMesh& complex);

/// All that bounds one region, facing away from it; sheets inside it twice. A closed surface that may touch itself; on
/// the same points, without `sides`.
SurfaceMesh boundary_of_region(const SurfaceMesh& complex, std::uint32_t region);

/// Makes the triangles of the complex the boundary and the interfaces of a mesh, in their order, with their patches.
/// REQUIRES that the complex's points are the mesh's first ones, and that its higher regions lie in front.
void list_faces(const SurfaceMesh& complex, TetMesh& mesh);

/// The region of each tetrahedron of a mesh whose faces include the triangles of the complex, vertex for vertex.
/// Throws MeshingError if two regions, or a region and the outside, meet without a triangle between them.
std::vector<std::uint32_t> regions_within(const SurfaceMesh& complex, const TetMesh& mesh);

}  // namespace octafront
