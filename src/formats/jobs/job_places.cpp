
#include "formats/jobs/job_places.h"

#include <octafront/error.h>

#include <algorithm>
#include <array>
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

}  // namespace octafront::io
