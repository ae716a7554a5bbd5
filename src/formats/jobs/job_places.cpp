#include "formats/jobs/job_places.h"

#include <octafront/error.h>
#include <octafront/units.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

void put_in_order(std::vector<std::uint32_t>& list) {
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

PlaceSet JobPlaces::faces(std::string_view option, const std::string& place) const {
  PlaceSet wanted{Kind::kFaces, items(option, place).faces};
  if (wanted.members.empty())
    throw OptionError(
        fmt::format("`{}`: \"{}\" has no faces; name a patch, a set of faces, or a reference point", option, place));
  for (const std::uint32_t f : wanted.members)
    if (f >= mesh_.boundary.size())
      throw OptionError(
          fmt::format("`{}`: \"{}\" has faces inside, where parts share their nodes; only free faces can bear that",
                      option, place));
  return wanted;
}

PlaceSet JobPlaces::anything(std::string_view option, const std::string& place) const {
  MeshItems all = items(option, place);
  if (all.empty()) throw OptionError(fmt::format("`{}`: nothing lies at \"{}\"", option, place));
  const std::array lists{&all.nodes, &all.edges, &all.faces, &all.tets};
  if (std::ranges::count_if(lists, [](const auto* list) { return !list->empty(); }) == 1)
    for (std::size_t k = 0; k < lists.size(); ++k)
      if (!lists[k]->empty()) return {static_cast<Kind>(k), *lists[k]};
  return nodes_of(all);
}

std::vector<std::uint32_t> JobPlaces::regions(std::string_view option, const std::string& place) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t t : items(option, place).tets) found.push_back(parts_.region_of(t));
  put_in_order(found);
  if (found.empty()) throw OptionError(fmt::format("`{}`: \"{}\" has no elements; name a part", option, place));
  return found;
}

std::optional<std::size_t> JobPlaces::part(const PlaceSet& set) const {
  for (std::size_t p = 0; p < parts_.parts().size(); ++p) {
    const Part& part = parts_.parts()[p];
    if (part.kind == set.kind && std::ranges::equal(part.members, set.members)) return p;
  }
  return std::nullopt;
}

std::optional<std::size_t> JobPlaces::point(const std::string& name) const {
  const auto at = std::ranges::find(job_.couplings, name, &JobCoupling::name);
  if (at == job_.couplings.end()) return std::nullopt;
  return static_cast<std::size_t>(at - job_.couplings.begin());
}

MeshItems JobPlaces::items(std::string_view option, const std::string& place) const {
  MeshItems all = items_at(mesh_, option, place_of(option, place));
  for (auto* list : {&all.nodes, &all.edges, &all.faces, &all.tets}) put_in_order(*list);
  std::erase_if(all.nodes, [&](VertexIndex v) { return v >= parts_.points(); });  // that the file has not
  return all;
}

PlaceSet JobPlaces::nodes_of(const MeshItems& all) const {
  PlaceSet wanted{Kind::kNodes, all.nodes};
  for (const auto& [kind, list] :
       {std::pair{Kind::kEdges, &all.edges}, {Kind::kFaces, &all.faces}, {Kind::kElements, &all.tets}}) {
    const std::vector<VertexIndex> nodes = parts_.nodes_of({Part::Origin::kSet, kind, 0, 0, {}, false, *list});
    wanted.members.insert(wanted.members.end(), nodes.begin(), nodes.end());
  }
  put_in_order(wanted.members);
  return wanted;
}

namespace {

constexpr double kSteelPoisson = 0.3, kSteelDensity = 7.85e-9;

class MaterialPlanner {
 public:
  MaterialPlanner(MeshOutput& out, const MeshParts& mesh, const SolverJob& job, const JobPlaces& places, JobPlan& plan)
      : out_(out), regions_(mesh.parts(Part::Origin::kRegion)), job_(job), places_(places), plan_(plan) {}

