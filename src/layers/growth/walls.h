#pragma once

#include <octafront/surface_mesh.h>

#include "base/core/groups.h"

#include <cstdint>
#include <string>
#include <vector>

namespace octafront::layers {

/// Per triangle 1 if its patch is one of those named, separated by commas; of all where `names` is empty. Throws
/// OptionError for names that no patch has.
std::vector<std::uint8_t> walls_named(const SurfaceMesh& surface, const std::string& names);

/// A surface of which some triangles are walls, and what meets at its vertices.
struct Walls {
  const SurfaceMesh& surface;
  std::vector<std::uint8_t> is_wall;       ///< per triangle
  Groups<> faces;                          ///< per vertex
  std::vector<Vec3> inward;                ///< per triangle: unit normal that points into the body
  std::vector<std::uint8_t> grows;         ///< per vertex: a wall ends or lies there
  std::vector<std::uint32_t> wall_faces;   ///< ascending
  std::vector<VertexIndex> wall_vertices;  ///< ascending

  Walls(const SurfaceMesh& surface, std::vector<std::uint8_t> is_wall);

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
