#include "layers/growth/walls.h"

#include <octafront/error.h>

#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront::layers {

namespace {

using Names = std::vector<std::string>;

std::string in_words(const Names& known, const char* what) {
  std::string words;
  for (const std::string& name : known)
    if (!name.empty()) words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", name);
  return words.empty() ? fmt::format("no {} of this surface has a name", what) : "there are " + words;
}

/// Per known name whether the list has it. `option` and `what`: for what is said of others.
std::vector<std::uint8_t> chosen(const Names& known, const std::string& list, const char* option, const char* what) {
  std::vector<std::uint8_t> is_chosen(known.size(), 0);
  for (const std::string& name : names_listed(list, known)) {
    const auto found = std::ranges::find(known, name);
    if (found == known.end())
      throw OptionError(fmt::format("`{}`: there is no {} \"{}\": {}", option, what, name, in_words(known, what)));
    is_chosen[static_cast<std::size_t>(found - known.begin())] = 1;
  }
  return is_chosen;
}

}  // namespace

std::vector<std::uint8_t> walls_named(const SurfaceMesh& surface, const std::string& names) {
  if (names.empty()) return std::vector<std::uint8_t>(surface.triangles.size(), 1);
  const std::vector<std::uint8_t> is_chosen = chosen(surface.patch_names, names, "on", "patch");
  std::vector<std::uint8_t> is_wall;
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const std::uint32_t patch = surface.patch_of(f);
    is_wall.push_back(patch < is_chosen.size() && is_chosen[patch]);
  }
  return is_wall;
}

std::vector<std::uint32_t> regions_named(const SurfaceMesh& surface, const std::string& names) {
  Names known;
  for (std::uint32_t r = 0; r < region_count(surface); ++r) known.push_back(region_name(surface, r));
  const std::vector<std::uint8_t> is_chosen =
      names.empty() ? std::vector<std::uint8_t>(known.size(), 1) : chosen(known, names, "in", "region");
  std::vector<std::uint32_t> regions;
  for (std::uint32_t r = 0; r < known.size(); ++r)
    if (is_chosen[r]) regions.push_back(r);
  return regions;
}

Walls::Walls(const RegionWall& wall)
    : surface(wall.surface),
      is_wall(wall.is_wall),
      shared(wall.shared),
      held(wall.held),
      faces(surface.points.size(),
            [&](const auto& add) {
              for (std::uint32_t f = 0; f < surface.triangles.size(); ++f)
                for (const VertexIndex v : surface.triangles[f]) add(v, f);
            }),
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
