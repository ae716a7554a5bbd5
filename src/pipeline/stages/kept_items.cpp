#include <octafront/error.h>
#include <octafront/named_groups.h>

#include "base/core/flat_map.h"
#include "base/mesh/face_table.h"
#include "base/places/places.h"
#include "pipeline/stages/adapting.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

/// What MEDIT's files ask to stay, and corners.
bool is_required(const NamedSet& set) {
  const MeditSet* known = medit_set(set);
  return known && (known->is_required || known->kind == NamedSet::Kind::kNodes);
}

const Triangle& face_of_number(const TetMesh& mesh, std::uint32_t f) {
  return f < mesh.boundary.size() ? mesh.boundary[f] : mesh.interfaces[f - mesh.boundary.size()];
}

/// The listed faces of these elements.
void add_faces_of(const TetMesh& mesh, const std::vector<std::uint32_t>& tets, std::vector<std::uint32_t>& faces) {
  FlatSet<Triangle> theirs;
  for (const std::uint32_t t : tets)
    for (int i = 0; i < 4; ++i) theirs.insert(face_key(face_of(mesh.tets[t], i)));
  const auto all = static_cast<std::uint32_t>(mesh.count(NamedSet::Kind::kFaces));
  for (std::uint32_t f = 0; f < all; ++f)
    if (theirs.contains(face_key(face_of_number(mesh, f)))) faces.push_back(f);
}

void add_place(const TetMesh& mesh, const Place& place, MeshItems& kept) {
  MeshItems own = items_at(mesh, "keep", place);
  add_faces_of(mesh, own.tets, own.faces);
  if (own.nodes.empty() && own.edges.empty() && own.faces.empty())
    throw OptionError(fmt::format("`keep`: \"{}\" has no faces, edges or vertices that could stay", place.text));
  kept.nodes.insert(kept.nodes.end(), own.nodes.begin(), own.nodes.end());
  kept.edges.insert(kept.edges.end(), own.edges.begin(), own.edges.end());
  kept.faces.insert(kept.faces.end(), own.faces.begin(), own.faces.end());
}

MeshItems items_asked_for(const TetMesh& mesh, const Options& options) {
  MeshItems kept;
  for (const Place& place : places_listed("keep", options.adapt.keep, ';', {})) add_place(mesh, place, kept);
  if (!options.improve.move_boundary) {
    kept.faces.resize(kept.faces.size() + mesh.boundary.size());
    std::iota(kept.faces.end() - static_cast<std::ptrdiff_t>(mesh.boundary.size()), kept.faces.end(), 0u);
  }
  return kept;
}

}  // namespace

KeptItems add_kept_items(TetMesh& mesh, const Options& options, const Stage& stage) {
  KeptItems kept;
  kept.own_sets = mesh.sets.size();
  MeshItems asked = items_asked_for(mesh, options);
  for (auto& [kind, members] :
       {std::pair{NamedSet::Kind::kNodes, &asked.nodes}, std::pair{NamedSet::Kind::kEdges, &asked.edges},
        std::pair{NamedSet::Kind::kFaces, &asked.faces}}) {
    std::sort(members->begin(), members->end());
    members->erase(std::unique(members->begin(), members->end()), members->end());
    if (!members->empty()) mesh.sets.push_back({"", kind, std::move(*members)});
  }
  std::array<std::size_t, 4> counts{};
  for (std::uint32_t s = 0; s < mesh.sets.size(); ++s) {
    const NamedSet& set = mesh.sets[s];
    if (set.members.empty() || (s < kept.own_sets && !is_required(set))) continue;
    kept.sets.push_back(s);
    counts[static_cast<std::size_t>(set.kind)] += set.members.size();
    if (set.kind == NamedSet::Kind::kFaces)
      for (const std::uint32_t f : set.members) kept.faces.push_back(face_of_number(mesh, f));
  }
  if (!kept.sets.empty())
    stage.note(fmt::format("{} faces, {} edges, {} vertices and {} elements that were asked for stay as they are",
                           counts[2], counts[1], counts[0], counts[3]));
  return kept;
}

void drop_kept_items(TetMesh& mesh, const KeptItems& kept) {
  mesh.sets.resize(std::min(mesh.sets.size(), kept.own_sets));
}

}  // namespace octafront
