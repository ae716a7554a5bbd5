#include "pipeline/stages/true_shape.h"

#include <octafront/error.h>
#include <octafront/named_groups.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"
#include "base/mesh/curve_names.h"
#include "base/places/places.h"
#include "base/places/shape_place.h"
#include "improve/curved/curved.h"
#include "improve/schedule/schedule.h"
#include "pipeline/stages/found_shapes.h"
#include "pipeline/stages/methods.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Degrees: within a face only such edges are features.
constexpr double kAngleWithinFace = 80;

/// From one numbering of patches to another, by their names; those that have no name there come behind it.
std::vector<std::uint32_t> renumbering(const std::vector<std::string>& from, std::vector<std::string>& to) {
  std::vector<std::uint32_t> number;
  const std::size_t known = to.size();
  for (const std::string& name : from) {
    const auto last = to.begin() + static_cast<std::ptrdiff_t>(known), there = std::find(to.begin(), last, name);
    number.push_back(static_cast<std::uint32_t>(there != last ? there - to.begin() : std::ssize(to)));
    if (there == last) to.push_back(name);
  }
  return number;
}

void renumber(std::vector<std::uint32_t>& patch, std::size_t faces, const std::vector<std::uint32_t>& number) {
  patch.resize(faces);
  for (std::uint32_t& p : patch)
    if (p < number.size()) p = number[p];
}

void take_patches_of(const TrueGeometry& geometry, Filled& filled) {
  auto& [mesh, boundary, grown, tets] = filled;
  std::vector<std::string> names = geometry.patch_names();
  const std::vector<std::uint32_t> number = renumbering(mesh.patch_names, names);
  renumber(mesh.patch, mesh.boundary.size(), number);
  renumber(mesh.interface_patch, mesh.interfaces.size(), number);
  renumber(boundary.surface.patch, boundary.surface.triangles.size(), number);
  if (grown) renumber(grown->ground.patch, grown->ground.triangles.size(), number);
  mesh.patch_names = boundary.surface.patch_names = std::move(names);
}

/// Patches of no geometry come behind the parts.
void name_parts_of(const TrueGeometry& geometry, const std::vector<Vec3>& points,
                   const std::vector<Triangle>& triangles, std::vector<std::uint32_t>& patch) {
  const auto known = static_cast<std::uint32_t>(geometry.patch_names().size());
  const auto parts = static_cast<std::uint32_t>(geometry.part_names().size());
  parallel_for(triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = triangles[t];
    patch[t] = patch[t] < known ? geometry.part_at(patch[t], centroid(points[a], points[b], points[c]))
                                : parts + (patch[t] - known);
  });
}

template <class Items, class Item>
bool holds(const Items& items, const Item& item) {
  return std::find(items.begin(), items.end(), item) != items.end();
}

/// What a place means before the mesh is made: patches, curves and regions of the domain by names that mean them alone,
/// and points.
struct Meant {
  std::vector<std::string> names;
  std::vector<Vec3> points;
};

/// The patches that a mesh has of its parts: those of one name are one.
std::vector<std::string> names_of_patches(const TrueGeometry& geometry) {
  std::vector<std::string> names;
  std::set<std::string> known;
  for (const std::string& name : geometry.part_names())
    if (known.insert(name).second) names.push_back(name);
  return names;
}

std::uint32_t number_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::uint32_t>(std::ranges::find(names, name) - names.begin());
}

/// Refuses a group by patches that the mesh will not have.
void check_group_of(const TrueGeometry& geometry, const GroupRule& rule) {
  SurfaceMesh patches;
  patches.patch_names = names_of_patches(geometry);
  patches.triangles.resize(patches.patch_names.size());
  for (std::uint32_t p = 0; p < patches.triangles.size(); ++p) patches.patch.push_back(p);
  check_group(patches, rule);
}

class PlacesOfGeometry {
 public:
  explicit PlacesOfGeometry(const Domain& domain) : geometry_(*domain.geometry), surface_(domain.surface) {}

