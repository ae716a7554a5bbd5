#include "improve/schedule/kept_labels.h"

#include <octafront/named_groups.h>

#include "base/core/flat_map.h"
#include "base/core/renumber.h"
#include "base/mesh/adjacency.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace octafront::improve {
namespace {

using Kind = NamedSet::Kind;

bool is_required(const NamedSet& set) {
  const MeditSet* const known = set.kind == Kind::kElements ? medit_set(set) : nullptr;
  return known != nullptr && known->is_required;
}

/// Per tet.
std::vector<std::uint8_t> elements_that_stay(const TetMesh& mesh) {
  std::vector<std::uint8_t> stays(mesh.tets.size(), 0);
  for (const WideCell& cell : mesh.wide_cells) std::fill_n(stays.begin() + cell.first, cell.tet_count, std::uint8_t{1});
  for (const NamedSet& set : mesh.sets)
    if (is_required(set))
      for (const std::uint32_t t : set.members) stays[t] = 1;
  return stays;
}

/// Where the mesh ends, and where it meets the elements that stay: what one tet has that does not.
std::vector<Triangle> walls_beside(const TetMesh& mesh, const std::vector<std::uint8_t>& stays) {
  std::vector<Triangle> found;
  half_face_table(mesh.tets, mesh.points.size())
      .for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> on_face) {
        const auto is_edited = [&](const FaceTable::Entry& entry) { return !stays[entry.face / 4]; };
        if (std::ranges::count_if(on_face, is_edited) == 1)
          found.push_back(corners_of(mesh.tets, std::ranges::find_if(on_face, is_edited)->face));
      });
  return found;
}

/// Faces inside that keep edges and vertices where they are, for who keeps its faces keeps these.
class Holding {
 public:
  explicit Holding(const TetMesh& mesh) : mesh_(mesh), waits_(mesh.points.size(), 0) {
    for (const Edge& e : mesh.curve_edges) edges_.insert(sorted_edge(e[0], e[1]));
    for (const auto& nodes : {nodes_that_stay(mesh), required_vertices(mesh)})
      for (const VertexIndex v : nodes) waits_[v] = 1;
    for (const auto* faces : {&mesh.boundary, &mesh.interfaces})
      for (const Triangle& t : *faces) hold(t);
  }

  std::vector<Triangle> faces() {
    if (edges_.size() > 0)
      for (const Tet& t : mesh_.tets) hold_edges(t);
    if (std::ranges::find(waits_, 1) != waits_.end())
      for (const Tet& t : mesh_.tets) hold_nodes(t);
    return std::move(faces_);
  }

 private:
  void hold(const Triangle& t) {
    for (std::size_t i = 0; i < 3; ++i) edges_.erase(sorted_edge(t[i], t[(i + 1) % 3])), waits_[t[i]] = 0;
  }

  void hold_edges(const Tet& t) {
    for (const auto& [i, j] : kTetEdges) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      if (!edges_.contains(sorted_edge(t[a], t[b]))) continue;
      std::size_t c = 0;
      while (c == a || c == b) ++c;
      add({t[a], t[b], t[c]});
    }
  }
  void hold_nodes(const Tet& t) {
    for (int i = 0; i < 4; ++i) {
      const Triangle f = face_of(t, i);
      if (std::ranges::any_of(f, [&](VertexIndex v) { return waits_[v] != 0; })) add(f);
    }
  }

  void add(const Triangle& t) {
    faces_.push_back(t);
    hold(t);
  }

  const TetMesh& mesh_;
  FlatSet<Edge> edges_;              ///< that are held by none yet
  std::vector<std::uint8_t> waits_;  ///< per vertex: the same
  std::vector<Triangle> faces_;
};

}  // namespace

std::size_t count_required(const TetMesh& mesh) {
  std::size_t count = 0;
  for (const NamedSet& set : mesh.sets)
    if (is_required(set)) count += set.members.size();
  return count;
}

bool has_staying_elements(const TetMesh& mesh) {
  return !mesh.wide_cells.empty() || count_required(mesh) > 0;
}

KeptLabels::KeptLabels(TetMesh& mesh) : interfaces_(mesh.interfaces.size()) {
  has_staying_elements(mesh) ? put_aside(mesh, elements_that_stay(mesh)) : label_elements(mesh);
  if (mesh.sets.empty() && mesh.curve_edges.empty()) return;
  const std::vector<Triangle> held = Holding(mesh).faces();
  mesh.interfaces.insert(mesh.interfaces.end(), held.begin(), held.end());
}

void KeptLabels::label_elements(TetMesh& mesh) {
  if (!has_sets(mesh, Kind::kElements)) return;
  elements_ = labels_of(mesh, Kind::kElements);
  before_.region = std::exchange(mesh.region, std::move(elements_->of));
  before_.sets = mesh.sets;
}

