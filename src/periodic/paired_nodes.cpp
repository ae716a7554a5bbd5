#include "periodic/paired_nodes.h"

#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/quadratic_tet.h"
#include "base/mesh/face_nodes.h"
#include "base/mesh/periodic_nodes.h"
#include "base/mesh/quadratic_nodes.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// {period, copy, original}, as in TetMesh::periodic_nodes.
using NodePair = std::array<std::uint32_t, 3>;

/// A face that is a copy, and its original, corner by corner.
struct FacePair {
  std::uint32_t period;
  Triangle copy, original;
};

[[noreturn]] void refuse_faces(const TetMesh& mesh, const PeriodicCell& cell, int period, VertexIndex v) {
  throw FacesDiffer(fmt::format("opposite faces along {} did not become the same around {}: a smaller size may help",
                                cell.name_of_period(period), at_point(mesh.points[v])));
}

/// The faces of a mesh of a cell, by where their corners are.
class FacesByPlace {
 public:
  FacesByPlace(const PeriodicCell& cell, const TetMesh& mesh) : cell_(cell), mesh_(mesh) {}

  std::vector<FacePair> run() {
    std::uint32_t number = 0;
    for (const int k : cell_.periods_there()) find(k, number++);
    return std::move(found_);
  }

 private:
  std::vector<Triangle> triangles_on(CellFace face) const {
    std::vector<Triangle> all;
    for (std::size_t f = 0; f < mesh_.boundary.size(); ++f) {
      const auto& [a, b, c] = mesh_.boundary[f];
      const std::uint32_t patch = mesh_.patch.empty() ? 0 : mesh_.patch[f];
      if (face_of_cell(cell_, patch, mesh_.points[a], mesh_.points[b], mesh_.points[c]) == face)
        all.push_back(mesh_.boundary[f]);
    }
    return all;
  }

  void find(int k, std::uint32_t number) {
    const CellFace face = 2 * static_cast<CellFace>(k);
    const std::vector<Triangle> originals = triangles_on(face), copies = triangles_on(face + 1);
    VerticesByPlace at;
    std::vector<Triangle> known;
    for (const Triangle& t : copies) {
      for (const VertexIndex v : t) at.add(mesh_.points[v], v);
      known.push_back(face_key(t));
    }
    std::ranges::sort(known);
    for (const Triangle& t : originals) {
      Triangle copy{};
      for (int i = 0; i < 3; ++i)
        if ((copy[i] = at.find(cell_.to_high(mesh_.points[t[i]], k))) == kNone) refuse_faces(mesh_, cell_, k, t[i]);
      if (!std::ranges::binary_search(known, face_key(copy))) refuse_faces(mesh_, cell_, k, t[0]);
      found_.push_back({number, copy, t});
    }
    if (originals.size() != copies.size())
      refuse_faces(mesh_, cell_, k, originals.empty() ? copies[0][0] : originals[0][0]);
  }

  const PeriodicCell& cell_;
  const TetMesh& mesh_;
  std::vector<FacePair> found_;
};

/// The same by the pairs of the mesh.
std::vector<FacePair> faces_by_pairs(const TetMesh& mesh) {
  const Originals originals(mesh);
  std::vector<FacePair> found;
  for (std::uint32_t k = 0; k < mesh.periods.size(); ++k)
    for (const Triangle& copy : mesh.boundary)
      if (const std::optional<Triangle> original = originals.of(k, copy)) found.push_back({k, copy, *original});
  return found;
}

enum class Nodes { kAll, kBehindCorners };