  Meant meant(std::string_view option, const std::string& place) const {
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
  std::vector<std::string> patches_inside(std::string_view option, const std::string& place) const {
    const std::vector<std::string> patches = names_of_patches(geometry_);
    const std::vector<char> is_inside = parts_inside(patches);
    if (!patches_called(patches, is_inside, place).empty()) return {place};
    std::vector<std::uint32_t> found;
    for (const std::uint32_t part : geometry_.find(place).parts)
      if (const std::uint32_t p = number_of(patches, geometry_.part_names()[part]); is_inside[p]) found.push_back(p);
    if (found.empty()) patches_called(option, patches, is_inside, place);  // says which there are
    std::vector<std::string> names;
    for (const std::uint32_t p : found) add(names, alone(patches, patches[p]));
    return names;
  }

 private:
  std::vector<char> all() const { return std::vector<char>(surface_.patch_names.size(), 1); }
  static void add(std::vector<std::string>& names, std::string name) {
    if (!name.empty() && !holds(names, name)) names.push_back(std::move(name));
  }
  std::string patch_name(std::uint32_t patch) const {
    return patch == kNone ? "" : alone(geometry_.patch_names(), geometry_.patch_names()[patch]);
  }
  /// Per patch of the mesh, whether it has regions on both sides.
  std::vector<char> parts_inside(const std::vector<std::string>& patches) const {
    std::vector<char> of_domain(geometry_.patch_names().size(), 0), is_inside(patches.size(), 0);
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const Sides sides = surface_.sides_of(t);
      const std::uint32_t patch = surface_.patch_of(t);
      if (sides[0] != kNone && sides[1] != kNone && patch < of_domain.size()) of_domain[patch] = 1;
    }
    for (std::uint32_t part = 0; part < geometry_.part_names().size(); ++part)
      if (const std::uint32_t patch = geometry_.patch_of_part(part); patch != kNone && of_domain[patch])
        is_inside[number_of(patches, geometry_.part_names()[part])] = 1;
    return is_inside;
  }
  /// Empty where one patch has it inside.
  std::string curve_of(const FoundLine& line) const {
    std::set<std::uint32_t> patches;
    for (const std::uint32_t part : line.parts) patches.insert(geometry_.patch_of_part(part));
    patches.erase(kNone);
    const std::vector<std::uint32_t> in_order(patches.begin(), patches.end());
    return in_order.size() < 2 ? "" : curve_name(in_order, geometry_.patch_names());
  }

  const TrueGeometry& geometry_;
  const SurfaceMesh& surface_;
};

/// The faces of the mesh by boundary, then interfaces, whose part is one of the group's.
NamedSet faces_of(const PartGroup& group, const TetMesh& mesh) {
  NamedSet set{group.name, NamedSet::Kind::kFaces, {}};
  std::uint32_t number = 0;
  for (const auto* parts : {&mesh.patch, &mesh.interface_patch})
    for (const std::uint32_t part : *parts) {
      if (std::binary_search(group.parts.begin(), group.parts.end(), part)) set.members.push_back(number);
      ++number;
    }
  return set;
}

NamedSet elements_of(const PartGroup& group, const TetMesh& mesh) {
  NamedSet set{group.name, NamedSet::Kind::kElements, {}};
  std::vector<char> is_in(std::max<std::size_t>(1, mesh.region_names.size()), 0);
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r) is_in[r] = holds(group.regions, mesh.region_names[r]);
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    const std::uint32_t r = mesh.region.empty() ? 0 : mesh.region[t];
    if (r < is_in.size() && is_in[r]) set.members.push_back(t);
  }
  return set;
}

/// A sentence for the parts that no face of the mesh lies in; empty if there are none.
std::string parts_without_faces(const std::vector<std::string>& names, const TetMesh& mesh) {
  constexpr std::size_t kFew = 5;
  std::vector<char> is_there(names.size(), 0);
  for (const auto* parts : {&mesh.patch, &mesh.interface_patch})
    for (const std::uint32_t part : *parts)
      if (part < names.size()) is_there[part] = 1;
  std::size_t missing = 0;
  std::string listed;
  for (std::size_t part = 0; part < names.size(); ++part) {
    if (is_there[part]) continue;
    if (++missing <= kFew) listed += (missing > 1 ? ", " : "") + names[part];
  }
  if (missing == 0) return "";
  return fmt::format("{} of {} faces have no elements of their own, for they are narrower, or of no solid ({}{})",
                     missing, names.size(), listed, missing > kFew ? ", ..." : "");
}

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
  those(options.split, [&](const std::string& place) { return places.patches_inside("split", place); });
  for (const std::string& group : options.groups) check_group_of(*domain.geometry, group_rule(group));
  return options;
}

