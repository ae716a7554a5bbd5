

#include "pipeline/stages/true_shape.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "improve/curved/curved.h"
#include "improve/schedule/schedule.h"
#include "pipeline/stages/methods.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

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

void renumber_patches(Filled& filled, const std::vector<std::uint32_t>& number, std::vector<std::string> names) {
  auto& [mesh, boundary, grown, tets] = filled;
  renumber(mesh.patch, mesh.boundary.size(), number);
  renumber(mesh.interface_patch, mesh.interfaces.size(), number);
  renumber(boundary.surface.patch, boundary.surface.triangles.size(), number);
  if (grown) renumber(grown->ground.patch, grown->ground.triangles.size(), number);
  mesh.patch_names = boundary.surface.patch_names = std::move(names);
}

void take_patches_of(const TrueGeometry& geometry, Filled& filled) {
  std::vector<std::string> names = geometry.patch_names();
  const std::vector<std::uint32_t> number = renumbering(filled.mesh.patch_names, names);
  renumber_patches(filled, number, std::move(names));
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

/// Per part whether the surface has a triangle of its patch.
std::vector<char> parts_of_surface(const TrueGeometry& geometry, const SurfaceMesh& surface) {
  const std::set<std::string> patches = names_with_triangles(surface);
  std::vector<char> has;
  for (std::uint32_t part = 0; part < geometry.part_names().size(); ++part) {
    const std::uint32_t patch = geometry.patch_of_part(part);
    has.push_back(patch == kNone || patches.contains(geometry.patch_names()[patch]));
  }
  return has;
}

/// A sentence for the parts of the surface that no face of the mesh lies in; empty if there are none.
std::string parts_without_faces(const TrueGeometry& geometry, const SurfaceMesh& surface, const TetMesh& mesh) {
  constexpr std::size_t kFew = 5;
  const std::vector<std::string>& names = geometry.part_names();
  std::vector<char> is_there = parts_of_surface(geometry, surface);
  for (char& there : is_there) there = !there;
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

std::set<std::string> names_with_triangles(const SurfaceMesh& surface) {
  std::set<std::string> patches;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (const std::uint32_t p = surface.patch_of(t); p < surface.patch_names.size())
      patches.insert(surface.patch_names[p]);
  return patches;
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
  if (std::string missing = parts_without_faces(geometry, input.surface.mesh(), mesh); !missing.empty())
    run.report.stages.back().notes.push_back(std::move(missing));
  for (const PartGroup& group : geometry.groups()) {
    NamedSet set = group.parts.empty() ? elements_of(group, mesh) : faces_of(group, mesh);
    if (!set.members.empty()) mesh.sets.push_back(std::move(set));
  }
  const std::vector<PlacedSet> lines =
      add_found_shapes(geometry, places_without_names(geometry, run.options.groups, mesh), mesh);
  auto [number, names] = patches_of_parts(geometry);
  for (std::size_t p = geometry.patch_names().size(); p < mesh.patch_names.size(); ++p)
    number.push_back(static_cast<std::uint32_t>(names.size())), names.push_back(mesh.patch_names[p]);
  renumber_patches(filled, number, std::move(names));
  add_patch_curves(mesh);
  add_placed_sets(mesh, lines);
}

MeshPatches patches_of_parts(const TrueGeometry& geometry) {
  MeshPatches made;
  std::map<std::string, std::uint32_t> known;
  for (const std::string& name : geometry.part_names()) {
    const auto [at, is_new] = known.try_emplace(name, static_cast<std::uint32_t>(made.names.size()));
    made.number.push_back(at->second);
    if (is_new) made.names.push_back(name);
  }
  return made;
}

MeshPatches patches_in_mesh(const SurfaceMesh& surface, const TrueGeometry* geometry) {
  std::size_t patches = std::max<std::size_t>(1, surface.patch_names.size());
  for (const std::uint32_t p : surface.patch) patches = std::max<std::size_t>(patches, p + 1);
  MeshPatches made;
  for (std::uint32_t p = 0; p < patches; ++p) {
    std::string name = p < surface.patch_names.size() ? surface.patch_names[p] : std::string();
    if (geometry != nullptr && !holds(geometry->part_names(), name)) {
      // Told apart where it was that of several patches of the geometry.
      const std::string of_several = name.substr(0, name.rfind('#'));
      if (holds(geometry->part_names(), of_several)) name = of_several;
    }
    const auto known = geometry != nullptr ? std::ranges::find(made.names, name) : made.names.end();
    made.number.push_back(static_cast<std::uint32_t>(known - made.names.begin()));
    if (known == made.names.end()) made.names.push_back(std::move(name));
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
