#pragma once

// Complexes of several regions whose volumes are known. What is round is a polyhedron, whose volume is meant. All are
// clean: triangles meet in shared vertices and edges only, each region is closed.

#include <octafront/surface_mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace octafront::testing {

struct KnownComplex {
  std::string name;
  SurfaceMesh surface;          ///< with sides and names of regions
  std::vector<double> volumes;  ///< per region
};

/// The volume of each region by the triangles around it, summed in long double.
std::vector<double> region_volumes(const SurfaceMesh& complex);

/// [0, 1]^2 x ..., boxes upon each other, one for each thickness.
KnownComplex stacked_layers(const std::vector<double>& thickness);
/// The unit cube cut by random planes: hundreds of convex cells for twenty.
KnownComplex plane_cuts(int planes, std::uint64_t seed);
/// Voronoi cells of random points in the unit cube.
KnownComplex foam(int cells, std::uint64_t seed);
/// n^3 spheres that do not touch, of different radii, in a cube; region 0 is the matrix.
KnownComplex packed_spheres(int n, std::uint64_t seed);
/// Concentric spheres, a region between each two; region 0 is the outermost shell.
KnownComplex nested_shells(int shells);
/// Two gears that touch along one flank.
KnownComplex gear_pair(int teeth);
/// A plate with a crack through it, from one side to its middle: a sheet.
KnownComplex cracked_plate();
/// A cube with a square crack inside that touches nothing.
KnownComplex buried_crack();
/// A wire along a helix, and what is around it.
KnownComplex insulated_wire(int turns, int steps_per_turn, int corners);
/// Two cubes with one common edge; with one common corner.
KnownComplex touching_in_edge();
KnownComplex touching_in_point();

/// All of the above as the campaign wants them.
std::vector<KnownComplex> known_complexes();

/// Bodies by themselves, as a user has them in files of their own, and what volumes they have together, later ones
/// first.
struct KnownParts {
  std::string name;
  std::vector<SurfaceMesh> parts;
  std::vector<std::string> names;
  std::vector<double> volumes;  ///< of each part once they are joined
};

/// A prism of `corners` sides in the hole of a plate, its sides triangulated in another way. With `finer`, the bolt has
/// further vertices amid its sides, which rounding puts beside the plate's.
KnownParts bolt_in_hole(int corners, bool finer);
/// Two boxes, the second through a part of the first.
KnownParts overlapping_boxes();
std::vector<KnownParts> known_parts();

}  // namespace octafront::testing
