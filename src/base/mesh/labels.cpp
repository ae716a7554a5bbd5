#include "base/mesh/labels.h"

#include "base/core/flat_map.h"
#include "base/mesh/renumber_mesh.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace octafront {
namespace {

using Kind = NamedSet::Kind;
using Numbers = std::span<const std::uint32_t>;

/// The items that come from the members of sets: whichever are fewer are looked for among the others.
class ItemsByOrigin {
 public:
  explicit ItemsByOrigin(Numbers from) : from_(from), order_(from.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!std::ranges::is_sorted(from)) std::ranges::stable_sort(order_, {}, [&](std::uint32_t i) { return from_[i]; });
  }

  std::vector<std::uint32_t> of(const std::vector<std::uint32_t>& members) const {
    std::vector<std::uint32_t> items;
    if (members.size() < order_.size()) {
      for (const std::uint32_t m : members) {
        const auto group = std::ranges::equal_range(order_, m, {}, [&](std::uint32_t i) { return from_[i]; });
        items.insert(items.end(), group.begin(), group.end());
      }
      std::ranges::sort(items);
    } else {
      for (std::uint32_t i = 0; i < from_.size(); ++i)
        if (std::ranges::binary_search(members, from_[i])) items.push_back(i);
    }
    return items;
  }

 private:
  Numbers from_;
  std::vector<std::uint32_t> order_;
};

void inherit_sets(TetMesh& mesh, const TetMesh& before, Kind kind, Numbers from) {
  if (!has_sets(before, kind)) return;
  const ItemsByOrigin items(from);
  for (std::size_t s = 0; s < before.sets.size(); ++s)
    if (before.sets[s].kind == kind) mesh.sets[s].members = items.of(before.sets[s].members);
}

void inherit_faces(TetMesh& mesh, const TetMesh& before, Numbers from) {
  const auto old_outer = static_cast<std::uint32_t>(before.boundary.size());
  const Numbers outer = from.first(mesh.boundary.size());
  std::vector<std::uint32_t> patch = before.patch, inner_patch = before.interface_patch;
  if (!patch.empty() || !inner_patch.empty()) {
    patch.resize(old_outer, 0), inner_patch.resize(before.interfaces.size(), 0);
    patch.insert(patch.end(), inner_patch.begin(), inner_patch.end());
  }
  const std::vector<std::uint32_t> all = of_items(patch, from);
  const auto part = [&](bool wanted, std::size_t first, std::size_t last) {
    return wanted && !all.empty() ? std::vector<std::uint32_t>(all.begin() + static_cast<std::ptrdiff_t>(first),
                                                               all.begin() + static_cast<std::ptrdiff_t>(last))
                                  : std::vector<std::uint32_t>();
  };
  mesh.patch = part(!before.patch.empty(), 0, outer.size());
  mesh.interface_patch = part(!before.interface_patch.empty(), outer.size(), from.size());
  mesh.source = of_items(before.source, outer, kNone);
  mesh.face_layers = of_items(before.face_layers, from, kNone);
  mesh.wide_faces.clear();
  if (before.wide_faces.empty()) return;
  // Two consecutive faces that are the two of one.
  for (std::uint32_t f = 0; f + 1 < outer.size(); ++f) {
    const auto at = std::ranges::lower_bound(before.wide_faces, from[f], {}, &WideFace::first);
    if (at != before.wide_faces.end() && at->first == from[f] && from[f + 1] == from[f] + 1)
      mesh.wide_faces.push_back({f, at->nodes});
  }
}

void inherit_tets(TetMesh& mesh, const TetMesh& before, Numbers from) {
  mesh.region = of_items(before.region, from);
  mesh.wide_cells.clear();
  if (before.wide_cells.empty()) return;
  for (TetIndex t = 0; t < from.size(); ++t) {
    const auto at = std::ranges::lower_bound(before.wide_cells, from[t], {}, &WideCell::first);
    if (at == before.wide_cells.end() || at->first != from[t] || t + at->tet_count > from.size()) continue;
    bool is_whole = true;
    for (std::uint32_t k = 1; k < at->tet_count; ++k) is_whole = is_whole && from[t + k] == from[t] + k;
    if (is_whole) mesh.wide_cells.push_back({t, at->tet_count, at->nodes});
  }
}

/// Pairs, and the corners of what names nodes by itself.
void inherit_nodes(TetMesh& mesh, const TetMesh& before, Numbers from) {
  mesh.periods = before.periods, mesh.period_rotations = before.period_rotations;
  mesh.periodic_nodes = before.periodic_nodes, mesh.split_faces = before.split_faces;
  if (mesh.periodic_nodes.empty() && mesh.split_faces.empty() && mesh.wide_cells.empty() && mesh.wide_faces.empty())
    return;
  std::vector<VertexIndex> now(before.points.size(), kNone);
  for (VertexIndex v = 0; v < from.size(); ++v)
    if (from[v] != kNone && now[from[v]] == kNone) now[from[v]] = v;
  renumber_named_nodes(mesh, now);
}

void number_as_they_come(Labels& labels) {
  FlatMap<std::uint64_t, std::uint32_t> now;
  labels.like.clear();
  for (std::uint32_t i = 0; i < labels.of.size(); ++i) {
    std::uint32_t& number = now.find_or_add(labels.of[i], kNone);
    if (number == kNone) number = static_cast<std::uint32_t>(labels.like.size()), labels.like.push_back(i);
    labels.of[i] = number;
  }
}

}  // namespace

bool has_member(const NamedSet& set, std::uint32_t item) {
  return std::ranges::binary_search(set.members, item);
}