/// The pairs of nodes of these faces, ascending; nodes on the axis of a rotation, which are their own copies, in none.
std::vector<NodePair> pairs_of(const TetMesh& mesh, const std::vector<FacePair>& faces, Nodes which) {
  std::map<std::array<std::uint32_t, 2>, VertexIndex> original_of;
  std::optional<FaceNodes> nodes;
  if (mesh.order() > 1) nodes.emplace(mesh);
  for (const FacePair& face : faces) {
    for (std::size_t i = 0; i < 3 && which == Nodes::kAll; ++i)
      original_of[{face.period, face.copy[i]}] = face.original[i];
    if (!nodes || !nodes->has(face.original)) continue;
    visit_nodes_behind_corners(mesh.order(), [&](const FaceNodes::Weights& weights) {
      original_of[{face.period, nodes->node(face.copy, weights)}] = nodes->node(face.original, weights);
    });
  }
  std::vector<NodePair> pairs;
  for (const auto& [copy, original] : original_of)
    if (copy[1] != original) pairs.push_back({copy[0], copy[1], original});
  return pairs;
}

/// Brings nodes behind corners to where they have copies, and copies to where their originals lead.
class PairedNodes {
 public:
  /// Without a cell originals stay.
  PairedNodes(TetMesh& mesh, const std::vector<NodePair>& pairs, const PeriodicCell* cell)
      : mesh_(mesh), cell_(cell), set_(mesh.points.size()), place_(mesh.points.size()), pairs_(pairs) {
    find_places();
    std::vector<std::uint8_t> is_copy(mesh.points.size(), 0);
    for (const auto& [period, copy, original] : pairs) {
      set_.join(copy, original);
      is_copy[copy] = 1;
    }
    for (const auto& [period, copy, original] : pairs)
      if (!is_copy[original]) first_[set_.find(original)] = original;
  }

  std::uint64_t run() {
    for (const auto& [set, node] : first_) mesh_.points[node] = settled(mesh_.points[node], node);
    follow();
    std::uint64_t straightened = 0;
    while (const std::uint64_t now = straighten_bad()) {
      straightened += now;
      follow();
    }
    return straightened;
  }

 private:
  /// The corners that a node lies between, and how it counts them.
  struct Place {
    std::array<VertexIndex, 3> corners{};
    std::array<int, 3> weights{};
    std::size_t count = 0;
  };

  void find_places() {
    const FaceNodes nodes(mesh_);
    for (const Triangle& face : mesh_.boundary)
      visit_nodes_behind_corners(mesh_.order(), [&](const FaceNodes::Weights& weights) {
        Place place;
        for (std::size_t i = 0; i < 3; ++i)
          if (weights[i] > 0) place.corners[place.count] = face[i], place.weights[place.count++] = weights[i];
        place_[nodes.node(face, weights)] = place;
      });
  }

  /// Where an original near a place lies so that it has an exact copy: in the low faces that all its corners are in.
  Vec3 settled(Vec3 p, VertexIndex node) const {
    if (cell_ == nullptr) return p;
    if (!cell_->is_box()) return cell_->on_grid(p);
    const Place& place = place_[node];
    for (const int k : cell_->periods_there())
      if (std::ranges::all_of(std::span(place.corners).first(place.count),
                              [&](VertexIndex v) { return cell_->is_low(mesh_.points[v], k); }))
        p = cell_->to_low(p, k);
    return p;
  }

  Vec3 straight(VertexIndex node) const {
    const Place& place = place_[node];
    Vec3 sum;
    for (std::size_t i = 0; i < place.count; ++i) sum += place.weights[i] * mesh_.points[place.corners[i]];
    return sum / mesh_.order();
  }

  std::span<const VertexIndex> behind_corners(TetIndex t) const {
    if (mesh_.is_second_order()) return mesh_.mid_nodes[t];
    return std::span(mesh_.high_nodes).subspan(t * mesh_.high_nodes_per_tet(), mesh_.high_nodes_per_tet());
  }
  bool is_valid(TetIndex t) const {
    std::array<Vec3, 35> room;
    if (mesh_.is_second_order()) return has_positive_jacobian(quadratic_nodes(mesh_, t));
    return validity_of(mesh_.order(), nodes_of_tet(mesh_, t, room)) == Validity::kValid;
  }

