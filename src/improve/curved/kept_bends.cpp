#include "improve/curved/kept_bends.h"

#include "base/core/parallel.h"
#include "base/geometry/curved_tet.h"
#include "base/mesh/face_table.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/node_places.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <tuple>

namespace octafront::curved {

namespace {

/// In parts of an edge: files round to some digits.
constexpr double kStraightKept = 1e-9;

std::tuple<double, double, double> by_coordinates(Vec3 p) {
  return {p.x, p.y, p.z};
}

class KeptBends {
 public:
  KeptBends(const TetMesh& mesh, const TetMesh& before, int order)
      : mesh_(mesh),
        before_(before),
        order_(order),
        edges_(edges_of_tets(before.tets, before.points.size(), edges_of_tet_)),
        faces_(faces_of_tets(before.tets, before.points.size())) {
    match_corners();
    tet_of_edge_.assign(edges_.size(), kNone);
    tet_of_face_.assign(faces_.corners.size(), kNone);
    for (TetIndex t = 0; t < before.tets.size(); ++t) {
      for (const std::uint32_t e : edges_of_tet_[t]) tet_of_edge_[e] = t;
      for (const std::uint32_t f : faces_.of_tet[t]) tet_of_face_[f] = t;
    }
  }

  Bends run() const {
    Bends bends;
    std::vector<std::array<std::uint32_t, 6>> of_tet;
    const TetEdges edges = edges_of_tets(mesh_.tets, mesh_.points.size(), of_tet);
    take(edges.size(), bends.edges, [&](std::size_t e) { return bend_of_edge({edges.low[e], edges.high[e]}); });
    if (nodes_in_face(order_) == 0) return bends;
    const TetFaces faces = faces_of_tets(mesh_.tets, mesh_.points.size());
    take(faces.corners.size(), bends.faces, [&](std::size_t f) { return bend_of_face(faces.corners[f]); });
    return bends;
  }

 private:
  /// The corner of `before` at each corner of the mesh; of several at one place the first.
  void match_corners() {
    std::vector<char> is_corner(before_.points.size(), 0);
    for (const Tet& tet : before_.tets)
      for (const VertexIndex v : tet) is_corner[v] = 1;
    std::vector<VertexIndex> sorted;
    for (VertexIndex v = 0; v < is_corner.size(); ++v)
      if (is_corner[v]) sorted.push_back(v);
    const auto place = [&](VertexIndex v) { return by_coordinates(before_.points[v]); };
    std::ranges::stable_sort(sorted, {}, place);
    was_.assign(mesh_.points.size(), kNone);
    parallel_for(was_.size(), [&](std::size_t v) {
      const auto here = by_coordinates(mesh_.points[v]);
      const auto found = std::ranges::lower_bound(sorted, here, {}, place);
      if (found != sorted.end() && place(*found) == here) was_[v] = *found;
    });
  }

  template <class Bend, class BendOf>
  static void take(std::size_t count, std::vector<Bend>& bends, const BendOf& bend_of) {
    std::vector<std::optional<Bend>> all(count);
    parallel_for(count, [&](std::size_t i) { all[i] = bend_of(i); });
    for (const std::optional<Bend>& bend : all)
      if (bend) bends.push_back(*bend);
  }

  template <std::size_t kCorners>
  std::optional<std::array<VertexIndex, kCorners>> before(const std::array<VertexIndex, kCorners>& corners) const {
    std::array<VertexIndex, kCorners> were;
    for (std::size_t i = 0; i < kCorners; ++i)
      if ((were[i] = was_[corners[i]]) == kNone) return std::nullopt;
    return were;
  }

  std::optional<EdgeBend> bend_of_edge(const Edge& edge) const {
    const auto were = before(edge);
    if (!were) return std::nullopt;
    const std::uint32_t e = edges_.find((*were)[0], (*were)[1]);
    if (e == kNone) return std::nullopt;
    EdgeBend bend{edge, {}};
    const auto in_part = [&](std::size_t k) { return in_edge(order_, k); };
    if (!fill(tet_of_edge_[e], edge, *were, nodes_in_edge(order_), in_part, bend.by)) return std::nullopt;
    return bend;
  }

  std::optional<FaceBend> bend_of_face(const Triangle& face) const {
    const auto were = before(face);
    if (!were) return std::nullopt;
    const auto found = std::ranges::lower_bound(faces_.corners, face_key(*were));
    if (found == faces_.corners.end() || *found != face_key(*were)) return std::nullopt;
    FaceBend bend{face, {}};
    const auto in_part = [&](std::size_t k) { return in_face(order_, k); };
    const TetIndex t = tet_of_face_[static_cast<std::size_t>(found - faces_.corners.begin())];
    if (!fill(t, face, *were, nodes_in_face(order_), in_part, bend.by)) return std::nullopt;
    return bend;
  }

  /// False if all nodes are where those of straight edges would be.
  template <std::size_t kCorners, class InPart>
  bool fill(TetIndex t, const std::array<VertexIndex, kCorners>& corners, const std::array<VertexIndex, kCorners>& were,
            std::size_t nodes, const InPart& in_part, NodeMoves& by) const {
    std::array<Vec3, 35> room;
    const std::span<const Vec3> of_tet = nodes_of_tet(before_, t, room);
    const double size = distance(mesh_.points[corners[0]], mesh_.points[corners[1]]);
    double most = 0;
    for (std::size_t k = 0; k < nodes; ++k) {
      const NodePlace<kCorners> place = in_part(k);
      std::array<double, 4> at{};
      for (std::size_t i = 0; i < kCorners; ++i)
        at[static_cast<std::size_t>(std::ranges::find(before_.tets[t], were[i]) - before_.tets[t].begin())] =
            place.weights[i] * before_.order() / place.order;
      by[k] = place_in_tet(before_.order(), of_tet, at) - place.mean(mesh_.points, corners);
      most = std::max(most, length(by[k]));
    }
    return most > kStraightKept * size;
  }

  const TetMesh &mesh_, &before_;
  int order_;
  std::vector<std::array<std::uint32_t, 6>> edges_of_tet_;
  TetEdges edges_;
  TetFaces faces_;
  std::vector<VertexIndex> was_;  ///< per corner of the mesh
  std::vector<TetIndex> tet_of_edge_, tet_of_face_;
};

}  // namespace

Bends kept_bends(const TetMesh& mesh, const TetMesh& before, int order) {
  return KeptBends(mesh, before, order).run();
}

}  // namespace octafront::curved
