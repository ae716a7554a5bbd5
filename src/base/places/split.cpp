#include <octafront/error.h>
#include <octafront/split.h>

#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/quadratic_nodes.h"
#include "base/places/places.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace octafront {
namespace {

using Kind = NamedSet::Kind;

/// What is split under one name.
struct Asked {
  std::string name;
  std::vector<std::uint32_t> patches;
};

/// Which faces are opened together: of a patch, and of a contact between which two regions, ascending.
using FaceKey = std::array<std::uint32_t, 3>;

/// What becomes two patches.
struct Opening {
  std::array<std::string, 2> names;                       ///< of its sides
  std::array<std::uint32_t, 2> patches = {kNone, kNone};  ///< that they become; kNone: a new one
  std::uint32_t first_region = kNone;  ///< of the elements whose faces are the first side; kNone: of those in front
};

struct Openings {
  std::vector<Opening> list;
  std::map<FaceKey, std::uint32_t> of;  ///< by what they open

  /// Its number; that of openings: none.
  std::uint32_t find(std::uint32_t patch, std::uint32_t a, std::uint32_t b) const {
    for (const FaceKey& key : {FaceKey{patch, kNone, kNone}, FaceKey{patch, std::min(a, b), std::max(a, b)}})
      if (const auto at = of.find(key); at != of.end()) return at->second;
    return static_cast<std::uint32_t>(list.size());
  }
};

/// The patches with faces inside that are named. `inside`: per patch. Throws OptionError.
std::vector<Asked> asked_for(const std::vector<std::string>& places, const std::vector<std::string>& names,
                             const std::vector<char>& inside) {
  std::vector<Asked> asked;
  for (const std::string& text : places) {
    const Place place = place_of("split", text);
    if (place.is_in_space()) throw OptionError(fmt::format("`split` opens patches, and \"{}\" is none", text));
    const auto* list = std::get_if<std::vector<std::string>>(&place.where);
    for (const std::string& name : list != nullptr ? *list : std::vector{text})
      asked.push_back({name, patches_called("split", names, inside, name)});
  }
  return asked;
}

void note_inside(std::vector<char>& inside, std::uint32_t patch) {
  if (patch >= inside.size()) inside.resize(patch + 1, 0);
  inside[patch] = 1;
}

std::uint32_t patch_at(const std::vector<std::uint32_t>& patch, std::size_t face) {
  return patch.empty() ? 0 : patch[face];
}

Openings openings_of(const std::vector<Asked>& asked) {
  Openings made;
  for (const Asked& a : asked) {
    for (const std::uint32_t p : a.patches)
      made.of.try_emplace({p, kNone, kNone}, static_cast<std::uint32_t>(made.list.size()));
    made.list.push_back({{a.name + "_plus", a.name + "_minus"}});
  }
  return made;
}

std::uint32_t region_at(const TetMesh& mesh, TetIndex t) {
  return mesh.region.empty() ? 0 : mesh.region[t];
}

std::string region_called(const TetMesh& mesh, std::uint32_t region) {
  return region_label(region < mesh.region_names.size() ? mesh.region_names[region] : "", region, region + 2);
}

/// Of faces that lie between two regions, by their patches and these; the numbers of the faces.
std::map<FaceKey, std::vector<std::uint32_t>> faces_of_contacts(const TetMesh& mesh) {
  std::map<FaceKey, std::vector<std::uint32_t>> faces;
  if (mesh.interfaces.empty() || mesh.region.empty()) return faces;
  const FaceTable table = half_face_table(mesh.tets, mesh.points.size());
  for (std::uint32_t f = 0; f < mesh.interfaces.size(); ++f) {
    const auto at = table.group_of(mesh.interfaces[f]);
    if (at.size() != 2) continue;
    const auto [a, b] = std::minmax(mesh.region[at[0].face / 4], mesh.region[at[1].face / 4]);
    if (a != b) faces[{patch_at(mesh.interface_patch, f), a, b}].push_back(f);
  }
  return faces;
}

/// With a number behind it where another patch is called so.
std::string not_taken(const std::string& name, std::set<std::string>& taken) {
  std::string tried = name;
  for (int k = 2; !taken.insert(tried).second; ++k) tried = name + "#" + std::to_string(k);
  return tried;
}

/// Of contacts in these patches. The first one of a patch keeps its number, on the side that keeps its name.
Openings openings_of(const TetMesh& mesh, const std::vector<std::uint32_t>& patches) {
  Openings made;
  std::set<std::string> taken(mesh.patch_names.begin(), mesh.patch_names.end());
  std::uint32_t last = kNone;
  for (const auto& [key, faces] : faces_of_contacts(mesh)) {
    const auto [patch, a, b] = key;
    if (std::ranges::find(patches, patch) == patches.end()) continue;
    const std::string name = patch < mesh.patch_names.size() ? mesh.patch_names[patch] : std::string();
    Opening opening{names_of_sides(name, region_called(mesh, a), region_called(mesh, b)), {kNone, kNone}, a};
    if (patch != last) {
      taken.erase(name);
      const std::size_t keeps = opening.names[1] == name ? 1 : 0;
      opening.patches[keeps] = patch;
    }
    last = patch;
    for (std::string& side : opening.names) side = not_taken(side, taken);
    made.of[key] = static_cast<std::uint32_t>(made.list.size());
    made.list.push_back(std::move(opening));
  }
  return made;
}

/// A node at an element around it, and which copy of the node that gets.
struct NodeUse {
  VertexIndex node;
  TetIndex tet;
  std::uint32_t copy = 0;  ///< 0: the node itself
};

/// Copies of nodes: those on faces that are split, one for each part into which the elements around them come apart.
class NodeCopies {
 public:
  /// `is_split`: per half-face.
  NodeCopies(const TetMesh& mesh, const std::vector<HalfFace>& across, const std::vector<char>& is_split) {
    mark(mesh, is_split);
    for (TetIndex t = 0; t < mesh.tets.size(); ++t)
      for_each_node(mesh, t, [&](VertexIndex v) { uses_.push_back({v, t}); });
    std::sort(uses_.begin(), uses_.end(),
              [](const NodeUse& a, const NodeUse& b) { return std::pair(a.node, a.tet) < std::pair(b.node, b.tet); });
    number(parts(mesh, across, is_split));
    place(mesh);
  }