  /// Copies come to where their originals lead: after as many rounds as there are periods all are there.
  void follow() {
    for (std::size_t round = 0; round < mesh_.periods.size(); ++round)
      for (const auto& [period, copy, original] : pairs_)
        mesh_.points[copy] = led_by_period(mesh_, period, mesh_.points[original]);
  }

  std::uint64_t straighten_bad() {
    std::vector<std::uint8_t> is_paired(mesh_.points.size(), 0), is_bad(mesh_.points.size(), 0);
    for (const auto& [period, copy, original] : pairs_) is_paired[copy] = is_paired[original] = 1;
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      const auto behind = behind_corners(t);
      if (std::none_of(behind.begin(), behind.end(), [&](VertexIndex v) { return is_paired[v] != 0; })) continue;
      if (is_valid(t)) continue;
      for (const VertexIndex v : behind)
        if (is_paired[v]) is_bad[set_.find(v)] = 1;
    }
    std::uint64_t changed = 0;
    for (const auto& [set, node] : first_) {
      if (!is_bad[set]) continue;
      const Vec3 to = settled(straight(node), node);
      changed += mesh_.points[node] != to;
      mesh_.points[node] = to;
    }
    return changed;
  }

  TetMesh& mesh_;
  const PeriodicCell* cell_;
  DisjointSets set_;          ///< of nodes that are copies
  std::vector<Place> place_;  ///< per node; of corners, and what is inside, none
  const std::vector<NodePair>& pairs_;
  std::map<std::uint32_t, VertexIndex> first_;  ///< per set the node that is no copy
};

void leave_periods(const PeriodicCell& cell, TetMesh& mesh) {
  mesh.periods.clear(), mesh.period_rotations.clear();
  const bool turns = std::ranges::any_of(cell.mapped, [](const MappedFaces& faces) { return faces.map.turns(); });
  for (const int k : cell.periods_there()) {
    Vec3 period;
    if (cell.is_box())
      period[k] = cell.period(k);
    else
      period = cell.mapped[static_cast<std::size_t>(k)].map.shift();
    mesh.periods.push_back(period);
    if (turns) mesh.period_rotations.push_back(cell.mapped[static_cast<std::size_t>(k)].map.matrix());
  }
}

}  // namespace

void pair_nodes_on_faces(const PeriodicCell& cell, TetMesh& mesh) {
  leave_periods(cell, mesh);
  mesh.periodic_nodes = pairs_of(mesh, FacesByPlace(cell, mesh).run(), Nodes::kAll);
  for (const auto& [period, copy, original] : mesh.periodic_nodes)
    if (led_by_period(mesh, period, mesh.points[original]) != mesh.points[copy])
      refuse_faces(mesh, cell, cell.periods_there()[period], copy);
}

std::uint64_t bring_copies_behind_corners(const PeriodicCell& cell, TetMesh& mesh) {
  leave_periods(cell, mesh);
  const std::vector<NodePair> pairs = pairs_of(mesh, FacesByPlace(cell, mesh).run(), Nodes::kBehindCorners);
  return PairedNodes(mesh, pairs, &cell).run();
}

void pair_nodes_behind_corners(TetMesh& mesh) {
  const std::vector<NodePair> pairs = pairs_of(mesh, faces_by_pairs(mesh), Nodes::kBehindCorners);
  PairedNodes(mesh, pairs, nullptr).run();
  mesh.periodic_nodes.insert(mesh.periodic_nodes.end(), pairs.begin(), pairs.end());
  std::ranges::sort(mesh.periodic_nodes);
}

std::vector<VertexIndex> paired_vertices(const TetMesh& mesh) {
  std::vector<VertexIndex> paired;
  for (const auto& [period, copy, original] : mesh.periodic_nodes)
    for (const VertexIndex v : {copy, original})
      if (v < mesh.points.size()) paired.push_back(v);
  std::ranges::sort(paired);
  paired.erase(std::unique(paired.begin(), paired.end()), paired.end());
  return paired;
}

}  // namespace octafront
