#include "cad/shapes/names.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Their own names; without one "KIND N", N from 1, which no other one has of its own.
template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& items, const std::string& kind) {
  std::set<std::string> taken;
  for (const Item& item : items) taken.insert(item.labels.name);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::string name = items[i].labels.name;
    const std::string number = kind + " " + std::to_string(i + 1);
    if (name.empty()) name = number;
    for (int k = 2; items[i].labels.name.empty() && taken.contains(name); ++k) name = number + "#" + std::to_string(k);
    names.push_back(std::move(name));
  }
  return names;
}

/// The solids at a face, ascending; kNone: one of them, or both, is none.
using Pair = std::pair<std::uint32_t, std::uint32_t>;
Pair pair_of(const Face& face) {
  return std::minmax(face.sides[0], face.sides[1]);
}

bool is_contact(const Face& face) {
  const auto [a, b] = pair_of(face);
  return a != b && b != kNone;
}

/// "plate|bolt", or the one solid.
std::string solids_in_words(Pair pair, const std::vector<std::string>& solids) {
  if (pair.first == kNone) return "";
  return pair.second == kNone || pair.second == pair.first ? solids[pair.first]
                                                           : solids[pair.first] + "|" + solids[pair.second];
}

/// Names of the file that faces between several pairs of solids have, and those pairs.
std::map<std::string, std::set<Pair>> pairs_of_names(const CadModel& model) {
  std::map<std::string, std::set<Pair>> pairs;
  for (const Face& face : model.faces)
    if (!face.labels.name.empty() && pair_of(face).first != kNone) pairs[face.labels.name].insert(pair_of(face));
  return pairs;
}

/// What the labels of an item are called.
std::vector<std::string> label_names(const Labels& labels) {
  std::vector<std::string> names;
  if (labels.colour) {
    const auto [red, green, blue] = *labels.colour;
    names.push_back(fmt::format("color #{:02x}{:02x}{:02x}", red, green, blue));
  }
  if (!labels.layer.empty()) names.push_back("layer " + labels.layer);
  return names;
}

/// What all contacts are called whose faces have no names.
std::set<std::string> names_of_contacts(const CadModel& model, const std::vector<std::string>& solids) {
  std::set<std::string> names;
  for (const Face& face : model.faces)
    if (is_contact(face)) names.insert(solids_in_words(pair_of(face), solids));
  return names;
}

/// "plate|bolt#2", or the next number: the solid "bolt#2" may touch the plate, too.
std::string next_piece(const std::string& contact, std::set<std::string>& taken) {
  int n = 2;
  while (!taken.insert(contact + "#" + std::to_string(n)).second) ++n;
  return contact + "#" + std::to_string(n);
}

}  // namespace

std::vector<std::string> all_different(std::vector<std::string> names) {
  const std::set<std::string> taken(names.begin(), names.end());
  std::set<std::string> given;
  for (std::string& name : names) {
    const std::string first = name;
    for (int k = 2; given.contains(name) || (name != first && taken.contains(name)); ++k)
      name = first + "#" + std::to_string(k);
    given.insert(name);
  }
  return names;
}

std::vector<std::string> face_names(const CadModel& model) {
  const std::vector<std::string> solids = solid_names(model);
  const std::map<std::string, std::set<Pair>> pairs = pairs_of_names(model);
  std::map<std::pair<Pair, std::uint32_t>, std::string> pieces;  // of contacts without a name, by their first faces
  std::set<std::string> taken = names_of_contacts(model, solids);
  std::vector<std::string> names = names_of(model.faces, "face");
  for (std::uint32_t f = 0; f < model.faces.size(); ++f) {
    const Face& face = model.faces[f];
    const Pair pair = pair_of(face);
    if (const auto own = pairs.find(face.labels.name); own != pairs.end()) {
      if (own->second.size() > 1 && pair.first != kNone) names[f] += " (" + solids_in_words(pair, solids) + ")";
    } else if (face.labels.name.empty() && is_contact(face)) {
      const bool is_first = pieces.lower_bound({pair, 0}) == pieces.lower_bound({pair, kNone});
      std::string& name = pieces[{pair, face.piece == kNone ? f : face.piece}];
      if (name.empty())
        name = is_first ? solids_in_words(pair, solids) : next_piece(solids_in_words(pair, solids), taken);
      names[f] = name;
    }
  }
  return names;
}

std::vector<std::string> solid_names(const CadModel& model) {
  return all_different(names_of(model.solids, "solid"));
}

std::vector<std::uint32_t> faces_between(const CadModel& model, const std::string& pair) {
  const std::vector<std::string> solids = solid_names(model);
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < model.faces.size(); ++f) {
    const auto [a, b] = pair_of(model.faces[f]);
    if (is_contact(model.faces[f]) &&
        (pair == solids_in_words({a, b}, solids) || pair == solids_in_words({b, a}, solids)))
      faces.push_back(f);
  }
  return faces;
}

namespace {

/// Contacts whose faces have names of their own are found by their solids, too.
void add_contacts(const CadModel& model, std::map<std::string, LabelGroup>& by_name) {
  const std::vector<std::string> solids = solid_names(model), names = face_names(model);
  const std::set<std::string> patches(names.begin(), names.end());
  for (std::uint32_t f = 0; f < names.size(); ++f) {
    if (!is_contact(model.faces[f])) continue;
    const std::string name = solids_in_words(pair_of(model.faces[f]), solids);
    if (!patches.contains(name)) by_name[name].faces.push_back(f);
  }
}

}  // namespace

std::vector<LabelGroup> label_groups(const CadModel& model) {
  std::map<std::string, LabelGroup> by_name;
  for (std::uint32_t f = 0; f < model.faces.size(); ++f)
    for (const std::string& name : label_names(model.faces[f].labels)) by_name[name].faces.push_back(f);
  for (std::uint32_t s = 0; s < model.solids.size(); ++s)
    for (const std::string& name : label_names(model.solids[s].labels))
      by_name["solids of " + name].solids.push_back(s);
  add_contacts(model, by_name);
  std::vector<LabelGroup> groups;
  for (auto& [name, group] : by_name) groups.push_back({name, std::move(group.faces), std::move(group.solids)});
  return groups;
}

}  // namespace octafront::cad
