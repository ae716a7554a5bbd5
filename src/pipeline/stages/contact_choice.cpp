#include "pipeline/stages/contact_choice.h"

#include <octafront/error.h>
#include <octafront/split.h>

#include "base/geometry/true_geometry.h"
#include "base/mesh/complex.h"
#include "base/mesh/complex_patches.h"
#include "base/places/places.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace octafront {
namespace {

/// What a patch of the surface that is meshed is called in the mesh: of CAD by its faces.
std::vector<std::string> names_in_mesh(const TrueGeometry* geometry, const std::string& patch) {
  std::vector<std::string> names;
  if (geometry == nullptr) return {patch};
  const std::vector<std::string>& patches = geometry->patch_names();
  const auto number = static_cast<std::uint32_t>(std::ranges::find(patches, patch) - patches.begin());
  for (std::uint32_t part = 0; part < geometry->part_names().size(); ++part)
    if (geometry->patch_of_part(part) == number) names.push_back(geometry->part_names()[part]);
  return names.empty() ? std::vector{patch} : names;
}

std::vector<PartContact> contacts_in(const SurfaceMesh& divided, const TrueGeometry* geometry) {
  std::set<std::pair<std::uint32_t, Sides>> found;
  for (std::size_t t = 0; t < divided.triangles.size(); ++t) {
    const auto [front, behind] = divided.sides_of(t);
    if (front != kNone && behind != kNone && front != behind)
      found.insert({divided.patch_of(t), {std::min(front, behind), std::max(front, behind)}});
  }
  std::set<std::pair<std::string, Sides>> named;
  for (const auto& [patch, sides] : found)
    for (std::string& name : names_in_mesh(geometry, divided.patch_names[patch]))
      named.insert({std::move(name), sides});
  std::vector<PartContact> contacts;
  for (const auto& [name, sides] : named) contacts.push_back({name, sides});
  return contacts;
}

/// Which contacts a rule means, by their numbers.
std::vector<std::uint32_t> meant(const std::string& rule, const std::vector<PartContact>& contacts,
                                 const std::vector<std::string>& regions) {
  std::vector<std::string> names;
  for (const PartContact& contact : contacts) names.push_back(contact.name);
  std::vector<std::uint32_t> found = named_so(names, rule);
  for (std::uint32_t c = 0; c < contacts.size(); ++c) {
    const std::string &a = regions[contacts[c].regions[0]], &b = regions[contacts[c].regions[1]];
    if (rule == a || rule == b || rule == a + "|" + b || rule == b + "|" + a) found.push_back(c);
  }
  return found;
}

[[noreturn]] void refuse(const std::string& rule, const std::vector<PartContact>& contacts) {
  std::vector<std::string> names;
  for (const PartContact& contact : contacts) names.push_back(contact.name);
  throw OptionError(fmt::format("`contact`: {}", no_such_place(rule, {{"contact", names}})));
}

}  // namespace

std::vector<PartContact> contacts_of(const Domain& domain) {
  if (domain.contacts.is_shared()) return {};
  SurfaceMesh divided = domain.surface;
  if (is_complex(divided)) divide_by_sides(divided);
  std::vector<PartContact> contacts = contacts_in(divided, domain.geometry.get());
  std::vector<std::string> regions;
  for (std::uint32_t r = 0; r < region_count(divided); ++r) regions.push_back(region_name(divided, r));
  for (PartContact& contact : contacts) contact.way = domain.contacts.all;
  for (const ContactChoice::Rule& rule : domain.contacts.rules) {
    const std::vector<std::uint32_t> found = meant(rule.contact, contacts, regions);
    if (found.empty()) refuse(rule.contact, contacts);
    for (const std::uint32_t c : found) contacts[c].way = rule.way;
  }
  return contacts;
}

void open_contacts(const Domain& domain, TetMesh& mesh, const Stage& stage) {
  std::set<std::string> shared;
  for (const PartContact& contact : contacts_of(domain))
    if (contact.way == ContactWay::kShared) shared.insert(contact.name);
  std::vector<std::uint32_t> opened = contacts_of(mesh);
  if (opened.empty() && domain.contacts.all != ContactWay::kShared)
    stage.note("no two parts touch, and there is no contact to open");
  std::erase_if(opened, [&](std::uint32_t patch) {
    return patch < mesh.patch_names.size() && shared.contains(mesh.patch_names[patch]);
  });
  for (std::string& note : split_contacts(mesh, opened)) stage.note(std::move(note));
}

bool come_apart(const std::vector<PartContact>& contacts) {
  return std::ranges::any_of(contacts, [](const PartContact& c) { return c.way == ContactWay::kSeparate; });
}

}  // namespace octafront
