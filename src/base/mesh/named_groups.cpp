#include <octafront/named_groups.h>

#include "base/mesh/curve_names.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>

#include <fmt/core.h>

namespace octafront {
namespace {

using Kind = NamedSet::Kind;

/// Per place the vertex of a mesh that is at the same coordinates; kNone where there is none.
std::vector<VertexIndex> same_places(std::span<const Vec3> from, const TetMesh& to) {
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::uint64_t hash = 0;
      for (const double x : p) {
        std::uint64_t bits;
        std::memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15ull;
        hash ^= hash >> 32;
      }
      return static_cast<std::size_t>(hash);
    }
  };
  // -0 and 0 are one place.
  const auto key = [](Vec3 p) { return std::array<double, 3>{p.x + 0.0, p.y + 0.0, p.z + 0.0}; };
  std::unordered_map<std::array<double, 3>, VertexIndex, Hash> at;
  at.reserve(to.points.size());
  for (VertexIndex v = 0; v < to.points.size(); ++v) at.emplace(key(to.points[v]), v);
  std::vector<VertexIndex> place;
  place.reserve(from.size());
  for (const Vec3& p : from) {
    const auto found = at.find(key(p));
    place.push_back(found == at.end() ? kNone : found->second);
  }
  return place;
}

/// Adds sets whose members are at given places.
class Placing {
 public:
  explicit Placing(TetMesh& mesh) : mesh_(mesh) {}

  /// Adds what the mesh has of a set; returns how many members it lacks.
  std::size_t add(const PlacedSet& placed) {
    NamedSet set{placed.name, placed.kind, {}};
    const std::vector<VertexIndex> at = same_places(placed.places, mesh_);
    const std::size_t each = placed.each(), wanted = at.size() / each;
    for (std::size_t i = 0; i < wanted; ++i) {
      const std::span<const VertexIndex> vertices = std::span(at).subspan(each * i, each);
      const bool is_there = std::find(vertices.begin(), vertices.end(), kNone) == vertices.end();
      if (const std::uint32_t m = is_there ? member(vertices) : kNone; m != kNone) set.members.push_back(m);
    }
    const std::size_t lacks = wanted - set.members.size();
    std::sort(set.members.begin(), set.members.end());
    set.members.erase(std::unique(set.members.begin(), set.members.end()), set.members.end());
    if (!set.members.empty() && (lacks == 0 || medit_set(set) != nullptr)) mesh_.sets.push_back(std::move(set));
    return lacks;
  }

 private:
  std::uint32_t member(std::span<const VertexIndex> vertices) {
    if (vertices.size() == 1) return vertices[0];
    return vertices.size() == 2 ? edge(vertices[0], vertices[1]) : face({vertices[0], vertices[1], vertices[2]});
  }

  std::uint32_t face(const Triangle& triangle) {
    if (!table_) {
      faces_ = mesh_.boundary;
      faces_.insert(faces_.end(), mesh_.interfaces.begin(), mesh_.interfaces.end());
      table_.emplace(face_table(mesh_.points.size(), faces_));
    }
    const auto group = table_->group_of(triangle);
    return group.empty() ? kNone : group.front().face;
  }

  /// An edge of the walls that is none of a curve becomes one.
  std::uint32_t edge(VertexIndex a, VertexIndex b) {
    if (edges_.empty()) list_edges();
    const auto found = edges_.find({std::min(a, b), std::max(a, b)});
    if (found == edges_.end()) return kNone;
    if (found->second == kNone) {
      found->second = static_cast<std::uint32_t>(mesh_.curve_edges.size());
      mesh_.curve_edges.push_back({a, b});
      mesh_.curve.resize(found->second, 0);
      mesh_.curve.push_back(new_curve_);
    }
    return found->second;
  }

  void list_edges() {
    for (const auto* faces : {&mesh_.boundary, &mesh_.interfaces})
      for (const Triangle& t : *faces)
        for (std::size_t i = 0; i < 3; ++i) {
          const VertexIndex a = t[i], b = t[(i + 1) % 3];
          edges_[{std::min(a, b), std::max(a, b)}] = kNone;
        }
    for (std::uint32_t e = 0; e < mesh_.curve_edges.size(); ++e) {
      const auto& [a, b] = mesh_.curve_edges[e];
      edges_[{std::min(a, b), std::max(a, b)}] = e;
    }
    new_curve_ = static_cast<std::uint32_t>(std::max(mesh_.curve_names.size(), mesh_.curve_labels.size()));
    if (mesh_.curve.empty() && !mesh_.curve_edges.empty()) new_curve_ = std::max(new_curve_, 1u);
    for (const std::uint32_t c : mesh_.curve) new_curve_ = std::max(new_curve_, c + 1);
  }

