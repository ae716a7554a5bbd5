#include "cad/shapes/names.h"

#include <map>
#include <set>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& items, const std::string& kind) {
  std::set<std::string> taken;
  for (const Item& item : items) taken.insert(item.labels.name);
  std::set<std::string> given;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string& own = items[i].labels.name;
    std::string name = own.empty() ? kind + " " + std::to_string(i + 1) : own;
    const bool is_free = own.empty() ? !taken.contains(name) && !given.contains(name) : !given.contains(name);
    for (int k = 2; !is_free && (given.contains(name) || taken.contains(name)); ++k)
      name = (own.empty() ? kind + " " + std::to_string(i + 1) : own) + "#" + std::to_string(k);
    given.insert(name);
    names.push_back(std::move(name));
  }
  return names;
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

}  // namespace

std::vector<std::string> face_names(const CadModel& model) {
  return names_of(model.faces, "face");
}
std::vector<std::string> solid_names(const CadModel& model) {
  return names_of(model.solids, "solid");
}

std::vector<LabelGroup> label_groups(const CadModel& model) {
  std::map<std::string, LabelGroup> by_name;
  for (std::uint32_t f = 0; f < model.faces.size(); ++f)
    for (const std::string& name : label_names(model.faces[f].labels)) by_name[name].faces.push_back(f);
  for (std::uint32_t s = 0; s < model.solids.size(); ++s)
    for (const std::string& name : label_names(model.solids[s].labels))
      by_name["solids of " + name].solids.push_back(s);
  std::vector<LabelGroup> groups;
  for (auto& [name, group] : by_name) groups.push_back({name, std::move(group.faces), std::move(group.solids)});
  return groups;
}

}  // namespace octafront::cad
