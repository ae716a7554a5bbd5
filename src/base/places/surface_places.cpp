#include <octafront/error.h>

#include "base/core/utf8.h"
#include "base/mesh/complex.h"
#include "base/mesh/curve_names.h"
#include "base/places/places.h"

#include <algorithm>
#include <set>

#include <fmt/core.h>

namespace octafront {
namespace {

bool is_in(const Box3& box, Vec3 p) {
  return box.contains(p);
}
bool is_in(const GroupRule::Sphere& ball, Vec3 p) {
  return squared_length(p - ball.center) <= ball.radius * ball.radius;
}

template <class Space>
std::vector<std::uint32_t> triangles_in(const SurfaceMesh& surface, const Space& space) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    if (std::ranges::all_of(surface.triangles[t], [&](VertexIndex v) { return is_in(space, surface.points[v]); }))
      triangles.push_back(t);
  return triangles;
}

}  // namespace

SurfacePlaces::SurfacePlaces(const SurfaceMesh& surface, const EdgeTable* edges) : surface_(surface), edges_(edges) {
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const std::uint32_t patch = surface.patch_of(t);
    if (patch >= is_there_.size()) is_there_.resize(patch + 1, 0);
    is_there_[patch] = 1;
  }
  for (std::uint32_t p = 0; p < is_there_.size(); ++p) patches_.push_back(patch_label(surface.patch_names, p));
  for (std::uint32_t r = 0; r < region_count(surface); ++r) regions_.push_back(region_name(surface, r));
}

std::vector<std::uint32_t> SurfacePlaces::triangles_of(const std::vector<std::uint32_t>& patches) const {
  std::vector<std::uint32_t> triangles;
  if (patches.empty()) return triangles;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t)
    if (std::ranges::binary_search(patches, surface_.patch_of(t))) triangles.push_back(t);
  return triangles;
}

/// Each edge of a curve with the curve's name.
std::vector<std::pair<std::string, Edge>> SurfacePlaces::curves() const {
  std::vector<std::pair<std::string, Edge>> curves;
  std::vector<std::uint32_t> patches;
  for (std::size_t e = 0; edges_ != nullptr && e < edges_->size(); ++e) {
    patches.clear();
    for (const HalfEdge half : edges_->uses(e)) patches.push_back(surface_.patch_of(half / 3));
    std::ranges::sort(patches);
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    if (patches.size() < 2 && edges_->uses(e).size() == 2) continue;
    curves.emplace_back(curve_name(patches, patches_), edges_->edges[e]);
  }
  return curves;
}

SurfaceItems SurfacePlaces::called(std::string_view option, const std::string& name) const {
  SurfaceItems items{named_so(regions_, name), {}, {}};
  const std::vector<std::pair<std::string, Edge>> edges = curves();
  std::vector<std::string> curve_of;
  for (const auto& [curve, edge] : edges) curve_of.push_back(curve);
  for (const std::uint32_t e : named_so(curve_of, name)) items.edges.push_back(edges[e].second);
  const std::vector<std::uint32_t> patches = patches_called(surface_.patch_names, is_there_, name);
  const bool is_named = !items.regions.empty() || !items.edges.empty();
  const bool by_number =
      !patches.empty() && std::ranges::find(surface_.patch_names, name) == surface_.patch_names.end();
  if (!is_named || !by_number) items.triangles = triangles_of(patches);
  // Another way to write a number of a region, which it has no name for.
  for (std::uint32_t r = 0; r < regions_.size() && !is_named && items.triangles.empty(); ++r)
    if (name == fmt::format("region {}", r + 1)) items.regions = {r};
  if (items.regions.empty() && items.triangles.empty() && items.edges.empty()) refuse(option, name);
  return items;
}

SurfaceItems SurfacePlaces::at(std::string_view option, const Place& place) const {
  SurfaceItems items;
  if (const auto* name = std::get_if<std::string>(&place.where)) {
    std::string clean = *name;
    NameCleaning().clean(clean);  // as those of the surface are
    return called(option, clean);
  }
  if (const auto* names = std::get_if<std::vector<std::string>>(&place.where)) {
    std::vector<std::uint32_t> all;
    for (std::string name : *names) {
      NameCleaning().clean(name);
      const std::vector<std::uint32_t> patches = patches_called(option, surface_.patch_names, is_there_, name);
      all.insert(all.end(), patches.begin(), patches.end());
    }
    std::ranges::sort(all);
    items.triangles = triangles_of(all);
  }
  if (const auto* box = std::get_if<Box3>(&place.where)) items.triangles = triangles_in(surface_, *box);
  if (const auto* ball = std::get_if<GroupRule::Sphere>(&place.where)) items.triangles = triangles_in(surface_, *ball);
  return items;
}

std::vector<std::string> SurfacePlaces::names_of_curves() const {
  std::set<std::string> names;
  for (const auto& [curve, edge] : curves()) names.insert(curve);
  return {names.begin(), names.end()};
}

void SurfacePlaces::refuse(std::string_view option, const std::string& name) const {
  std::vector<NamesOfKind> there{{"region", regions_}, {"patch", patches_}};
  if (edges_ != nullptr) there.push_back({"curve", names_of_curves()});
  throw OptionError(fmt::format("`{}`: {}", option, no_such_place(name, there)));
}

PlaceNames place_names(const SurfaceMesh& surface) {
  const EdgeTable edges = make_edge_table(surface.points.size(), surface.triangles);
  const SurfacePlaces places(surface, &edges);
  PlaceNames names{places.regions(), places.patches(), places.names_of_curves(), {}};
  for (std::size_t e = 0; e < edges.size() && surface.sides.empty(); ++e)
    if (edges.uses(e).size() > 2) names.regions.clear();
  return names;
}

}  // namespace octafront
