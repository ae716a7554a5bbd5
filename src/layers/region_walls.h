#pragma once

#include <octafront/surface_mesh.h>

#include "layers/columns.h"

#include <cstdint>
#include <vector>

namespace octafront::layers {

/// What bounds one region of a surface, as a surface of its own that faces away from the region.
struct RegionWall {
  std::uint32_t region = 0;           ///< kNone: what lies outside of all
  SurfaceMesh surface;                ///< patches are those of the whole
  std::vector<VertexIndex> vertex;    ///< per vertex: in the whole; ascending
  std::vector<std::uint32_t> face;    ///< per triangle: in the whole; ascending. A sheet inside is there once
  std::vector<std::uint8_t> is_wall;  ///< per triangle
  std::vector<std::uint8_t> shared;   ///< per vertex: triangles that do not bound the region meet there too
  std::vector<std::uint8_t> held;     ///< per vertex: nothing can grow there, for what is beside it cannot move
};

/// What bounds these regions of a surface, in their order, each once; kNone is the outside. `is_wall`: per triangle of
/// the surface. Sheets are no walls.
std::vector<RegionWall> walls_of_regions(const SurfaceMesh& whole, const std::vector<std::uint8_t>& is_wall,
                                         const std::vector<std::uint32_t>& regions);

/// An edge between a triangle of the wall, in which it runs from a to b, and one without layers.
struct Rim {
  VertexIndex a, b;
  std::uint32_t wall, bare;
};
std::vector<Rim> rims_of(const RegionWall& wall);

/// A region and what grows in it.
struct LayeredRegion {
  RegionWall wall;
  Columns columns;

  bool is_outside() const { return wall.region == kNone; }
};

}  // namespace octafront::layers
