#include "pipeline/stages/named_items.h"

#include <octafront/error.h>

#include <algorithm>
#include <charconv>
#include <set>

#include <fmt/core.h>

namespace octafront {
namespace {

/// Names that a message lists at most.
constexpr std::size_t kMostNamesListed = 12;

std::uint32_t number_in(const std::vector<std::string>& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? kNone : static_cast<std::uint32_t>(at - names.begin());
}

/// Adds the items of a part; an empty list of parts: all are of part 0.
void add_of_part(std::size_t count, const std::vector<std::uint32_t>& parts, std::uint32_t part, std::size_t first,
                 std::vector<std::uint32_t>& items) {
  for (std::size_t i = 0; i < count; ++i)
    if ((parts.empty() ? 0 : parts[i]) == part) items.push_back(static_cast<std::uint32_t>(first + i));
}

void add_patch(const TetMesh& mesh, std::uint32_t patch, NamedItems& items) {
  add_of_part(mesh.boundary.size(), mesh.patch, patch, 0, items.faces);
  add_of_part(mesh.interfaces.size(), mesh.interface_patch, patch, mesh.boundary.size(), items.faces);
}

std::vector<std::uint32_t>& of_kind(NamedItems& items, NamedSet::Kind kind) {
  switch (kind) {
    case NamedSet::Kind::kNodes:
      return items.nodes;
    case NamedSet::Kind::kEdges:
      return items.edges;
    case NamedSet::Kind::kFaces:
      return items.faces;
    default:
      return items.tets;
  }
}

/// The patch of a number from 1; kNone if it is no number, or of no patch that has a face.
std::uint32_t patch_numbered(const TetMesh& mesh, const std::string& name) {
  std::uint32_t number = 0;
  const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || stop != name.data() + name.size() || number == 0) return kNone;
  NamedItems items;
  add_patch(mesh, number - 1, items);
  return items.faces.empty() ? kNone : number - 1;
}

}  // namespace

std::optional<NamedItems> items_called(const TetMesh& mesh, const std::string& name) {
  NamedItems items;
  const std::uint32_t region = number_in(mesh.region_names, name), curve = number_in(mesh.curve_names, name);
  std::uint32_t patch = number_in(mesh.patch_names, name);
  bool found = region != kNone || patch != kNone || curve != kNone;
  for (const NamedSet& set : mesh.sets) {
    if (set.name != name) continue;
    found = true;
    std::vector<std::uint32_t>& all = of_kind(items, set.kind);
    all.insert(all.end(), set.members.begin(), set.members.end());
  }
  if (!found) patch = patch_numbered(mesh, name);
  if (region != kNone) add_of_part(mesh.tets.size(), mesh.region, region, 0, items.tets);
  if (patch != kNone) add_patch(mesh, patch, items);
  if (curve != kNone) add_of_part(mesh.curve_edges.size(), mesh.curve, curve, 0, items.edges);
  return found || patch != kNone ? std::make_optional(std::move(items)) : std::nullopt;
}

void refuse_name(const TetMesh& mesh, const char* option, const std::string& name, const char* other) {
  std::set<std::string> names;
  for (const auto* list : {&mesh.region_names, &mesh.patch_names, &mesh.curve_names})
    names.insert(list->begin(), list->end());
  for (const NamedSet& set : mesh.sets) names.insert(set.name);
  names.erase("");
  std::string list;
  std::size_t listed = 0;
  for (const std::string& known : names) {
    if (listed++ == kMostNamesListed) break;
    list += (list.empty() ? "" : ", ") + known;
  }
  if (names.size() > kMostNamesListed) list += ", ...";
  throw OptionError(
      fmt::format("`{}`: \"{}\" is {}no region, patch, curve or set of the mesh, nor the number of a patch; it has {}",
                  option, name, other, list.empty() ? "no names" : list));
}

std::vector<std::string> split_at(std::string_view text, char separator) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (c == separator)
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

}  // namespace octafront
