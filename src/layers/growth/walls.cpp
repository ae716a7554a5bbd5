#include "layers/growth/walls.h"

#include <octafront/error.h>

#include "base/geometry/measures.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include <fmt/core.h>

namespace octafront::layers {

namespace {

/// The names themselves may hold commas: a patch that is called like the whole list comes first.
std::vector<std::string> names_in(const SurfaceMesh& surface, const std::string& list) {
  if (std::ranges::find(surface.patch_names, list) != surface.patch_names.end()) return {list};
  std::vector<std::string> names;
  std::istringstream in(list);
  for (std::string name; std::getline(in, name, ',');) names.push_back(name);
  return names;
}

std::string patches_in_words(const SurfaceMesh& surface) {
  std::string words;
  for (const std::string& name : surface.patch_names)
    if (!name.empty()) words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", name);
  return words.empty() ? "no patch of this surface has a name" : "there are " + words;
}

}  // namespace

std::vector<std::uint8_t> walls_named(const SurfaceMesh& surface, const std::string& names) {
  if (names.empty()) return std::vector<std::uint8_t>(surface.triangles.size(), 1);
  std::vector<std::uint8_t> is_chosen(surface.patch_names.size(), 0);
  for (const std::string& name : names_in(surface, names)) {
    const auto found = std::ranges::find(surface.patch_names, name);
    if (found == surface.patch_names.end())
      throw OptionError(fmt::format("`on`: there is no patch \"{}\": {}", name, patches_in_words(surface)));
    is_chosen[static_cast<std::size_t>(found - surface.patch_names.begin())] = 1;
  }
  std::vector<std::uint8_t> is_wall;
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const std::uint32_t patch = surface.patch_of(f);
    is_wall.push_back(patch < is_chosen.size() && is_chosen[patch]);
  }
  return is_wall;
}

Walls::Walls(const SurfaceMesh& on, std::vector<std::uint8_t> chosen)
    : surface(on),
      is_wall(std::move(chosen)),
      faces(on.points.size(),
            [&](const auto& add) {
              for (std::uint32_t f = 0; f < on.triangles.size(); ++f)
                for (const VertexIndex v : on.triangles[f]) add(v, f);
            }),
      grows(on.points.size(), 0) {
  inward.reserve(on.triangles.size());
  for (std::uint32_t f = 0; f < on.triangles.size(); ++f) {
    const auto [a, b, c] = on.triangles[f];
    inward.push_back(-unit_normal(on.points[a], on.points[b], on.points[c]));
    if (!is_wall[f]) continue;
    wall_faces.push_back(f);
    grows[a] = grows[b] = grows[c] = 1;
  }
  for (VertexIndex v = 0; v < grows.size(); ++v)
    if (grows[v]) wall_vertices.push_back(v);
}

}  // namespace octafront::layers
