#pragma once

// Boundary layers as columns of nodes over the vertices of a wall, and the tetrahedra between them.
// Takes a surface, a direction and heights for each of its vertices; leaves the surface on top of the layers, which the
// volume front fills, and one mesh of both.

#include <octafront/surface_mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace octafront::layers {

/// Why there is less than was asked for.
enum class Reason : std::uint8_t {
  kNone,       ///< all layers, as high as asked
  kDirection,  ///< nothing inside sees all triangles there: a sharp ridge or corner
  kBare,       ///< the patch beside, which gets no layers, bends or lies inside: they have nothing to end on
  kGap,        ///< another wall is near
  kShape,      ///< elements would be too distorted, or inside out
  kCrossing,   ///< layers would meet others, or a wall
  kNeighbour   ///< limited by what is beside it
};
inline constexpr std::size_t kReasons = 7;

/// A node of a column: vertex of the wall and level, 0 on the wall.
struct Node {
  VertexIndex column;
  std::uint32_t level;
};

/// Height of so many layers whose first one is 1.
double total_height(double growth, std::uint32_t levels);

/// Columns over the vertices of a surface. Vertices that no layers grow from have count 0.
struct Columns {
  std::vector<Vec3> step;            ///< per vertex: the way for a height of 1, longer than 1 in corners
  std::vector<double> first;         ///< per vertex: height of the first layer as asked
  std::vector<double> part;          ///< per vertex: heights over those asked; at most 1
  std::vector<std::uint32_t> count;  ///< per vertex: layers
  std::vector<Reason> reason;        ///< per vertex
  double growth = 1.2;               ///< each layer over the one below
  std::uint32_t asked = 0;           ///< layers

  double height_of(std::uint32_t levels) const { return total_height(growth, levels); }
  Vec3 place(const SurfaceMesh& wall, Node node) const;
  Vec3 top(const SurfaceMesh& wall, VertexIndex v) const { return place(wall, {v, count[v]}); }
};

/// The tetrahedra of one layer (0 is the one at the wall) over a triangle of the wall, at most three. Quads between
/// columns are divided from the lower node of the column with the smaller number, so that neighbours match (J.
/// Dompierre et al., How to subdivide pyramids, prisms and hexahedra into tetrahedra, 1999). Columns that end below
/// leave fewer. Corners in the order in which a sound tetrahedron is positive.
struct TetsOfLayer {
  std::array<std::array<Node, 4>, 3> tets;
  int count = 0;
};
TetsOfLayer tets_of_layer(const Columns& columns, const Triangle& triangle, std::uint32_t layer);

}  // namespace octafront::layers
