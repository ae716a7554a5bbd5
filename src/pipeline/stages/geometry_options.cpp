#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/split.h>

#include "base/mesh/complex.h"
#include "base/mesh/complex_patches.h"
#include "base/mesh/curve_names.h"
#include "base/places/places.h"
#include "base/places/shape_place.h"
#include "pipeline/stages/true_shape.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Degrees: within a face only such edges are features.
constexpr double kAngleWithinFace = 80;

/// What a place means before the mesh is made: patches, curves and regions of the domain by names that mean them alone,
/// and points.
struct Meant {
  std::vector<std::string> names;
  std::vector<Vec3> points;
};

/// Refuses a group by patches that the mesh will not have.
void check_group_of(const Domain& domain, const GroupRule& rule) {
  SurfaceMesh patches;
  patches.patch_names = expected_place_names(domain).patches;
  patches.triangles.resize(patches.patch_names.size());
  for (std::uint32_t p = 0; p < patches.triangles.size(); ++p) patches.patch.push_back(p);
  check_group(patches, rule);
}

class PlacesOfGeometry {
 public:
  explicit PlacesOfGeometry(const Domain& domain)
      : domain_(domain),
        geometry_(*domain.geometry),
        surface_(domain.surface),
        there_(names_with_triangles(domain.surface)) {}

  Meant meant(std::string_view option, const std::string& place) const {
    if (is_name_of_other(place)) return {{place}, {}};
    Meant meant;
    const FoundShapes found = geometry_.find(place);
    for (const std::uint32_t part : found.parts) add(meant.names, patch_name(geometry_.patch_of_part(part)));
    for (const FoundLine& line : found.lines) add(meant.names, curve_of(line));
    for (const PartGroup& group : geometry_.groups())
      if (group.name == place) meant.names.insert(meant.names.end(), group.regions.begin(), group.regions.end());
    meant.points = found.points;
    const bool is_region = !named_so(surface_.region_names, place).empty();
    const bool is_empty = meant.names.empty() && meant.points.empty();
    if (is_empty && !is_region && shape_place_of(place) && patches_called(surface_.patch_names, all(), place).empty())
      throw OptionError(fmt::format(
          "`{}`: nothing is called \"{}\", and there is nothing of that kind; octafront info says what faces are",
          option, place));
    if (is_empty || is_region) meant.names.insert(meant.names.begin(), place);
    return meant;
  }

  /// All names, of which lists with commas may be made.
  std::vector<std::string> known() const {
    std::vector<std::string> names = geometry_.part_names();
    for (const PartGroup& group : geometry_.groups()) names.push_back(group.name);
    for (const auto* list : {&surface_.patch_names, &surface_.region_names})
      names.insert(names.end(), list->begin(), list->end());
    return names;
  }

  /// What the patches of the mesh will be called that lie inside at a place. Throws OptionError if none does.
  std::vector<std::string> patches_inside(const std::string& place) const {
    const auto [number, patches] = patches_of_parts(geometry_);
    const std::vector<char> is_inside = patches_with_two_sides(number, patches.size());
    if (!patches_called(patches, is_inside, place).empty()) return {place};
    std::vector<std::uint32_t> found;
    for (const std::uint32_t part : geometry_.find(place).parts)
      if (is_inside[number[part]]) found.push_back(number[part]);
    if (found.empty()) {
      check_split(divided(surface_), {place});  // says which there are
      return {place};
    }
    std::vector<std::string> names;
    for (const std::uint32_t p : found) add(names, alone(patches, patches[p]));
    return names;
  }