void KeptLabels::put_aside(TetMesh& mesh, std::vector<std::uint8_t> stays) {
  Aside& aside = aside_.emplace();
  std::vector<Triangle> walls = walls_beside(mesh, stays);
  enum : char { kElsewhere, kInside, kWall };
  std::vector<char> place(mesh.points.size(), kElsewhere);
  Origins items;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    if (stays[t]) continue;
    items.tets.push_back(t);
    for (const VertexIndex v : mesh.tets[t]) place[v] = kInside;
  }
  for (const Triangle& t : walls)
    for (const VertexIndex v : t) place[v] = kWall;
  for (const char wanted : {kWall, kInside}) {
    for (VertexIndex v = 0; v < place.size(); ++v)
      if (place[v] == wanted) items.nodes.push_back(v);
    if (wanted == kWall) aside.fixed = items.nodes;
  }
  const auto is_there = [&](const auto& item) {
    return std::ranges::all_of(item, [&](VertexIndex v) { return place[v] != kElsewhere; });
  };
  for (std::uint32_t f = 0; f < mesh.interfaces.size(); ++f)
    if (is_there(mesh.interfaces[f])) items.faces.push_back(static_cast<std::uint32_t>(mesh.boundary.size()) + f);
  for (std::uint32_t e = 0; e < mesh.curve_edges.size(); ++e)
    if (is_there(mesh.curve_edges[e])) items.edges.push_back(e);
  elements_ = labels_of(mesh, Kind::kElements);
  aside.in_edited.assign(mesh.points.size(), kNone);
  TetMesh edited = part_of(mesh, items, aside.in_edited);
  for (VertexIndex k = 0; k < items.nodes.size(); ++k) aside.in_edited[items.nodes[k]] = k;
  renumber(walls, aside.in_edited);
  edited.boundary = std::move(walls), edited.patch.clear();
  edited.region.clear();
  if (elements_->like.size() > 1)
    for (const TetIndex t : items.tets) edited.region.push_back(elements_->of[t]);
  aside.stays = std::move(stays);
  aside.whole = std::exchange(mesh, std::move(edited));
}

void KeptLabels::put_back(TetMesh& mesh, const std::vector<VertexIndex>& number) const {
  if (aside_) return put_back_aside(mesh, number);
  mesh.interfaces.resize(interfaces_);
  if (!elements_) return;
  std::vector<TetIndex> like(mesh.region.size());
  for (std::size_t t = 0; t < like.size(); ++t) like[t] = elements_->like[mesh.region[t]];
  inherit(mesh, before_, Kind::kElements, like);
}

void KeptLabels::put_back_aside(TetMesh& mesh, const std::vector<VertexIndex>& number) const {
  const auto& [whole, stays, fixed, in_edited] = *aside_;
  TetMesh made;
  Origins from;
  // What was inside is gone; what is there now follows behind all.
  std::vector<VertexIndex> now(whole.points.size(), 0);
  for (VertexIndex v = 0; v < now.size(); ++v)
    if (in_edited[v] != kNone && in_edited[v] >= fixed.size()) now[v] = kNone;
  made.points = whole.points;
  keep_numbered(made.points, now);
  std::vector<VertexIndex> of_edited;
  for (const VertexIndex v : fixed) of_edited.push_back(now[v]);
  for (std::size_t v = fixed.size(); v < mesh.points.size(); ++v) {
    of_edited.push_back(static_cast<VertexIndex>(made.points.size()));
    made.points.push_back(mesh.points[v]);
  }
  from.nodes.assign(made.points.size(), kNone);
  for (VertexIndex v = 0; v < now.size(); ++v) {
    if (now[v] == kNone && number[in_edited[v]] != kNone) now[v] = of_edited[number[in_edited[v]]];
    if (now[v] != kNone) from.nodes[now[v]] = v;
  }
  made.tets = std::move(mesh.tets);
  renumber(made.tets, of_edited);
  for (std::size_t t = 0; t < made.tets.size(); ++t)
    from.tets.push_back(elements_->like[mesh.region.empty() ? 0 : mesh.region[t]]);
  for (TetIndex t = 0; t < stays.size(); ++t) {
    if (!stays[t]) continue;
    made.tets.push_back(whole.tets[t]), from.tets.push_back(t);
    for (VertexIndex& v : made.tets.back()) v = now[v];
  }
  made.boundary = whole.boundary, made.interfaces = whole.interfaces, made.curve_edges = whole.curve_edges;
  renumber(made.boundary, now);
  renumber(made.interfaces, now);
  renumber(made.curve_edges, now);
  from.faces.resize(made.count(Kind::kFaces)), from.edges.resize(made.curve_edges.size());
  std::iota(from.faces.begin(), from.faces.end(), 0u);
  std::iota(from.edges.begin(), from.edges.end(), 0u);
  inherit(made, whole, from);
  mesh = std::move(made);
}

}  // namespace octafront::improve