  bool is_marked(VertexIndex v) const { return marked_[v]; }
  std::size_t count() const { return extra_.size(); }
  std::size_t old_points() const { return points_; }
  /// The new number of a node where no element asks.
  VertexIndex self(VertexIndex v) const { return v < corners_ ? v : v + extra_corners_; }
  /// The new number of node v in an element around it.
  VertexIndex at(TetIndex t, VertexIndex v) const { return marked_[v] ? copy_of(v, uses_[index(v, t)].copy) : self(v); }
  /// All of them.
  std::vector<VertexIndex> all(VertexIndex v) const {
    std::vector<VertexIndex> list{self(v)};
    for (auto e = first_extra(v); e < extra_.size() && extra_[e] == v; ++e) list.push_back(of_extra(e));
    return list;
  }
  std::vector<Vec3> points(const std::vector<Vec3>& before) const {
    std::vector<Vec3> after(before.size() + extra_.size());
    for (VertexIndex v = 0; v < before.size(); ++v) after[self(v)] = before[v];
    for (std::size_t e = 0; e < extra_.size(); ++e) after[of_extra(e)] = before[extra_[e]];
    return after;
  }

 private:
  void mark(const TetMesh& mesh, const std::vector<char>& is_split) {
    marked_.assign(mesh.points.size(), 0);
    for (HalfFace h = 0; h < is_split.size(); ++h)
      if (is_split[h]) for_each_node_of_face(mesh, h, [&](VertexIndex v) { marked_[v] = 1; });
  }

  template <class Visit>
  void for_each_node(const TetMesh& mesh, TetIndex t, const Visit& visit) const {
    for (const VertexIndex v : mesh.tets[t])
      if (marked_[v]) visit(v);
    const std::size_t each = mesh.high_nodes_per_tet();
    for (std::size_t k = 0; k < each; ++k)
      if (const VertexIndex v = mesh.high_nodes[t * each + k]; marked_[v]) visit(v);
    if (!mesh.is_second_order()) return;
    for (const VertexIndex v : mesh.mid_nodes[t])
      if (marked_[v]) visit(v);
  }

