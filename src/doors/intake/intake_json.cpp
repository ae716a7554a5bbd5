#include <octafront/cad.h>
#include <octafront/domain.h>

#include "doors/intake/intake.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace octafront {

std::string to_json(const Domain& domain) {
  using Json = nlohmann::ordered_json;
  Json all = Json::object();
  for (const IntakeRepair& repair : domain.repairs)
    all[repair.of.empty() ? "repair" : "repair " + repair.of] = Json::parse(to_json(repair.report));
  for (std::size_t r = 0; r < domain.volumes.size(); ++r)
    all["input_regions"].push_back({{"name", intake::region_name(domain, r)}, {"volume", domain.volumes[r]}});
  if (!domain.unit.empty()) all["unit"] = domain.unit;
  for (const IntakeNote& note : domain.notes)
    if (!note.stage.empty()) all["input_notes"].push_back({{"stage", note.stage}, {"text", note.text}});
  if (domain.dropped_sheet_faces > 0) all["dropped_sheet_faces"] = domain.dropped_sheet_faces;
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

namespace {

nlohmann::ordered_json json_of(const CadInfo::Contact& contact) {
  nlohmann::ordered_json json{{"solids", contact.solids}};
  if (!contact.patch.empty()) json["patch"] = contact.patch;
  if (!contact.shape.empty()) json["shape"] = contact.shape, json["area"] = contact.area;
  if (contact.gap > 0) json["gap"] = contact.gap;
  if (contact.overlap > 0) json["overlap"] = contact.overlap, json["depth"] = contact.depth;
  return json;
}

}  // namespace

std::string to_json(const CadInfo& info) {
  using Json = nlohmann::ordered_json;
  const auto place = [](Vec3 p) { return Json::array({p.x, p.y, p.z}); };
  Json solids = Json::array();
  for (const CadInfo::Solid& solid : info.solids) {
    solids.push_back({{"name", solid.name}, {"volume", solid.volume}, {"area", solid.area}});
    for (const auto& [key, text] : {std::pair{"layer", &solid.layer}, std::pair{"color", &solid.color},
                                    std::pair{"product", &solid.product}, std::pair{"material", &solid.material}})
      if (!text->empty()) solids.back()[key] = *text;
    if (solid.density > 0) solids.back()["density"] = solid.density;
  }
  Json patches = Json::array();
  for (const CadInfo::Patch& patch : info.patches)
    patches.push_back({{"name", patch.name},
                       {"faces", patch.faces},
                       {"area", patch.area},
                       {"shape", patch.shape},
                       {"solids", patch.solids}});
  Json contacts = Json::array();
  for (const CadInfo::Contact& contact : info.contacts) contacts.push_back(json_of(contact));
  const auto smallest = [](const std::vector<CadInfo::Small>& of) {
    Json all = Json::array();
    for (const CadInfo::Small& one : of) all.push_back({{"name", one.name}, {"size", one.size}});
    return all;
  };
  Json groups = Json::array();
  for (const CadInfo::Group& group : info.groups)
    groups.push_back({{"name", group.name}, {"faces", group.faces}, {"solids", group.solids}});
  const Json all{{"kind", "CAD"},
                 {"format", info.format},
                 {"unit", info.unit},
                 {"to_millimetres", info.to_millimetres},
                 {"lengths", info.lengths},
                 {"box", {place(info.box.lo), place(info.box.hi)}},
                 {"solids", solids},
                 {"faces", info.faces},
                 {"cad_patches", patches},
                 {"contacts", contacts},
                 {"edges", info.edges},
                 {"groups", groups},
                 {"shortest_edges", smallest(info.shortest_edges)},
                 {"narrowest_faces", smallest(info.narrowest_faces)},
                 {"named_faces", info.named_faces},
                 {"notes", info.notes}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace octafront
