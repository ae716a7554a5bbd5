#include "pipeline/stages/true_shape.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"
#include "base/places/places.h"
#include "improve/curved/curved.h"
#include "improve/schedule/schedule.h"
#include "pipeline/stages/methods.h"

#include <algorithm>
#include <cmath>

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

/// The patches and regions that are meant by the name of a part or a group.
std::vector<std::string> names_behind(const TrueGeometry& geometry, const std::string& name) {
  std::vector<std::string> names;
  const auto add_part = [&](std::uint32_t part) {
    const std::uint32_t patch = geometry.patch_of_part(part);
    if (patch < geometry.patch_names().size() && !holds(names, geometry.patch_names()[patch]))
      names.push_back(geometry.patch_names()[patch]);
  };
  for (const PartGroup& group : geometry.groups()) {
    if (group.name != name) continue;
    for (const std::uint32_t part : group.parts) add_part(part);
    names.insert(names.end(), group.regions.begin(), group.regions.end());
  }
  for (std::uint32_t part = 0; part < geometry.part_names().size(); ++part)
    if (geometry.part_names()[part] == name) add_part(part);
  return names;
}

/// What names_behind() knows.
std::vector<std::string> names_of_places(const TrueGeometry& geometry) {
  std::vector<std::string> names = geometry.part_names();
  for (const PartGroup& group : geometry.groups()) names.push_back(group.name);
  return names;
}

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

}  // namespace

Options options_for_geometry(const Domain& domain, Options options) {
  if (!options.surface.feature_angle) options.surface.feature_angle = kAngleWithinFace;
  const auto meant = [&](const std::string& name) {
    std::vector<std::string> names;
    if (!name.empty()) names = names_behind(*domain.geometry, name);
    if (names.empty() || holds(domain.surface.region_names, name)) names.insert(names.begin(), name);
    return names;
  };
  const auto each = [&](auto& list) {
    std::remove_reference_t<decltype(list)> all;
    for (const auto& asked : list)
      for (std::string& name : meant(asked.name)) all.emplace_back(asked).name = std::move(name);
    list = std::move(all);
  };
  const auto those = [&](std::string& list) {
    std::vector<std::string> known = names_of_places(*domain.geometry);
    for (const auto* names : {&domain.surface.patch_names, &domain.surface.region_names})
      known.insert(known.end(), names->begin(), names->end());
    std::string all;
    for (const Place& place : places_listed("on", list, ',', known))
      for (const std::string& name : meant(place.text)) all += (all.empty() ? "" : ",") + name;
    list = all;
  };
  each(options.size.named), each(options.size.near);
  those(options.layers.on), those(options.layers.in);
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
  std::vector<std::string> names = input.geometry->part_names();
  if (std::string missing = parts_without_faces(names, mesh); !missing.empty())
    run.report.stages.back().notes.push_back(std::move(missing));
  const auto known = static_cast<std::ptrdiff_t>(input.geometry->patch_names().size());
  names.insert(names.end(), mesh.patch_names.begin() + known, mesh.patch_names.end());
  mesh.patch_names = boundary.surface.patch_names = std::move(names);
  for (const PartGroup& group : input.geometry->groups()) {
    NamedSet set = group.parts.empty() ? elements_of(group, mesh) : faces_of(group, mesh);
    if (!set.members.empty()) mesh.sets.push_back(std::move(set));
  }
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