  template <class Visit>
  static void for_each_node_of_face(const TetMesh& mesh, HalfFace h, const Visit& visit) {
    const TetIndex t = h / 4;
    const int lacks = static_cast<int>(h % 4);
    for (int i = 0; i < 4; ++i)
      if (i != lacks) visit(mesh.tets[t][static_cast<std::size_t>(i)]);
    const std::size_t each = mesh.high_nodes_per_tet();
    const TetLattice& lattice = tet_lattice(mesh.order());
    for (std::size_t k = 0; k < each; ++k)
      if (lattice.weights(4 + k)[static_cast<std::size_t>(lacks)] == 0) visit(mesh.high_nodes[t * each + k]);
    if (!mesh.is_second_order()) return;
    for (std::size_t e = 0; e < 6; ++e)
      if (kTetEdges[e][0] != lacks && kTetEdges[e][1] != lacks) visit(mesh.mid_nodes[t][e]);
  }

  /// Uses of one node are in one set where a way leads from one element to the other, over faces at the node that stay.
  DisjointSets parts(const TetMesh& mesh, const std::vector<HalfFace>& across,
                     const std::vector<char>& is_split) const {
    DisjointSets sets(uses_.size());
    for (HalfFace h = 0; h < across.size(); ++h) {
      const HalfFace other = across[h];
      if (other == kNone || other < h || is_split[h]) continue;
      for_each_node_of_face(mesh, h, [&](VertexIndex v) {
        if (marked_[v])
          sets.join(static_cast<std::uint32_t>(index(v, h / 4)), static_cast<std::uint32_t>(index(v, other / 4)));
      });
    }
    return sets;
  }

  /// The part with the first element keeps the node.
  void number(DisjointSets parts) {
    std::vector<std::uint32_t> copy(uses_.size(), 0);
    std::uint32_t copies = 0;
    for (std::uint32_t u = 0; u < uses_.size(); ++u) {
      const bool is_first = u == 0 || uses_[u - 1].node != uses_[u].node;
      if (is_first) copies = 0;
      // The least use stands for a part, and comes first.
      if (parts.find(u) == u && !is_first) {
        copy[u] = ++copies;
        extra_.push_back(uses_[u].node);
      }
      uses_[u].copy = copy[parts.find(u)];
    }
  }

  /// Corners come before mid-side nodes, copies too.
  void place(const TetMesh& mesh) {
    corners_ = mesh.points.size();
    for (const auto& mids : mesh.mid_nodes)
      for (const VertexIndex v : mids) corners_ = std::min<std::size_t>(corners_, v);
    for (const VertexIndex v : mesh.high_nodes) corners_ = std::min<std::size_t>(corners_, v);
    points_ = mesh.points.size();
    extra_corners_ = static_cast<VertexIndex>(
        std::lower_bound(extra_.begin(), extra_.end(), static_cast<VertexIndex>(corners_)) - extra_.begin());
  }

  std::size_t first_extra(VertexIndex v) const {
    return static_cast<std::size_t>(std::lower_bound(extra_.begin(), extra_.end(), v) - extra_.begin());
  }
  VertexIndex of_extra(std::size_t e) const {
    return static_cast<VertexIndex>(e < extra_corners_ ? corners_ + e : points_ + e);
  }
  VertexIndex copy_of(VertexIndex v, std::uint32_t copy) const {
    return copy == 0 ? self(v) : of_extra(first_extra(v) + copy - 1);
  }
  std::size_t index(VertexIndex v, TetIndex t) const {
    const auto at = std::lower_bound(uses_.begin(), uses_.end(), std::pair(v, t),
                                     [](const NodeUse& a, const auto& b) { return std::pair(a.node, a.tet) < b; });
    return static_cast<std::size_t>(at - uses_.begin());
  }

