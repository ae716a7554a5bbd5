#pragma once

// Complexes that tests make: the walls of labelled cells, exact by construction. All are clean.

#include <octafront/surface_mesh.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace octafront::testing {

/// A labelled net of cells: a region for each tetrahedron or box, kNone for what stays empty.
using Label = std::function<std::uint32_t(Vec3 center)>;

/// Planes of a grid along each axis, ascending.
struct GridPlanes {
  std::vector<double> x, y, z;
};

/// n planes from 0 to 1, evenly spaced by 1 / (n - 1).
std::vector<double> even_planes(int n);

/// The walls between the boxes of a grid: two triangles for each square between different labels, and for those inside
/// one label that `is_sheet` says are sheets.
SurfaceMesh box_walls(const GridPlanes& planes, const Label& label,
                      const std::function<bool(Vec3 middle)>& is_sheet = {});

/// The walls between the tetrahedra of a grid of n^3 cubes, six for each, in [0, 1]^3 with its inner vertices moved by
/// chance: rough, and with edges of many walls.
SurfaceMesh rough_walls(int n, const Label& label, unsigned seed, double jitter = 0.15);

/// Cells of `cells` random points in [0, 1]^3: the nearest one's number.
Label nearest_of(int cells, unsigned seed);

/// Each vertex p becomes map(p).
SurfaceMesh mapped(SurfaceMesh surface, const std::function<Vec3(Vec3)>& map);

/// The same complex with its triangles turned by chance, sides and all, in another order.
SurfaceMesh shuffled(const SurfaceMesh& complex, unsigned seed);

/// The volume that a region's triangles enclose.
double volume_of_region(const SurfaceMesh& complex, std::uint32_t region);

}  // namespace octafront::testing