bool has_sets(const TetMesh& mesh, Kind kind) {
  return std::ranges::any_of(mesh.sets, [&](const NamedSet& set) { return set.kind == kind; });
}

void inherit(TetMesh& mesh, const TetMesh& before, Kind kind, Numbers from) {
  switch (kind) {
    case Kind::kNodes:
      inherit_nodes(mesh, before, from);
      break;
    case Kind::kEdges:
      mesh.curve = of_items(before.curve, from);
      break;
    case Kind::kFaces:
      inherit_faces(mesh, before, from);
      break;
    case Kind::kElements:
      inherit_tets(mesh, before, from);
  }
  inherit_sets(mesh, before, kind, from);
}

void inherit(TetMesh& mesh, const TetMesh& before, const Origins& from) {
  mesh.region_names = before.region_names, mesh.region_labels = before.region_labels;
  mesh.patch_names = before.patch_names, mesh.patch_labels = before.patch_labels;
  mesh.curve_names = before.curve_names, mesh.curve_labels = before.curve_labels;
  mesh.opened_contacts = before.opened_contacts;
  mesh.sets.clear();
  for (const NamedSet& set : before.sets) mesh.sets.push_back({set.name, set.kind, {}});
  inherit(mesh, before, Kind::kElements, from.tets);
  inherit(mesh, before, Kind::kFaces, from.faces);
  inherit(mesh, before, Kind::kEdges, from.edges);
  inherit(mesh, before, Kind::kNodes, from.nodes);
}

TetMesh part_of(const TetMesh& whole, const Origins& items, std::vector<VertexIndex>& here) {
  TetMesh part;
  part.points = of_items(whole.points, items.nodes);
  for (VertexIndex v = 0; v < items.nodes.size(); ++v) here[items.nodes[v]] = v;
  part.tets = of_items(whole.tets, items.tets);
  part.mid_nodes = of_items(whole.mid_nodes, items.tets);
  part.high_order = whole.high_order;
  for (const std::uint32_t t : items.tets) {
    const auto first = whole.high_nodes.begin() + static_cast<std::ptrdiff_t>(t * whole.high_nodes_per_tet());
    part.high_nodes.insert(part.high_nodes.end(), first,
                           first + static_cast<std::ptrdiff_t>(whole.high_nodes_per_tet()));
  }
  const auto outer = static_cast<std::uint32_t>(whole.boundary.size());
  for (const std::uint32_t f : items.faces)
    f < outer ? part.boundary.push_back(whole.boundary[f]) : part.interfaces.push_back(whole.interfaces[f - outer]);
  part.curve_edges = of_items(whole.curve_edges, items.edges);
  renumber_corners(part, here);
  for (const VertexIndex v : items.nodes) here[v] = kNone;
  inherit(part, whole, items);
  return part;
}

Labels labels_of(const TetMesh& mesh, Kind kind) {
  std::vector<std::uint32_t> own = kind == Kind::kElements ? mesh.region
                                   : kind == Kind::kFaces  ? mesh.patch
                                   : kind == Kind::kEdges  ? mesh.curve
                                                           : std::vector<std::uint32_t>();
  if (kind == Kind::kFaces) {
    own.resize(mesh.boundary.size(), 0);
    own.insert(own.end(), mesh.interface_patch.begin(), mesh.interface_patch.end());
  }
  own.resize(mesh.count(kind), 0);
  Labels labels{std::move(own), {}};
  number_as_they_come(labels);
  // Refined by one set after the other.
  auto count = static_cast<std::uint32_t>(labels.like.size());
  bool is_refined = false;
  for (const NamedSet& set : mesh.sets) {
    if (set.kind != kind) continue;
    std::vector<std::uint32_t> inside(count, kNone);
    for (const std::uint32_t i : set.members) {
      std::uint32_t& number = inside[labels.of[i]];
      if (number == kNone) number = count++;
      labels.of[i] = number;
    }
    is_refined = true;
  }
  if (is_refined) number_as_they_come(labels);
  return labels;
}

std::vector<VertexIndex> nodes_that_stay(const TetMesh& mesh) {
  if (!has_sets(mesh, Kind::kNodes)) return {};
  const Labels labels = labels_of(mesh, Kind::kNodes);
  // Per label its sets, ascending.
  std::vector<std::vector<std::uint32_t>> sets(labels.like.size());
  for (std::size_t l = 0; l < sets.size(); ++l)
    for (std::uint32_t s = 0; s < mesh.sets.size(); ++s)
      if (mesh.sets[s].kind == Kind::kNodes && has_member(mesh.sets[s], labels.like[l])) sets[l].push_back(s);
  std::vector<std::uint8_t> is_wall(mesh.points.size(), 0), stays(mesh.points.size(), 0);
  for (const auto* faces : {&mesh.boundary, &mesh.interfaces})
    for (const Triangle& t : *faces)
      for (const VertexIndex v : t) is_wall[v] = 1;
  const auto look = [&](const auto& corners, bool at_wall) {
    for (const VertexIndex v : corners) {
      if (sets[labels.of[v]].empty() || stays[v] || (is_wall[v] != 0) != at_wall) continue;
      for (const VertexIndex w : corners)
        if (labels.of[w] != labels.of[v] && !std::ranges::includes(sets[labels.of[w]], sets[labels.of[v]]))
          stays[v] = 1;
    }
  };
  for (const auto* faces : {&mesh.boundary, &mesh.interfaces})
    for (const Triangle& t : *faces) look(t, true);
  for (const Tet& t : mesh.tets) look(t, false);
  std::vector<VertexIndex> found;
  for (VertexIndex v = 0; v < stays.size(); ++v)
    if (stays[v]) found.push_back(v);
  return found;
}

}  // namespace octafront
