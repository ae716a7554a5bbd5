#pragma once

#include <octafront/surface_mesh.h>

#include "base/core/groups.h"
#include "layers/region_walls.h"

#include <cstdint>
#include <string>
#include <vector>

namespace octafront::layers {

/// Per triangle 1 if it lies at one of the places, separated by commas; of regions the walls around them, but a patch
/// goes before a region of its name; all where `names` is empty. Throws OptionError for what is no place of the
/// surface.
std::vector<std::uint8_t> walls_named(const SurfaceMesh& surface, const std::string& names);

/// The regions that have one of these names, separated by commas; all where `names` is empty. Throws OptionError for
/// names that no region has.
std::vector<std::uint32_t> regions_named(const SurfaceMesh& surface, const std::string& names);

/// What bounds a region, and what meets at its vertices.
struct Walls {
  const SurfaceMesh& surface;
  const std::vector<std::uint8_t>& is_wall;  ///< per triangle
  const std::vector<std::uint8_t>& shared;   ///< per vertex
  const std::vector<std::uint8_t>& held;     ///< per vertex
  Groups<> faces;                            ///< per vertex
  std::vector<Vec3> inward;                  ///< per triangle: unit normal that points into the body
  std::vector<std::uint8_t> grows;           ///< per vertex: a wall ends or lies there
  std::vector<VertexIndex> wall_vertices;    ///< ascending

  std::vector<Rim> rims;  ///< where walls end
  bool is_outside;        ///< triangles without layers stay where they are

  explicit Walls(const RegionWall& wall);

  /// Calls visit(w) for the vertices that share an edge of a wall with v, each twice inside.
  template <class Visit>
  void for_each_neighbour(VertexIndex v, Visit&& visit) const {
    for (const std::uint32_t f : faces[v])
      if (is_wall[f])
        for (const VertexIndex w : surface.triangles[f])
          if (w != v) visit(w);
  }
};

}  // namespace octafront::layers