  TetMesh& mesh_;
  std::vector<Triangle> faces_;
  std::optional<FaceTable> table_;       ///< of faces_
  std::map<Edge, std::uint32_t> edges_;  ///< of walls and curves, and their places among those of curves
  std::uint32_t new_curve_ = 0;
};

std::vector<Vec3> places_of_members(const TetMesh& mesh, const NamedSet& set) {
  std::vector<Vec3> places;
  const auto add = [&](const auto& row) {
    for (const VertexIndex v : row) places.push_back(mesh.points[v]);
  };
  for (const std::uint32_t m : set.members) {
    if (set.kind == Kind::kNodes) places.push_back(mesh.points[m]);
    if (set.kind == Kind::kEdges) add(mesh.curve_edges[m]);
    if (set.kind == Kind::kFaces)
      add(m < mesh.boundary.size() ? mesh.boundary[m] : mesh.interfaces[m - mesh.boundary.size()]);
  }
  return places;
}

}  // namespace

const MeditSet* medit_set(const NamedSet& set) {
  const auto is_it = [&](const MeditSet& known) { return known.name == set.name && known.kind == set.kind; };
  const auto found = std::find_if(kMeditSets.begin(), kMeditSets.end(), is_it);
  return found == kMeditSets.end() ? nullptr : &*found;
}

bool keeps_vertices(const PlacedSet& set) {
  const MeditSet* const known = medit_set({set.name, set.kind, {}});
  return known != nullptr && (known->is_required || known->kind == Kind::kNodes);
}

std::vector<VertexIndex> required_vertices(const TetMesh& mesh) {
  std::vector<VertexIndex> all;
  const auto add = [&](const auto& row) { all.insert(all.end(), row.begin(), row.end()); };
  for (const NamedSet& set : mesh.sets) {
    const MeditSet* const known = medit_set(set);
    if (known == nullptr || !known->is_required) continue;
    for (const std::uint32_t m : set.members) {
      if (set.kind == Kind::kNodes) all.push_back(m);
      if (set.kind == Kind::kEdges) add(mesh.curve_edges[m]);
      if (set.kind == Kind::kFaces)
        add(m < mesh.boundary.size() ? mesh.boundary[m] : mesh.interfaces[m - mesh.boundary.size()]);
      if (set.kind == Kind::kElements) add(mesh.tets[m]);
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<PlacedSet> placed_sets(const TetMesh& mesh) {
  std::vector<PlacedSet> sets;
  for (const NamedSet& set : mesh.sets)
    if (set.kind != Kind::kElements) sets.push_back({set.name, set.kind, places_of_members(mesh, set)});
  return sets;
}

std::string add_placed_sets(TetMesh& mesh, std::span<const PlacedSet> sets) {
  Placing placing(mesh);
  std::string missing;
  for (const PlacedSet& set : sets)
    if (const std::size_t lacks = placing.add(set); lacks > 0)
      missing += fmt::format("{}\"{}\" ({} of {} {} missing)", missing.empty() ? "" : ", ", set.name, lacks,
                             set.places.size() / set.each(),
                             set.kind == Kind::kNodes   ? "nodes"
                             : set.kind == Kind::kEdges ? "edges"
                                                        : "faces");
  return missing.empty() ? missing
                         : "sets that the new mesh has not, or not whole, for it has other nodes there: " + missing;
}

void add_patch_curves(TetMesh& mesh) {
  if ((mesh.patch.empty() && mesh.interfaces.empty()) || !mesh.curve_edges.empty()) return;
  std::vector<Triangle> faces = mesh.boundary;
  faces.insert(faces.end(), mesh.interfaces.begin(), mesh.interfaces.end());
  const auto patch_of = [&](std::uint32_t face) {
    const bool is_inside = face >= mesh.boundary.size();
    const auto& patch = is_inside ? mesh.interface_patch : mesh.patch;
    return patch.empty() ? 0 : patch[is_inside ? face - mesh.boundary.size() : face];
  };
  const EdgeTable table = make_edge_table(mesh.points.size(), faces);
  std::map<std::vector<std::uint32_t>, std::uint32_t> curve_of;
  for (std::size_t e = 0; e < table.size(); ++e) {
    std::vector<std::uint32_t> patches;
    for (const HalfEdge h : table.uses(e)) patches.push_back(patch_of(h / 3));
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    if (patches.size() < 2 && table.uses(e).size() == 2) continue;
    mesh.curve_edges.push_back(table.edges[e]);
    mesh.curve.push_back(curve_of.try_emplace(patches, static_cast<std::uint32_t>(curve_of.size())).first->second);
  }
  mesh.curve_names.assign(curve_of.size(), {});
  for (const auto& [patches, curve] : curve_of) mesh.curve_names[curve] = curve_name(patches, mesh.patch_names);
}

}  // namespace octafront
