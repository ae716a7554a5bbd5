#include "cad/shapes/names.h"

#include <set>

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

}  // namespace

std::vector<std::string> face_names(const CadModel& model) {
  return names_of(model.faces, "face");
}
std::vector<std::string> solid_names(const CadModel& model) {
  return names_of(model.solids, "solid");
}

}  // namespace octafront::cad
