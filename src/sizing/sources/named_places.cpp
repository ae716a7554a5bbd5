#include "sizing/sources/named_places.h"

#include <octafront/error.h>

#include "base/mesh/complex.h"
#include "base/mesh/curve_names.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Names that a message lists at most.
constexpr std::size_t kMostListed = 12;

}  // namespace

NamedPlaces::NamedPlaces(const KnownSurface& surface) : known_(surface), surface_(surface.mesh()) {
  for (std::uint32_t r = 0; r < region_count(surface_); ++r) names_.insert(region_name(surface_, r));
  for (const std::string& name : surface_.patch_names)
    if (!name.empty()) names_.insert(name);
}

std::optional<std::uint32_t> NamedPlaces::region(const std::string& name) const {
  for (std::uint32_t r = 0; r < region_count(surface_); ++r)
    if (region_name(surface_, r) == name) return r;
  return std::nullopt;
}

std::vector<std::uint32_t> NamedPlaces::patch(const std::string& name) const {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
    const std::uint32_t patch = surface_.patch_of(t);
    if (patch < surface_.patch_names.size() && surface_.patch_names[patch] == name) triangles.push_back(t);
  }
  return triangles;
}

std::vector<Edge> NamedPlaces::curve(const std::string& name) {
  const EdgeTable& table = known_.edges();
  std::vector<Edge> edges;
  std::vector<std::uint32_t> patches;
  for (std::size_t e = 0; e < table.size(); ++e) {
    patches.clear();
    for (const HalfEdge half : table.uses(e)) patches.push_back(surface_.patch_of(half / 3));
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    if (patches.size() < 2 && table.uses(e).size() == 2) continue;
    const std::string here = curve_name(patches, surface_.patch_names);
    if (!here.empty()) names_.insert(here);
    if (here == name) edges.push_back(table.edges[e]);
  }
  return edges;
}

void NamedPlaces::refuse(const std::string& name) const {
  std::string list;
  std::size_t listed = 0;
  for (const std::string& known : names_) {
    if (++listed > kMostListed) break;
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", known);
  }
  throw OptionError(fmt::format("no region, patch or curve is called \"{}\"; there are {}{}", name, list,
                                names_.size() > kMostListed ? ", ..." : ""));
}

}  // namespace octafront