  std::vector<char> marked_;        // per node
  std::vector<NodeUse> uses_;       // of marked nodes, ascending
  std::vector<VertexIndex> extra_;  // the nodes that further copies are of, ascending
  std::size_t corners_ = 0, points_ = 0;
  VertexIndex extra_corners_ = 0;
};

/// A face inside that is opened: by which opening, the element at its first side, or in front of it, and the other one.
struct Opened {
  std::uint32_t interface, opening;
  HalfFace plus, minus;
};

class Splitting {
 public:
  Splitting(TetMesh& mesh, Openings openings) : mesh_(mesh), openings_(std::move(openings)) {
    const std::vector<HalfFace> across = half_face_neighbors(mesh.tets, mesh.points.size());
    std::vector<char> is_split(across.size(), 0);
    const FaceTable table = half_face_table(mesh.tets, mesh.points.size());
    for (std::uint32_t f = 0; f < mesh.interfaces.size(); ++f) {
      const auto around = table.group_of(mesh.interfaces[f]);
      const std::uint32_t opening = openings_.find(
          patch_at(mesh.interface_patch, f), region_at(mesh, around[0].face / 4), region_at(mesh, around[1].face / 4));
      if (opening == openings_.list.size()) continue;
      Opened opened{f, opening, kNone, kNone};
      for (const FaceTable::Entry& e : around) {
        is_split[e.face] = 1;
        // The element that looks out as the triangle does lies behind it.
        const bool behind =
            is_even(face_of(mesh.tets[e.face / 4], static_cast<int>(e.face % 4))) == is_even(mesh.interfaces[f]);
        (behind ? opened.minus : opened.plus) = e.face;
      }
      const std::uint32_t first = openings_.list[opening].first_region;
      if (first != kNone && region_at(mesh, opened.plus / 4) != first) std::swap(opened.plus, opened.minus);
      opened_.push_back(opened);
    }
    copies_.emplace(mesh, across, is_split);
    while (leave_closed(is_split)) copies_.emplace(mesh, across, is_split);
    where_ = elements_at(table);
  }

  std::string apply() {
    const TetMesh before = faces_of(mesh_);
    mesh_.points = copies_->points(mesh_.points);
    std::vector<std::vector<std::uint32_t>> edges = move_curves();
    move_elements();
    move_faces(before);
    move_split_faces(before);
    open_faces(before);
    move_wide(before);
    move_periodic(before);
    move_sets(before, edges);
    std::string text =
        fmt::format("{} inside opened, {} doubled", counted(opened_.size(), "face"), counted(copies_->count(), "node"));
    if (closed_ > 0)
      text += fmt::format("; {} with all corners at the end of a sheet {} closed", counted(closed_, "face"),
                          closed_ == 1 ? "stays" : "stay");
    return text;
  }

 private:
  /// What is asked about after it has changed.
  static TetMesh faces_of(const TetMesh& mesh) {
    TetMesh faces;
    faces.tets = mesh.tets;
    faces.mid_nodes = mesh.mid_nodes;
    faces.high_nodes = mesh.high_nodes, faces.high_order = mesh.high_order;
    faces.boundary = mesh.boundary;
    faces.interfaces = mesh.interfaces;
    faces.interface_patch = mesh.interface_patch;
    faces.face_layers = mesh.face_layers;
    return faces;
  }

  /// A face all of whose corners lie at the end of a sheet cannot open, and stays. Whether there was one.
  bool leave_closed(std::vector<char>& is_split) {
    const auto stays = [&](const Opened& o) {
      for (const VertexIndex v : mesh_.interfaces[o.interface])
        if (copies_->at(o.plus / 4, v) != copies_->at(o.minus / 4, v)) return false;
      is_split[o.plus] = is_split[o.minus] = 0;
      return true;
    };
    const std::size_t there = std::erase_if(opened_, stays);
    closed_ += there;
    return there > 0;
  }

  bool touches(const auto& nodes) const {
    return std::any_of(nodes.begin(), nodes.end(), [&](VertexIndex v) { return copies_->is_marked(v); });
  }

  /// Per face of the boundary, and of the interfaces behind it, an element at it; kNone where no node is doubled.
  std::vector<TetIndex> elements_at(const FaceTable& table) const {
    std::vector<TetIndex> at;
    for (const auto* faces : {&mesh_.boundary, &mesh_.interfaces})
      for (const Triangle& f : *faces) at.push_back(touches(f) ? table.group_of(f).front().face / 4 : kNone);
    return at;
  }

  void move_elements() {
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      for (VertexIndex& v : mesh_.tets[t]) v = copies_->at(t, v);
      const std::size_t each = mesh_.high_nodes_per_tet();
      for (std::size_t k = 0; k < each; ++k) {
        VertexIndex& v = mesh_.high_nodes[t * each + k];
        v = copies_->at(t, v);
      }
      if (!mesh_.is_second_order()) continue;
      for (VertexIndex& v : mesh_.mid_nodes[t]) v = copies_->at(t, v);
    }
  }

  void move_faces(const TetMesh& before) {
    const auto move = [&](Triangle& face, TetIndex at) {
      for (VertexIndex& v : face) v = at == kNone ? copies_->self(v) : copies_->at(at, v);
    };
    for (std::size_t f = 0; f < mesh_.boundary.size(); ++f) move(mesh_.boundary[f], where_[f]);
    for (std::size_t f = 0; f < mesh_.interfaces.size(); ++f)
      move(mesh_.interfaces[f], where_[before.boundary.size() + f]);
  }

