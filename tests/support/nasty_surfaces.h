#pragma once

// Valid closed surfaces that meshers die on, at random from a seed, and the polyhedra of the literature that no
// tetrahedralisation without extra points fills.

#include <octafront/surface_mesh.h>

#include <cstdint>
#include <string>

namespace octafront::testing {

struct NastySurface {
  std::string name;  ///< the family and its parameters
  SurfaceMesh surface;
};

/// One of the families below with random parameters; the same for the same seed on every machine.
NastySurface nasty_surface(std::uint64_t seed);

/// The twisted prism over a regular n-gon: its diagonals are reflex. n = 3 and a twist of 30 degrees give the
/// polyhedron of E. Schönhardt (1928).
SurfaceMesh twisted_prism(int n, double twist_degrees, double height = 1);

/// B. Chazelle's polyhedron (1984): n notches from above and n from below, whose ridges nearly meet on the surface z =
/// x y, at a distance of 2 gap.
SurfaceMesh chazelle_polyhedron(int n, double gap);

/// The boundary of a set of unit cubes of an n x n x n grid, cube (x, y, z) present if bit x + n (y + n z) of the
/// seed's random stream says so; cubes that meet in an edge or a vertex only pinch the surface there. Vertices move by
/// up to `jitter`.
SurfaceMesh random_voxels(int n, double density, double jitter, std::uint64_t seed);

}  // namespace octafront::testing
