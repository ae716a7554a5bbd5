#include "pipeline/stages/paired_nodes.h"

#include "base/core/disjoint_sets.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/quadratic_tet.h"
#include "base/mesh/face_nodes.h"
#include "base/mesh/quadratic_nodes.h"

#include <array>
#include <map>

namespace octafront {

namespace {

class PairedNodes {
 public:
  PairedNodes(TetMesh& mesh, const std::vector<NodeLink>& links, const Repeats& repeats)
      : mesh_(mesh), repeats_(repeats), set_(mesh.points.size()), place_(mesh.points.size()), links_(links) {
    find_places();
    std::vector<std::uint8_t> is_copy(mesh.points.size(), 0);
    for (const NodeLink& link : links) {
      set_.join(link.copy, link.original);
      is_copy[link.copy] = 1;
    }
    for (const NodeLink& link : links)
      if (!is_copy[link.original]) first_[set_.find(link.original)] = link.original;
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

  Vec3 settled(Vec3 p, VertexIndex node) const {
    const Place& place = place_[node];
    return repeats_.settled(p, std::span(place.corners).first(place.count));
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
    for (std::uint32_t k = 0; k < repeats_.periods; ++k)
      for (const NodeLink& link : links_)
        mesh_.points[link.copy] = repeats_.copied(link.period, mesh_.points[link.original]);
  }

  std::uint64_t straighten_bad() {
    std::vector<std::uint8_t> is_linked(mesh_.points.size(), 0), is_bad(mesh_.points.size(), 0);
    for (const NodeLink& link : links_) is_linked[link.copy] = is_linked[link.original] = 1;
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      const auto behind = behind_corners(t);
      if (std::none_of(behind.begin(), behind.end(), [&](VertexIndex v) { return is_linked[v] != 0; })) continue;
      if (is_valid(t)) continue;
      for (const VertexIndex v : behind)
        if (is_linked[v]) is_bad[set_.find(v)] = 1;
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
  const Repeats& repeats_;
  DisjointSets set_;          ///< of nodes that are copies
  std::vector<Place> place_;  ///< per node; of corners, and what is inside, none
  const std::vector<NodeLink>& links_;
  std::map<std::uint32_t, VertexIndex> first_;  ///< per set the node that is no copy
};

}  // namespace

std::uint64_t pair_nodes_behind_corners(TetMesh& mesh, const std::vector<NodeLink>& links, const Repeats& repeats) {
  return PairedNodes(mesh, links, repeats).run();
}

}  // namespace octafront