void place_on_geometry(const Prepared& input, Filled& filled, Run& run) {
  if (!input.geometry) return;
  name_patches(input, filled);  // What repair closed lies on no face.
  take_patches_of(*input.geometry, filled);
  if (keeps_surface(run.options)) return;
  run.stage("true geometry", [&](const Stage& stage) {
    TetMesh& mesh = filled.mesh;
    const SecondOrderSummary made = on_ground(
        filled, [&] { return move_to_geometry(mesh, *input.geometry, vertices_below(filled), stage.context()); });
    std::copy_n(mesh.points.begin(), filled.boundary.surface.points.size(), filled.boundary.surface.points.begin());
    if (made.moved > 0 && !filled.layers) relieve_mesh(mesh, run.options.improve, stage);
    stage.count("vertices moved", static_cast<double>(made.moved));
    stage.count("vertices held", static_cast<double>(made.held));
    if (made.held > 0)
      stage.note(fmt::format(
          "{} vertices stay beside the true geometry: elements would turn inside out, or it is too far", made.held));
  });
}

void name_parts(const Prepared& input, Filled& filled, Run& run) {
  if (!input.geometry) return;
  auto& [mesh, boundary, grown, tets] = filled;
  name_parts_of(*input.geometry, mesh.points, mesh.boundary, mesh.patch);
  name_parts_of(*input.geometry, mesh.points, mesh.interfaces, mesh.interface_patch);
  name_parts_of(*input.geometry, mesh.points, boundary.surface.triangles, boundary.surface.patch);
  if (grown) name_parts_of(*input.geometry, mesh.points, grown->ground.triangles, grown->ground.patch);
  const TrueGeometry& geometry = *input.geometry;
  if (std::string missing = parts_without_faces(geometry.part_names(), mesh); !missing.empty())
    run.report.stages.back().notes.push_back(std::move(missing));
  for (const PartGroup& group : geometry.groups()) {
    NamedSet set = group.parts.empty() ? elements_of(group, mesh) : faces_of(group, mesh);
    if (!set.members.empty()) mesh.sets.push_back(std::move(set));
  }
  const std::vector<PlacedSet> lines =
      add_found_shapes(geometry, places_without_names(geometry, run.options.groups, mesh), mesh);
  std::vector<std::string> names = names_of_patches(geometry);
  std::vector<std::uint32_t> number;
  for (const std::string& name : geometry.part_names()) number.push_back(number_of(names, name));
  for (std::size_t p = geometry.patch_names().size(); p < mesh.patch_names.size(); ++p)
    number.push_back(static_cast<std::uint32_t>(names.size())), names.push_back(mesh.patch_names[p]);
  renumber(mesh.patch, mesh.boundary.size(), number);
  renumber(mesh.interface_patch, mesh.interfaces.size(), number);
  renumber(boundary.surface.patch, boundary.surface.triangles.size(), number);
  if (grown) renumber(grown->ground.patch, grown->ground.triangles.size(), number);
  mesh.patch_names = boundary.surface.patch_names = std::move(names);
  add_patch_curves(mesh);
  add_placed_sets(mesh, lines);
}

MeshPatches patches_in_mesh(const SurfaceMesh& surface, const TrueGeometry* geometry) {
  std::uint32_t patches = std::max(1u, static_cast<std::uint32_t>(surface.patch_names.size()));
  for (const std::uint32_t p : surface.patch) patches = std::max(patches, p + 1);
  MeshPatches made{{}, surface.patch_names};
  made.names.resize(patches);
  for (std::uint32_t p = 0; p < patches; ++p) {
    std::string& name = made.names[p];
    // Told apart where it was that of several patches of the geometry.
    if (geometry != nullptr && !name.empty() && !holds(geometry->part_names(), name)) {
      const std::string of_several = name.substr(0, name.rfind('#'));
      if (holds(geometry->part_names(), of_several)) name = of_several;
    }
    made.number.push_back(name.empty() ? p : number_of(made.names, name));
  }
  return made;
}

void describe_true_volumes(const Filled& filled, const Domain& domain, Report& report) {
  if (domain.true_volumes.empty()) return;
  const std::vector<double> made = curved_volumes(filled.mesh);
  const std::vector<double> of_layers = layers_volumes(filled, made);
  report.volume = report.true_volume = 0;
  for (std::size_t r = 0; r < domain.true_volumes.size() && r < made.size(); ++r) {
    report.volume += made[r] + of_layers[r];
    report.true_volume += domain.true_volumes[r];
    if (report.regions.empty()) continue;
    report.regions[r].volume = made[r];
    report.regions[r].layers_volume = of_layers[r];
    report.regions[r].true_volume = domain.true_volumes[r];
  }
}

}  // namespace octafront