 private:
  std::vector<char> all() const { return std::vector<char>(surface_.patch_names.size(), 1); }
  /// A name goes before what something is like: of a region, of lines or points inside.
  bool is_name_of_other(const std::string& place) const {
    const auto has_it = [&](const auto& inside) { return inside.name == place; };
    const bool is_inside = std::ranges::any_of(domain_.wires, has_it) || std::ranges::any_of(domain_.points, has_it);
    const bool is_region = !named_so(surface_.region_names, place).empty();
    return (is_inside || is_region) && shape_place_of(place) && named_so(geometry_.part_names(), place).empty();
  }
  static void add(std::vector<std::string>& names, std::string name) {
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  }
  std::string patch_name(std::uint32_t patch) const {
    return patch == kNone ? "" : alone(geometry_.patch_names(), geometry_.patch_names()[patch]);
  }
  /// Per patch of the mesh, whether it has regions on both sides.
  std::vector<char> patches_with_two_sides(const std::vector<std::uint32_t>& number, std::size_t patches) const {
    std::vector<char> of_domain(geometry_.patch_names().size(), 0), is_inside(patches, 0);
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const Sides sides = surface_.sides_of(t);
      const std::uint32_t patch = surface_.patch_of(t);
      if (sides[0] != kNone && sides[1] != kNone && patch < of_domain.size()) of_domain[patch] = 1;
    }
    for (std::uint32_t part = 0; part < number.size(); ++part)
      if (const std::uint32_t patch = geometry_.patch_of_part(part); patch != kNone && of_domain[patch])
        is_inside[number[part]] = 1;
    return is_inside;
  }
  /// Empty where one patch has it inside.
  std::string curve_of(const FoundLine& line) const {
    std::set<std::uint32_t> patches;
    for (const std::uint32_t part : line.parts) patches.insert(geometry_.patch_of_part(part));
    patches.erase(kNone);
    std::erase_if(patches, [&](std::uint32_t p) { return !there_.contains(geometry_.patch_names()[p]); });
    const std::vector<std::uint32_t> in_order(patches.begin(), patches.end());
    return in_order.size() < 2 ? "" : curve_name(in_order, geometry_.patch_names());
  }

  const Domain& domain_;
  const TrueGeometry& geometry_;
  const SurfaceMesh& surface_;
  std::set<std::string> there_;  ///< names_with_triangles()
};

/// Sizes at places become such on patches, along curves, in regions and at points.
void take_sizes(const PlacesOfGeometry& places, SizeOptions& sizes) {
  std::vector<NamedSize> named;
  for (const NamedSize& asked : sizes.named) {
    const Meant meant = places.meant("size_of", asked.name);
    for (const std::string& name : meant.names) named.emplace_back(asked).name = name;
    for (const Vec3 p : meant.points) sizes.regions.push_back({p, p, 0, asked.size});
  }
  std::vector<NearSize> near;
  for (const NearSize& asked : sizes.near) {
    const Meant meant = asked.name.empty() ? Meant{{}, {asked.point}} : places.meant("size_near", asked.name);
    for (const std::string& name : meant.names) near.emplace_back(asked).name = name;
    for (const Vec3 p : meant.points) near.push_back({{}, p, asked.size, asked.distance});
  }
  sizes.named = std::move(named), sizes.near = std::move(near);
}

}  // namespace

SurfaceMesh divided(SurfaceMesh surface) {
  if (is_complex(surface)) divide_by_sides(surface);
  return surface;
}

Options options_for_geometry(const Domain& domain, Options options) {
  if (!options.surface.feature_angle) options.surface.feature_angle = kAngleWithinFace;
  const PlacesOfGeometry places(domain);
  const auto those = [&](std::string& list, const auto& meant) {
    std::string all;
    for (const Place& place : places_listed("on", list, ',', places.known()))
      for (const std::string& name : meant(place.text)) all += (all.empty() ? "" : ",") + name;
    list = all;
  };
  take_sizes(places, options.size);
  those(options.layers.on, [&](const std::string& place) { return places.meant("on", place).names; });
  those(options.layers.in, [&](const std::string& place) { return places.meant("in", place).names; });
  those(options.split, [&](const std::string& place) { return places.patches_inside(place); });
  for (const std::string& group : options.groups) check_group_of(domain, group_rule(group));
  return options;
}

}  // namespace octafront
