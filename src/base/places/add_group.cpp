#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/split.h>
#include <octafront/surface_mesh.h>

#include "base/mesh/complex.h"
#include "base/mesh/complex_patches.h"
#include "base/places/places.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {
namespace {

using Kind = NamedSet::Kind;

/// Adds what a set of this kind has of the items, if there is any.
bool add_set(TetMesh& mesh, const std::string& name, Kind kind, std::vector<std::uint32_t> members) {
  if (members.empty()) return false;
  std::ranges::sort(members);
  members.erase(std::unique(members.begin(), members.end()), members.end());
  mesh.sets.push_back({name, kind, std::move(members)});
  return true;
}

bool add_in_space(TetMesh& mesh, const GroupRule& rule, const Place& place) {
  MeshItems items = items_at(mesh, "group", place);
  switch (rule.kind) {
    case Kind::kNodes:
      return add_set(mesh, rule.name, rule.kind, std::move(items.nodes));
    case Kind::kEdges:
      return add_set(mesh, rule.name, rule.kind, std::move(items.edges));
    case Kind::kFaces:
      return add_set(mesh, rule.name, rule.kind, std::move(items.faces));
    default:
      return add_set(mesh, rule.name, rule.kind, std::move(items.tets));
  }
}

bool add_all(TetMesh& mesh, const std::string& name, MeshItems all) {
  bool added = add_set(mesh, name, Kind::kNodes, std::move(all.nodes));
  added |= add_set(mesh, name, Kind::kEdges, std::move(all.edges));
  added |= add_set(mesh, name, Kind::kFaces, std::move(all.faces));
  return add_set(mesh, name, Kind::kElements, std::move(all.tets)) || added;
}

/// All that is called so, whatever it is. What the mesh has not is said in `unknown`.
bool add_named(TetMesh& mesh, const std::string& name, const Place& place, std::string& unknown) {
  try {
    return add_all(mesh, name, items_at(mesh, "group", place));
  } catch (const OptionError& error) {
    const std::string text = error.what();  // "`group`: there is no ..."
    unknown = text.substr(text.find(": ") + 2);
    return false;
  }
}

}  // namespace

GroupRule group_rule(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto refuse = [&](const std::string& why) {
    throw OptionError(
        fmt::format("`group`: \"{}\" {}; write NAME=PLACE, such as NAME=box:X0,Y0,Z0,X1,Y1,Z1, "
                    "NAME=sphere:X,Y,Z,R, NAME=patches:A,B, or NAME=elements:box:... and NAME=faces:box:...",
                    text, why));
  };
  if (equals == 0 || equals == std::string::npos) refuse("has no name");
  GroupRule rule{text.substr(0, equals), Kind::kNodes, {}};
  std::string where = text.substr(equals + 1);
  bool has_kind = false;
  for (const auto& [prefix, kind] : {std::pair<std::string_view, Kind>{"nodes:", Kind::kNodes},
                                     {"faces:", Kind::kFaces},
                                     {"elements:", Kind::kElements}}) {
    if (has_kind || !where.starts_with(prefix)) continue;
    rule.kind = kind, has_kind = true;
    where.erase(0, prefix.size());
  }
  const Place place = place_of("group", where);
  if (const auto* name = std::get_if<std::string>(&place.where)) {
    if (where.empty()) refuse("does not say where it is");
    if (has_kind) refuse("asks for one kind of what has a name, and gets all: leave the kind out");
    if (where.find(':') != std::string::npos)
      refuse(
          fmt::format("has \"{}\" where box, sphere, patches or a name should be", where.substr(0, where.find(':'))));
    rule.where = *name;
  }
  if (const auto* names = std::get_if<std::vector<std::string>>(&place.where)) rule.where = *names;
  if (const auto* box = std::get_if<Box3>(&place.where)) rule.where = *box;
  if (const auto* ball = std::get_if<GroupRule::Sphere>(&place.where)) rule.where = *ball;
  return rule;
}

void check_group(const SurfaceMesh& surface, const GroupRule& rule) {
  const auto* wanted = std::get_if<std::vector<std::string>>(&rule.where);
  if (wanted == nullptr) return;
  SurfaceMesh divided = surface;
  if (is_complex(divided)) divide_by_sides(divided);
  std::vector<char> is_there(1);
  for (std::uint32_t t = 0; t < divided.triangles.size(); ++t) {
    const std::uint32_t patch = divided.patch_of(t);
    is_there.resize(std::max<std::size_t>(is_there.size(), patch + 1));
    is_there[patch] = 1;
  }
  for (const std::string& name : *wanted)
    if (!is_made_later(name)) patches_called("group", divided.patch_names, is_there, without_sides(name));
}

std::string add_group(TetMesh& mesh, const GroupRule& rule) {
  std::string unknown;
  bool added = false;
  if (const auto* box = std::get_if<Box3>(&rule.where))
    added = add_in_space(mesh, rule, {"", *box});
  else if (const auto* ball = std::get_if<GroupRule::Sphere>(&rule.where))
    added = add_in_space(mesh, rule, {"", *ball});
  else if (const auto* name = std::get_if<std::string>(&rule.where))
    added = add_named(mesh, rule.name, {*name, *name}, unknown);
  else
    added = add_all(mesh, rule.name, items_at(mesh, "group", {"", std::get<std::vector<std::string>>(rule.where)}));
  if (!unknown.empty()) return fmt::format("group \"{}\": {}; it is left out", rule.name, unknown);
  return added ? std::string() : fmt::format("group \"{}\": nothing lies there; it is left out", rule.name);
}

}  // namespace octafront