  /// An edge of a curve has a copy wherever elements at it come apart. Returns the new edges of each.
  std::vector<std::vector<std::uint32_t>> move_curves() {
    std::map<Edge, std::vector<Edge>> copies;
    for (const Edge& e : mesh_.curve_edges)
      if (touches(e)) copies[sorted_edge(e[0], e[1])];
    for (TetIndex t = 0; !copies.empty() && t < mesh_.tets.size(); ++t) {
      if (!touches(mesh_.tets[t])) continue;
      for (const auto& [i, j] : kTetEdges) {
        const VertexIndex a = mesh_.tets[t][static_cast<std::size_t>(i)],
                          b = mesh_.tets[t][static_cast<std::size_t>(j)];
        const auto found = copies.find({std::min(a, b), std::max(a, b)});
        if (found == copies.end()) continue;
        const Edge copy{copies_->at(t, found->first[0]), copies_->at(t, found->first[1])};
        if (std::find(found->second.begin(), found->second.end(), copy) == found->second.end())
          found->second.push_back(copy);
      }
    }
    return take_curves(copies);
  }

  std::vector<std::vector<std::uint32_t>> take_curves(const std::map<Edge, std::vector<Edge>>& copies) {
    std::vector<std::vector<std::uint32_t>> of(mesh_.curve_edges.size());
    std::vector<Edge> edges;
    std::vector<std::uint32_t> curve;
    for (std::size_t e = 0; e < mesh_.curve_edges.size(); ++e) {
      const auto [a, b] = mesh_.curve_edges[e];
      const auto found = copies.find({std::min(a, b), std::max(a, b)});
      const std::vector<Edge> now =
          found == copies.end() ? std::vector{Edge{copies_->self(a), copies_->self(b)}} : found->second;
      for (const Edge& copy : now) {
        of[e].push_back(static_cast<std::uint32_t>(edges.size()));
        edges.push_back(copy);
        if (!mesh_.curve.empty()) curve.push_back(mesh_.curve[e]);
      }
    }
    mesh_.curve_edges = std::move(edges);
    mesh_.curve = std::move(curve);
    return of;
  }

  void move_wide(const TetMesh& before) {
    for (WideCell& cell : mesh_.wide_cells)
      for (VertexIndex& v : cell.nodes) {
        if (v == kNone) continue;
        TetIndex at = cell.first;
        while (std::find(before.tets[at].begin(), before.tets[at].end(), v) == before.tets[at].end()) ++at;
        v = copies_->at(at, v);
      }
    for (WideFace& face : mesh_.wide_faces)
      for (VertexIndex& v : face.nodes) {
        const bool in_first = std::find(before.boundary[face.first].begin(), before.boundary[face.first].end(), v) !=
                              before.boundary[face.first].end();
        const TetIndex at = where_[face.first + (in_first ? 0 : 1)];
        v = at == kNone ? copies_->self(v) : copies_->at(at, v);
      }
  }

  /// The faces become boundary, at its end: first those of the elements in front, then those behind.
  void open_faces(const TetMesh& before) {
    if (mesh_.patch.empty()) mesh_.patch.assign(mesh_.boundary.size(), 0);
    name_sides();
    const auto add = [&](HalfFace h, std::uint32_t patch) {
      mesh_.boundary.push_back(face_of(mesh_.tets[h / 4], static_cast<int>(h % 4)));
      mesh_.patch.push_back(patch);
      if (!mesh_.source.empty()) mesh_.source.push_back(kNone);
    };
    const auto sides = [&](const Opened& o) { return openings_.list[o.opening].patches; };
    for (const Opened& o : opened_) add(o.plus, sides(o)[0]);
    for (const Opened& o : opened_) add(o.minus, sides(o)[1]);
    for (const Opened& o : opened_) {
      SplitFace pair{{}, sides(o)[0]};
      const Triangle tri = face_of(before.tets[o.minus / 4], static_cast<int>(o.minus % 4));
      for (std::size_t i = 0; i < 3; ++i) {
        pair.nodes[i] = copies_->at(o.minus / 4, tri[i]);
        pair.nodes[3 + i] = copies_->at(o.plus / 4, tri[i]);
      }
      mesh_.split_faces.push_back(pair);
    }
    std::stable_sort(mesh_.split_faces.begin(), mesh_.split_faces.end(),
                     [](const SplitFace& a, const SplitFace& b) { return a.patch < b.patch; });
    drop_interfaces(before);
    note_contacts();
  }

