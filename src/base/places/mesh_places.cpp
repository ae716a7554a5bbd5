#include <octafront/error.h>

#include "base/core/wording.h"
#include "base/places/places.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/core.h>

namespace octafront {
namespace {

/// The number of the part without a name that is called so, "curve_4".
std::vector<std::uint32_t> number_of_label(const std::vector<std::string>& names, const std::string& prefix,
                                           const std::string& label, std::uint32_t parts) {
  for (std::uint32_t i = 0; i < parts; ++i)
    if ((i >= names.size() || names[i].empty()) && label == fmt::format("{}_{}", prefix, i + 1)) return {i};
  return {};
}

/// One more than the largest number; an empty list of parts: all are of part 0.
std::uint32_t parts_in(std::size_t count, const std::vector<std::uint32_t>& parts) {
  return count == 0 ? 0 : parts.empty() ? 1 : 1 + *std::ranges::max_element(parts);
}

/// Adds the items of parts.
void add_of_parts(std::size_t count, const std::vector<std::uint32_t>& parts, const std::vector<std::uint32_t>& wanted,
                  std::size_t first, std::vector<std::uint32_t>& items) {
  if (wanted.empty()) return;
  for (std::size_t i = 0; i < count; ++i)
    if (std::ranges::find(wanted, parts.empty() ? 0 : parts[i]) != wanted.end())
      items.push_back(static_cast<std::uint32_t>(first + i));
}

void add_patches(const TetMesh& mesh, const std::vector<std::uint32_t>& patches, MeshItems& items) {
  add_of_parts(mesh.boundary.size(), mesh.patch, patches, 0, items.faces);
  add_of_parts(mesh.interfaces.size(), mesh.interface_patch, patches, mesh.boundary.size(), items.faces);
}

std::vector<char> patches_with_faces(const TetMesh& mesh) {
  std::vector<char> is_there(
      std::max(parts_in(mesh.boundary.size(), mesh.patch), parts_in(mesh.interfaces.size(), mesh.interface_patch)));
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) is_there[mesh.patch.empty() ? 0 : mesh.patch[f]] = 1;
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f)
    is_there[mesh.interface_patch.empty() ? 0 : mesh.interface_patch[f]] = 1;
  return is_there;
}

std::vector<std::uint32_t>& of_kind(MeshItems& items, NamedSet::Kind kind) {
  const std::array all{&items.nodes, &items.edges, &items.faces, &items.tets};
  return *all[static_cast<std::size_t>(kind)];
}

std::vector<NamesOfKind> names_in(const TetMesh& mesh) {
  const PlaceNames names = place_names(mesh);
  return {{"region", names.regions}, {"patch", names.patches}, {"curve", names.curves}, {"set", names.sets}};
}

/// All that is called so: by name before by number.
MeshItems items_called(const TetMesh& mesh, std::string_view option, const std::string& name) {
  MeshItems items;
  std::vector<std::uint32_t> regions = named_so(mesh.region_names, name), curves = named_so(mesh.curve_names, name),
                             patches = named_so(mesh.patch_names, name);
  bool found = !regions.empty() || !curves.empty() || !patches.empty();
  for (const NamedSet& set : mesh.sets) {
    if (set.name != name) continue;
    found = true;
    std::vector<std::uint32_t>& all = of_kind(items, set.kind);
    all.insert(all.end(), set.members.begin(), set.members.end());
  }
  if (!found) {
    const std::uint32_t bodies = parts_in(mesh.tets.size(), mesh.region);
    patches = patches_called(mesh.patch_names, patches_with_faces(mesh), name);
    regions = number_of_label(mesh.region_names, "body", bodies == 1 && name == "body" ? "body_1" : name, bodies);
    curves = number_of_label(mesh.curve_names, "curve", name, parts_in(mesh.curve_edges.size(), mesh.curve));
    if (regions.empty() && curves.empty() && patches.empty())
      throw OptionError(fmt::format("`{}`: {}", option, no_such_place(name, names_in(mesh))));
  }
  add_of_parts(mesh.tets.size(), mesh.region, regions, 0, items.tets);
  add_patches(mesh, patches, items);
  add_of_parts(mesh.curve_edges.size(), mesh.curve, curves, 0, items.edges);
  return items;
}

template <class Rows>
void add_rows_within(const Rows& rows, const std::vector<bool>& inside, std::size_t first,
                     std::vector<std::uint32_t>& members) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (std::ranges::all_of(rows[i], [&](VertexIndex v) { return inside[v]; }))
      members.push_back(static_cast<std::uint32_t>(first + i));
}

template <class IsIn>
MeshItems items_within(const TetMesh& mesh, const IsIn& is_in) {
  MeshItems items;
  std::vector<bool> inside(mesh.points.size());
  for (VertexIndex v = 0; v < inside.size(); ++v) {
    inside[v] = is_in(mesh.points[v]);
    if (inside[v]) items.nodes.push_back(v);
  }
  add_rows_within(mesh.tets, inside, 0, items.tets);
  add_rows_within(mesh.curve_edges, inside, 0, items.edges);
  add_rows_within(mesh.boundary, inside, 0, items.faces);
  add_rows_within(mesh.interfaces, inside, mesh.boundary.size(), items.faces);
  return items;
}

}  // namespace

PlaceNames place_names(const TetMesh& mesh) {
  PlaceNames names;
  const std::uint32_t regions = parts_in(mesh.tets.size(), mesh.region);
  for (std::uint32_t r = 0; r < regions; ++r)
    names.regions.push_back(region_label(r < mesh.region_names.size() ? mesh.region_names[r] : "", r, regions));
  const std::vector<char> is_there = patches_with_faces(mesh);
  for (std::uint32_t p = 0; p < is_there.size(); ++p)
    if (is_there[p]) names.patches.push_back(patch_label(mesh.patch_names, p));
  for (std::uint32_t c = 0; c < parts_in(mesh.curve_edges.size(), mesh.curve); ++c)
    names.curves.push_back(c < mesh.curve_names.size() && !mesh.curve_names[c].empty()
                               ? mesh.curve_names[c]
                               : fmt::format("curve_{}", c + 1));
  std::set<std::string> sets;
  for (const NamedSet& set : mesh.sets) sets.insert(set.name);
  names.sets.assign(sets.begin(), sets.end());
  for (const OpenedContact& contact : mesh.opened_contacts)
    for (const std::uint32_t side : {contact.first, contact.second})
      names.contacts.push_back(patch_label(mesh.patch_names, side));
  return names;
}

MeshItems items_at(const TetMesh& mesh, std::string_view option, const Place& place) {
  if (const auto* name = std::get_if<std::string>(&place.where)) return items_called(mesh, option, *name);
  if (const auto* box = std::get_if<Box3>(&place.where))
    return items_within(mesh, [&](Vec3 p) { return box->contains(p); });
  if (const auto* ball = std::get_if<GroupRule::Sphere>(&place.where))
    return items_within(mesh, [&](Vec3 p) { return squared_length(p - ball->center) <= ball->radius * ball->radius; });
  MeshItems items;
  const std::vector<char> is_there = patches_with_faces(mesh);
  std::vector<std::uint32_t> all;
  for (const std::string& name : std::get<std::vector<std::string>>(place.where)) {
    const std::vector<std::uint32_t> patches = patches_called(option, mesh.patch_names, is_there, name);
    all.insert(all.end(), patches.begin(), patches.end());
  }
  add_patches(mesh, all, items);
  return items;
}

}  // namespace octafront
