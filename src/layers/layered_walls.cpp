#include "layers/layered_walls.h"

#include <octafront/error.h>

#include "base/geometry/measures.h"
#include "base/places/places.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront::layers {

std::vector<std::uint8_t> walls_named(const SurfaceMesh& surface, const std::string& names) {
  if (names.empty()) return std::vector<std::uint8_t>(surface.triangles.size(), 1);
  const SurfacePlaces places(surface);
  std::vector<std::uint8_t> is_wall(surface.triangles.size(), 0);
  for (const Place& place : places_listed("on", names, ',', surface.patch_names)) {
    const SurfaceItems items = places.at("on", place);
    for (const std::uint32_t f : items.triangles) is_wall[f] = 1;
    if (!items.triangles.empty()) continue;  // a patch goes before a region of its name
    for (const std::uint32_t region : items.regions)
      for (std::size_t f = 0; f < is_wall.size(); ++f)
        if (std::ranges::count(surface.sides_of(f), region) == 1) is_wall[f] = 1;
  }
  return is_wall;
}

std::vector<std::uint32_t> regions_named(const SurfaceMesh& surface, const std::string& names) {
  const SurfacePlaces places(surface);
  std::vector<std::uint8_t> is_chosen(places.regions().size(), names.empty());
  for (const Place& place : places_listed("in", names, ',', places.regions())) {
    const SurfaceItems items = places.at("in", place);
    if (items.regions.empty())
      throw OptionError(fmt::format("`in` is a list of regions, and \"{}\" is none", place.text));
    for (const std::uint32_t region : items.regions) is_chosen[region] = 1;
  }
  std::vector<std::uint32_t> regions;
  for (std::uint32_t r = 0; r < is_chosen.size(); ++r)
    if (is_chosen[r]) regions.push_back(r);
  return regions;
}

Walls::Walls(const RegionWall& wall)
    : surface(wall.surface),
      is_wall(wall.is_wall),
      shared(wall.shared),
      held(wall.held),
      faces(rows_at_vertices(surface.points.size(), surface.triangles)),
      grows(surface.points.size(), 0),
      rims(rims_of(wall)),
      is_outside(wall.region == kNone) {
  inward.reserve(surface.triangles.size());
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
    const auto [a, b, c] = surface.triangles[f];
    inward.push_back(-unit_normal(surface.points[a], surface.points[b], surface.points[c]));
    if (!is_wall[f]) continue;
    grows[a] = grows[b] = grows[c] = 1;
  }
  for (VertexIndex v = 0; v < grows.size(); ++v)
    if (grows[v]) wall_vertices.push_back(v);
}

}  // namespace octafront::layers
