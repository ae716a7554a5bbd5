#pragma once

// Valid closed surfaces that meshers die on, at random from a seed, and the polyhedra of the literature that no
// tetrahedralisation without extra points fills.

#include <octafront/surface_mesh.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront::testing {

struct NastySurface {
  std::string name;  ///< the family and the seed
  SurfaceMesh surface;
};

/// One of the families in nasty_surfaces.cpp with random parameters, clean (closed, outward, manifold, not meeting
/// itself); the same for the same seed on every machine. Up to some 1,500 triangles, most have fewer than 300.
NastySurface nasty_surface(std::uint64_t seed);

/// The twisted prism over a regular n-gon: its diagonals are reflex. n = 3 and a twist of 30 degrees give the
/// polyhedron of E. Schönhardt (1928). Several levels make a tower of such prisms, each twisted against the one below.
SurfaceMesh twisted_prism(int n, double twist_degrees, double height = 1, int levels = 1);

/// B. Chazelle's polyhedron (1984): n notches from above and n from below, whose ridges nearly meet on the surface z =
/// x y, at a distance of 2 gap.
SurfaceMesh chazelle_polyhedron(int n, double gap);

/// Where cubes meet in an edge or a vertex only: the surface is pinched there, or cubes are added until it is not.
enum class Pinches { kKept, kFilled };

/// The boundary of a set of unit cubes of an n x n x n grid, each present with the probability `density`. Vertices move
/// by up to `jitter`.
SurfaceMesh random_voxels(int n, double density, double jitter, Pinches pinches, std::uint64_t seed);

/// The boundary of some unit cubes of an n x n x n grid, facing outward; it may touch itself in edges and vertices.
SurfaceMesh boundary_of_cubes(int n, const std::vector<std::array<int, 3>>& cubes);
/// All cubes of the grid but for these.
std::vector<std::array<int, 3>> all_cubes_but(int n, const std::vector<std::array<int, 3>>& gaps);

}  // namespace octafront::testing
