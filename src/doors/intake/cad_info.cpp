#include <octafront/cad.h>

#include "base/mesh/curve_names.h"
#include "cad/shapes/names.h"
#include "cad/shapes/part_contacts.h"
#include "doors/intake/intake.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/core.h>

namespace octafront {

namespace {

using cad::CadModel;

class CadTeller {
 public:
  CadTeller(const CadModel& model, double unit)
      : model_(model), unit_(unit), solids_(cad::solid_names(model)), faces_(cad::face_names(model)) {}

  std::vector<CadInfo::Solid> solids() const {
    std::vector<CadInfo::Solid> all;
    for (std::size_t s = 0; s < solids_.size(); ++s) {
      const cad::Solid& solid = model_.solids[s];
      all.push_back({solids_[s], solid.labels.layer, solid.volume / (unit_ * unit_ * unit_), area(solid.area),
                     colour_of(solid.labels), solid.product, solid.material, solid.density});
    }
    return all;
  }

  std::vector<CadInfo::Patch> patches() {
    std::vector<std::vector<std::uint32_t>> faces;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      const auto p = static_cast<std::uint32_t>(number_.try_emplace(faces_[f], number_.size()).first->second);
      patch_of_.push_back(p);
      faces.resize(std::max<std::size_t>(faces.size(), p + 1));
      faces[p].push_back(f);
    }
    std::vector<CadInfo::Patch> all;
    for (const std::vector<std::uint32_t>& of : faces) {
      CadInfo::Patch& patch = all.emplace_back(CadInfo::Patch{faces_[of[0]], of.size(), 0, {}, {}});
      std::set<std::uint32_t> bounded;
      for (const std::uint32_t f : of) {
        patch.area += area(model_.faces[f].area);
        bounded.insert(model_.faces[f].sides.begin(), model_.faces[f].sides.end());
      }
      for (const std::uint32_t s : bounded)
        if (s != kNone) patch.solids.push_back(solids_[s]);
      patch.shape = cad::shape_in_words(model_, of, unit_);
      names_.push_back(patch.name);
    }
    return all;
  }

  /// After patches(), as a mesh will call them.
  std::vector<std::string> curves() const {
    std::set<std::string> curves;
    for (const cad::CadEdge& edge : model_.edges) {
      const std::set<std::uint32_t> patches = patches_at(edge);
      if (patches.size() > 1) curves.insert(name_of(edge));
    }
    return {curves.begin(), curves.end()};
  }

  /// After patches().
  std::vector<CadInfo::Small> shortest_edges() const {
    std::vector<CadInfo::Small> all;
    for (const cad::CadEdge& edge : model_.edges)
      if (!edge.is_seam) all.push_back({name_of(edge), edge.length / unit_});
    return smallest_of(std::move(all));
  }

  std::vector<CadInfo::Small> narrowest_faces() const {
    std::vector<double> around(faces_.size(), 0);
    for (const cad::CadEdge& edge : model_.edges)
      for (const std::uint32_t f : edge.faces)
        if (!edge.is_seam) around[f] += edge.length / unit_;
    std::vector<CadInfo::Small> all;
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      if (around[f] > 0) all.push_back({faces_[f], 2 * area(model_.faces[f].area) / around[f]});
    return smallest_of(std::move(all));
  }

  std::vector<CadInfo::Contact> contacts() const {
    std::vector<CadInfo::Contact> all;
    for (const cad::Contact& contact : cad::contacts_of(model_)) {
      const bool shares = contact.gap == 0 && !contact.faces.empty();
      all.push_back({{solids_[contact.solids[0]], solids_[contact.solids[1]]},
                     shares ? faces_[contact.faces[0]] : std::string(),
                     area(contact.area),
                     cad::shape_in_words(model_, contact.faces, unit_),
                     contact.gap / unit_,
                     contact.volume / (unit_ * unit_ * unit_),
                     contact.depth / unit_});
    }
    return all;
  }

 private:
  double area(double of_model) const { return of_model / (unit_ * unit_); }

  std::set<std::uint32_t> patches_at(const cad::CadEdge& edge) const {
    std::set<std::uint32_t> patches;
    for (const std::uint32_t f : edge.faces) patches.insert(patch_of_[f]);
    return patches;
  }

  /// As a mesh will call it; within one patch by that.
  std::string name_of(const cad::CadEdge& edge) const {
    const std::set<std::uint32_t> patches = patches_at(edge);
    return curve_name(std::vector<std::uint32_t>(patches.begin(), patches.end()), names_);
  }

  static std::vector<CadInfo::Small> smallest_of(std::vector<CadInfo::Small> all) {
    constexpr std::size_t kTold = 8;
    std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.size < b.size; });
    all.resize(std::min(kTold, all.size()));
    return all;
  }

  static std::string colour_of(const cad::Labels& labels) {
    if (!labels.colour) return "";
    const auto [red, green, blue] = *labels.colour;
    return fmt::format("#{:02x}{:02x}{:02x}", red, green, blue);
  }

  const CadModel& model_;
  double unit_;
  std::vector<std::string> solids_, faces_;
  std::map<std::string, std::size_t> number_;
  std::vector<std::uint32_t> patch_of_;
  std::vector<std::string> names_;  ///< of patches
};

}  // namespace

CadInfo read_cad_info(const std::string& file, const IntakeOptions& options, const RunContext& context) {
  intake::check_cad_intake(options.cad);
  CadInfo info;
  const auto take = [&](const std::string& text) { info.notes.push_back(text); };
  cad::ReaderOptions asked = intake::reader_options(options);
  if (asked.overlap == cad::Overlap::kRefuse) asked.overlap = cad::Overlap::kTell;
  const cad::CadReader reader(file, asked, take, context);
  const auto& [lo, hi, model] = reader.opened();
  info.notes.insert(info.notes.end(), model.notes.begin(), model.notes.end());
  info.format = model.format, info.unit = model.unit, info.to_millimetres = model.to_millimetres;
  const double unit = intake::unit_of(model, options.cad);
  info.lengths = options.cad.unit;
  info.box.add(lo / unit), info.box.add(hi / unit);
  CadTeller teller(model, unit);
  info.solids = teller.solids(), info.patches = teller.patches(), info.edges = teller.curves();
  info.contacts = teller.contacts();
  info.shortest_edges = teller.shortest_edges(), info.narrowest_faces = teller.narrowest_faces();
  for (const cad::LabelGroup& group : cad::label_groups(model))
    info.groups.push_back({group.name, group.faces.size(), group.solids.size()});
  info.faces = cad::face_names(model);
  for (const cad::Face& face : model.faces) info.named_faces += !face.labels.name.empty();
  return info;
}

}  // namespace octafront