  void plan() {
    plan_.materials = job_.materials;
    std::vector<std::size_t>& of = plan_.material_of;
    of.assign(regions_.size(), plan_.materials.size());
    const auto number = [&](const std::string& name) {
      return static_cast<std::size_t>(std::ranges::find(job_.materials, name, &JobMaterial::name) -
                                      job_.materials.begin());
    };
    for (const JobPart& part : job_.parts)
      if (part.place.empty()) std::ranges::fill(of, number(part.material));
    for (const JobPart& part : job_.parts) {
      if (part.place.empty()) continue;
      const std::vector<std::uint32_t> meant = places_.regions("materials", part.place);
      for (std::size_t r = 0; r < of.size(); ++r)
        if (std::ranges::binary_search(meant, regions_[r].number)) of[r] = number(part.material);
    }
    put_placeholder();
    if (!job_.densities.empty()) put_densities();
  }

 private:
  /// Of the input; 0: it says none. The region of a single body may have another name.
  double density_of_input(std::size_t region) const {
    if (regions_.size() == 1 && job_.densities.size() == 1) return job_.densities[0].value;
    const auto found = std::ranges::find(job_.densities, regions_[region].name, &JobDensity::part);
    return found == job_.densities.end() ? 0 : found->value;
  }

  bool has_own_density(std::size_t material) const {
    return material == plan_.materials.size() || (material < job_.materials.size() && job_.materials[material].density);
  }

  /// A material without a density becomes as many as the parts that are of it have densities.
  void put_densities() {
    const std::vector<JobMaterial> plain = plan_.materials;
    std::map<std::pair<std::size_t, double>, std::size_t> made;
    std::set<std::size_t> taken;
    std::string told;
    for (std::size_t r = 0; r < regions_.size(); ++r) {
      const std::size_t m = plan_.material_of[r];
      if (has_own_density(m)) continue;
      const double density = density_of_input(r);
      const auto [at, is_new] = made.try_emplace({m, density}, m);
      if (is_new && !taken.insert(m).second) {
        at->second = plan_.materials.size();
        plan_.materials.push_back(plain[m]);
        plan_.materials.back().name += " of " + regions_[r].name;
      }
      plan_.material_of[r] = at->second;
      if (density == 0) continue;
      plan_.materials[at->second].density = density;
      told += fmt::format("{}{:.6g} of \"{}\"", told.empty() ? "" : ", ", density, regions_[r].name);
    }
    if (!told.empty()) out_.note("densities of the input, as they go with newtons: " + told);
  }

  void put_placeholder() {
    std::string without;
    for (std::size_t r = 0; r < regions_.size(); ++r)
      if (plan_.material_of[r] == job_.materials.size())
        without += fmt::format("{}\"{}\"", without.empty() ? "" : ", ", regions_[r].name);
    if (without.empty() || out_.options().materials.size() > 0) return;
    const LengthUnit* unit = unit_named(out_.options().unit);
    const double length = unit == nullptr ? 1 : unit->metres * 1000;
    const JobMaterial steel{"placeholder", kSteelYoung * length * length, kSteelPoisson,
                            kSteelDensity * (length * length) * (length * length)};
    plan_.materials.push_back(steel);
    out_.note(
        fmt::format("PLACEHOLDER: no material is given for {}: E {:.6g}, nu {}, density {:.6g} stand there, which is "
                    "steel in N, {}; give yours by `materials`",
                    without, steel.young, steel.poisson, *steel.density,
                    length == 1 ? "mm and t" : std::string(unit->name) + " and s"));
  }

  MeshOutput& out_;
  std::span<const Part> regions_;
  const SolverJob& job_;
  const JobPlaces& places_;
  JobPlan& plan_;
};

}  // namespace

void plan_materials(MeshOutput& out, const MeshParts& mesh, const SolverJob& job, const JobPlaces& places,
                    JobPlan& plan) {
  MaterialPlanner(out, mesh, job, places, plan).plan();
}

}  // namespace octafront::io