  /// Faces that were split before have the nodes of their elements.
  void move_split_faces(const TetMesh& before) {
    if (mesh_.split_faces.empty()) return;
    const FaceTable faces = face_table(copies_->old_points(), before.boundary);
    for (SplitFace& face : mesh_.split_faces)
      for (const std::size_t first : {0, 3}) {
        const auto nodes = std::span(face.nodes).subspan(first, 3);
        const TetIndex at = where_[faces.group_of({nodes[0], nodes[1], nodes[2]}).front().face];
        for (VertexIndex& v : nodes) v = at == kNone ? copies_->self(v) : copies_->at(at, v);
      }
  }

  /// New patches come behind the others, the first side of each opening before its second.
  void name_sides() {
    auto next = static_cast<std::uint32_t>(mesh_.patch_names.size());
    for (const auto* patch : {&mesh_.patch, &mesh_.interface_patch})
      for (const std::uint32_t p : *patch) next = std::max(next, p + 1);
    for (Opening& opening : openings_.list)
      for (std::size_t side = 0; side < 2; ++side) {
        if (opening.patches[side] == kNone) opening.patches[side] = next++;
        mesh_.patch_names.resize(next);
        mesh_.patch_names[opening.patches[side]] = opening.names[side];
      }
  }

  void note_contacts() {
    std::vector<char> is_open(openings_.list.size(), 0);
    for (const Opened& o : opened_) is_open[o.opening] = 1;
    for (std::size_t i = 0; i < is_open.size(); ++i)
      if (const auto [first, second] = openings_.list[i].patches; is_open[i])
        mesh_.opened_contacts.push_back({first, second, 1});
    std::ranges::stable_sort(mesh_.opened_contacts, {}, &OpenedContact::first);
  }

  void drop_interfaces(const TetMesh& before) {
    std::vector<char> gone(before.interfaces.size(), 0);
    for (const Opened& o : opened_) gone[o.interface] = 1;
    face_now_.assign(gone.size(), kNone);
    std::uint32_t kept = 0;
    for (std::size_t f = 0; f < gone.size(); ++f) {
      if (gone[f]) continue;
      mesh_.interfaces[kept] = mesh_.interfaces[f];
      if (!mesh_.interface_patch.empty()) mesh_.interface_patch[kept] = mesh_.interface_patch[f];
      face_now_[f] = kept++;
    }
    mesh_.interfaces.resize(kept);
    if (!mesh_.interface_patch.empty()) mesh_.interface_patch.resize(kept);
    if (before.face_layers.empty()) return;
    mesh_.face_layers.resize(before.boundary.size());
    mesh_.face_layers.resize(mesh_.boundary.size(), kNone);
    for (std::size_t f = 0; f < gone.size(); ++f)
      if (!gone[f]) mesh_.face_layers.push_back(before.face_layers[before.boundary.size() + f]);
  }

  /// Of nodes that are doubled those copies are a pair that faces at both ends of the period have at one place.
  void move_periodic(const TetMesh& before) {
    if (mesh_.periodic_nodes.empty()) return;
    std::set<std::array<std::uint32_t, 3>> pairs;
    std::vector<std::map<VertexIndex, VertexIndex>> original(mesh_.periods.size());
    for (const auto& [period, copy, of] : mesh_.periodic_nodes) {
      original[period][copy] = of;
      if (!copies_->is_marked(copy) && !copies_->is_marked(of))
        pairs.insert({period, copies_->self(copy), copies_->self(of)});
    }
    const FaceTable faces = face_table(copies_->old_points(), before.boundary);
    for (std::uint32_t k = 0; k < original.size(); ++k)
      for (std::uint32_t f = 0; f < before.boundary.size(); ++f)
        if (where_[f] != kNone) pair_face(before, faces, f, k, original[k], pairs);
    mesh_.periodic_nodes.assign(pairs.begin(), pairs.end());
  }

  void pair_face(const TetMesh& before, const FaceTable& faces, std::uint32_t f, std::uint32_t period,
                 const std::map<VertexIndex, VertexIndex>& original,
                 std::set<std::array<std::uint32_t, 3>>& pairs) const {
    Triangle of{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto found = original.find(before.boundary[f][i]);
      if (found == original.end()) return;
      of[i] = found->second;
    }
    const auto group = faces.group_of(of);
    if (group.empty()) return;
    const TetIndex here = where_[f], there = where_[group.front().face];
    const auto pair = [&](VertexIndex copy, VertexIndex first) {
      pairs.insert(
          {period, copies_->at(here, copy), there == kNone ? copies_->self(first) : copies_->at(there, first)});
    };
    for (std::size_t i = 0; i < 3; ++i) pair(before.boundary[f][i], of[i]);
    if (before.mid_nodes.empty() || there == kNone) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      pair(mid_node(before, here, before.boundary[f][i], before.boundary[f][j]), mid_node(before, there, of[i], of[j]));
    }
  }

  static VertexIndex mid_node(const TetMesh& mesh, TetIndex t, VertexIndex a, VertexIndex b) {
    const std::size_t e = edge_between(mesh.tets[t], a, b);
    return e < 6 ? mesh.mid_nodes[t][e] : kNone;
  }

  void move_sets(const TetMesh& before, const std::vector<std::vector<std::uint32_t>>& edges) {
    for (NamedSet& set : mesh_.sets) {
      std::vector<std::uint32_t> members;
      for (const std::uint32_t m : set.members) {
        if (set.kind == Kind::kElements) members.push_back(m);
        if (set.kind == Kind::kNodes)
          for (const VertexIndex v : copies_->all(m)) members.push_back(v);
        if (set.kind == Kind::kEdges) members.insert(members.end(), edges[m].begin(), edges[m].end());
        if (set.kind != Kind::kFaces) continue;
        const std::size_t f = m - before.boundary.size();
        if (m < before.boundary.size())
          members.push_back(m);
        else if (face_now_[f] != kNone)
          members.push_back(static_cast<std::uint32_t>(mesh_.boundary.size()) + face_now_[f]);
        else
          for (const std::size_t side : {0, 1}) members.push_back(side_now(before, f, side));
      }
      std::sort(members.begin(), members.end());
      set.members = std::move(members);
    }
    std::erase_if(mesh_.sets, [](const NamedSet& set) { return set.members.empty(); });
  }

  /// The face of the boundary that a side of an opened interface has become.
  std::uint32_t side_now(const TetMesh& before, std::size_t interface, std::size_t side) const {
    const auto at = std::ranges::lower_bound(opened_, interface, {}, &Opened::interface) - opened_.begin();
    return static_cast<std::uint32_t>(before.boundary.size() + side * opened_.size() + static_cast<std::size_t>(at));
  }

  TetMesh& mesh_;
  Openings openings_;
  std::vector<Opened> opened_;
  std::size_t closed_ = 0;
  std::optional<NodeCopies> copies_;
  std::vector<TetIndex> where_;          // per face of the boundary and of the interfaces, as they were
  std::vector<std::uint32_t> face_now_;  // per interface as it was
};

}  // namespace

std::vector<std::string> split_patches(TetMesh& mesh, const std::vector<std::string>& places) {
  std::vector<char> inside;
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f) note_inside(inside, patch_at(mesh.interface_patch, f));
  const std::vector<Asked> asked = asked_for(places, mesh.patch_names, inside);
  if (asked.empty()) return {};
  return {Splitting(mesh, openings_of(asked)).apply()};
}

std::vector<std::string> split_contacts(TetMesh& mesh, const std::vector<std::uint32_t>& patches) {
  Openings openings = openings_of(mesh, patches);
  if (openings.list.empty()) return {};
  const std::string count = counted(openings.list.size(), "contact");
  return {fmt::format("{} opened: {}", count, Splitting(mesh, std::move(openings)).apply())};
}

std::vector<std::uint32_t> contacts_of(const TetMesh& mesh) {
  std::set<std::uint32_t> patches;
  for (const auto& [key, faces] : faces_of_contacts(mesh)) patches.insert(key[0]);
  return {patches.begin(), patches.end()};
}

void check_split(const SurfaceMesh& complex, const std::vector<std::string>& places) {
  std::vector<char> inside;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const Sides sides = complex.sides_of(t);
    if (sides[0] != kNone && sides[1] != kNone) note_inside(inside, complex.patch_of(t));
  }
  asked_for(places, complex.patch_names, inside);
}

}  // namespace octafront
