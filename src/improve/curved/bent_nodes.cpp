#include "improve/curved/bent_nodes.h"

#include "base/core/parallel.h"
#include "base/mesh/face_table.h"
#include "improve/curved/node_places.h"

#include <algorithm>

namespace octafront::curved {

namespace {

constexpr std::array<double, 3> kMiddleOfTet{0.25, 0.25, 0.25};  // seen from an edge or face

Vec3 moved_by(const Bent& bent, double part, const std::array<double, 3>& shares) {
  Vec3 sum;
  for (std::size_t k = 0; k < 3; ++k) sum += shares[k] * bent.by[k];
  return part * sum;
}
Vec3 moved_by(const Bent& bent, const std::array<double, 3>& shares) {
  return moved_by(bent, bent.part(), shares);
}

void bend(Bent& bent, const NodeMoves& by) {
  bent.by = by;
  bent.most = 0;
  for (const Vec3 move : by) bent.most = std::max(bent.most, length(move));
}

}  // namespace

BentNodes::BentNodes(TetMesh& mesh, int order, const Bends& bends)
    : NumberedNodes(mesh, order),
      bent_of_edge_(edges().size(), kNone),
      bent_of_face_(faces().corners.size(), kNone),
      bent_of_tet_(bends.tets.empty() ? 0 : mesh.tets.size(), kNone) {
  for (const EdgeBend& bend : bends.edges) add(bend.by, bent_of_edge_[edges().find(bend.edge[0], bend.edge[1])]);
  bent_edges_ = bent_.size();
  for (const FaceBend& bend : bends.faces) {
    const auto found = std::ranges::lower_bound(faces().corners, bend.face);
    const auto f = static_cast<std::uint32_t>(found - faces().corners.begin());
    NodeMoves by = bend.by;
    for (std::size_t k = 0; k < nodes_in_face(order); ++k) by[k] -= moved_in_face(f, in_face(order, k).at());
    add(by, bent_of_face_[f]);
  }
  bent_faces_ = bent_.size();
  for (const TetBend& bend : bends.tets) add({bend.by[0] - moved_in_tet(bend.tet)}, bent_of_tet_[bend.tet]);
  find_bent_tets();
  place_all();
}

void BentNodes::add(const NodeMoves& by, std::uint32_t& place) {
  Bent bent;
  bend(bent, by);
  if (bent.most == 0) return;
  place = static_cast<std::uint32_t>(bent_.size());
  bent_.push_back(bent);
}

void BentNodes::find_bent_tets() {
  std::vector<char> bends(mesh_.tets.size());
  parallel_for(bends.size(), [&](std::size_t i) {
    const auto t = static_cast<TetIndex>(i);
    for (const std::uint32_t e : edges_of_tet(t)) bends[i] |= bent_of_edge_[e] != kNone;
    for (const std::uint32_t f : faces_of_tet(t)) bends[i] |= bent_of_face_[f] != kNone;
  });
  for (TetIndex t = 0; t < bends.size(); ++t)
    if (bends[t]) bent_tets_.push_back(t);
}

/// What bends of edges do to a place of one, and these and those of faces to what they enclose; but for its own.
Vec3 BentNodes::moved_along(std::uint32_t e, double low, double high) const {
  const std::uint32_t bent = bent_of_edge_[e];
  return bent == kNone ? Vec3{} : moved_by(bent_[bent], shares_of_edge(order(), low, high));
}

Vec3 BentNodes::moved_in_face(std::uint32_t f, const std::array<double, 3>& at) const {
  return by_edges(f, at, [&](std::uint32_t e, std::size_t, std::size_t, double low, double high) {
    return moved_along(e, low, high);
  });
}

Vec3 BentNodes::moved_in_tet(TetIndex t) const {
  Vec3 sum;
  for (const std::uint32_t e : edges_of_tet(t)) sum += moved_along(e, 0.25, 0.25);
  for (const std::uint32_t f : faces_of_tet(t))
    if (const std::uint32_t bent = bent_of_face_[f]; bent != kNone)
      sum += moved_by(bent_[bent], shares_of_face(order(), kMiddleOfTet));
  return sum;
}

Vec3 BentNodes::straight_in_tet(TetIndex t) const {
  Vec3 at;
  for (const VertexIndex v : mesh_.tets[t]) at += 0.25 * mesh_.points[v];
  return at;
}

Vec3 BentNodes::unbent(VertexIndex node, Vec3 straight) const {
  const std::size_t i = node - corners();
  return (base_.empty() ? straight : base_[i]) + (moved_.empty() ? Vec3{} : moved_[i]);
}

void BentNodes::place_all() {
  parallel_for(edges().size(), [&](std::size_t e) { place_edge(static_cast<std::uint32_t>(e)); });
  parallel_for(faces().corners.size(), [&](std::size_t f) { place_face(static_cast<std::uint32_t>(f)); });
  parallel_for(mesh_.tets.size(), [&](std::size_t t) { place_tet(static_cast<TetIndex>(t)); });
}

void BentNodes::place_edge(std::uint32_t e) {
  for (std::size_t k = 0; k < nodes_in_edge(order()); ++k) {
    const VertexIndex node = node_in_edge(e, k);
    Vec3 at = unbent(node, in_edge(order(), k).mean(mesh_.points, edge(e)));
    if (const std::uint32_t bent = bent_of_edge_[e]; bent != kNone) at += bent_[bent].part() * bent_[bent].by[k];
    mesh_.points[node] = at;
  }
}

void BentNodes::place_face(std::uint32_t f) {
  for (std::size_t k = 0; k < nodes_in_face(order()); ++k) {
    const VertexIndex node = node_in_face(f, k);
    const NodePlace<3> place = in_face(order(), k);
    Vec3 at = unbent(node, place.mean(mesh_.points, faces().corners[f])) + moved_in_face(f, place.at());
    if (const std::uint32_t bent = bent_of_face_[f]; bent != kNone) at += bent_[bent].part() * bent_[bent].by[k];
    mesh_.points[node] = at;
  }
}

/// Order 4 has one node inside, in the middle.
void BentNodes::place_tet(TetIndex t) {
  if (nodes_in_tet(order()) == 0) return;
  const VertexIndex node = node_in_tet(t, 0);
  Vec3 at = unbent(node, straight_in_tet(t));
  if (const std::uint32_t bent = bent_of_tet(t); bent != kNone) at += bent_[bent].part() * bent_[bent].by[0];
  mesh_.points[node] = at + moved_in_tet(t);
}

void BentNodes::take(const NodesMoved& moved) {
  if (moved.by.empty()) return;
  moved_.resize(mesh_.points.size() - corners());
  for (const auto& [node, by] : moved.by) moved_[node - corners()] += by;
  slid_.insert(slid_.end(), moved.slid.begin(), moved.slid.end());
  std::ranges::stable_sort(slid_, {}, &SlidNode::node);
}

void BentNodes::forget_moves(TetIndex t) {
  if (moved_.empty()) return;
  const std::size_t each = mesh_.high_nodes_per_tet();
  for (const VertexIndex node : std::span(mesh_.high_nodes).subspan(t * each, each)) {
    moved_[node - corners()] = {};
    const auto [first, last] = std::ranges::equal_range(slid_, node, {}, &SlidNode::node);
    slid_.erase(first, last);
  }
}

Bends BentNodes::lowered() const {
  Bends bends;
  for (std::uint32_t e = 0; e < edges().size(); ++e) {
    if (bent_of_edge_[e] == kNone) continue;
    bends.edges.push_back({edge(e), {moved_along(e, 2.0 / 3, 1.0 / 3), moved_along(e, 1.0 / 3, 2.0 / 3), Vec3{}}});
  }
  for (std::uint32_t f = 0; f < faces().corners.size(); ++f) {
    if (bent_of_face_[f] == kNone) continue;
    const Vec3 own = moved_by(bent_[bent_of_face_[f]], shares_of_face(order(), kMiddleOfFace));
    bends.faces.push_back({faces().corners[f], {moved_in_face(f, kMiddleOfFace) + own, Vec3{}, Vec3{}}});
  }
  return bends;
}

double BentNodes::part_of_edge(std::uint32_t e) const {
  return bent_of_edge_[e] == kNone ? 1 : bent_[bent_of_edge_[e]].part();
}

double BentNodes::part_of_face(std::uint32_t f) const {
  return bent_of_face_[f] == kNone ? 1 : bent_[bent_of_face_[f]].part();
}

/// How far a node slid towards the high end of its edge, in parts of this.
double BentNodes::slid_on_edge(std::uint32_t e, std::size_t k) const {
  double sum = 0;
  for (const SlidNode& slid : std::ranges::equal_range(slid_, node_in_edge(e, k), {}, &SlidNode::node)) {
    const Tet& tet = mesh_.tets[slid.tet];
    const auto high = static_cast<std::size_t>(std::ranges::find(tet, edges().high[e]) - tet.begin());
    sum += slid.at[high] / order() - in_edge(order(), k).at()[1];
  }
  return sum;
}

double BentNodes::slid_along(std::uint32_t e, double low, double high) const {
  const std::array<double, 3> shares = shares_of_edge(order(), low, high);
  double sum = 0;
  for (std::size_t k = 0; k < nodes_in_edge(order()); ++k) sum += shares[k] * slid_on_edge(e, k);
  return sum;
}

/// In barycentric coordinates of a face.
Vec3 BentNodes::slid_by_edges(std::uint32_t f, const std::array<double, 3>& at) const {
  return by_edges(f, at, [&](std::uint32_t e, std::size_t i, std::size_t j, double low, double high) {
    const double along = slid_along(e, low, high);
    Vec3 by;
    by[static_cast<int>(i)] = -along, by[static_cast<int>(j)] = along;
    return by;
  });
}

/// Of order 3, whose faces have one node.
Vec3 BentNodes::slid_in_face(std::uint32_t f, const std::array<double, 3>& at) const {
  Vec3 own;
  for (const SlidNode& slid : std::ranges::equal_range(slid_, node_in_face(f, 0), {}, &SlidNode::node)) {
    const Tet& tet = mesh_.tets[slid.tet];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = static_cast<std::size_t>(std::ranges::find(tet, faces().corners[f][i]) - tet.begin());
      own[static_cast<int>(i)] += slid.at[corner] / 3 - kMiddleOfFace[i];
    }
  }
  if (own != Vec3{}) own -= slid_by_edges(f, kMiddleOfFace);
  return slid_by_edges(f, at) + shares_of_face(3, at)[0] * own;
}

void BentNodes::take_as_base(const BentNodes& third) {
  base_.resize(mesh_.points.size() - corners());
  parallel_for(edges().size(), [&](std::size_t i) {
    const auto e = static_cast<std::uint32_t>(i);
    for (std::size_t k = 0; k < nodes_in_edge(order()); ++k) {
      const NodePlace<2> place = in_edge(order(), k);
      const auto [low, high] = place.at();
      base_[node_in_edge(e, k) - corners()] = place.mean(mesh_.points, edge(e)) + third.off_along(e, low, high);
    }
  });
  std::vector<Vec3> middle(faces().corners.size());
  parallel_for(middle.size(), [&](std::size_t i) {
    const auto f = static_cast<std::uint32_t>(i);
    middle[f] = third.off_middle(f);
    for (std::size_t k = 0; k < nodes_in_face(order()); ++k) {
      const NodePlace<3> place = in_face(order(), k);
      base_[node_in_face(f, k) - corners()] = place.mean(mesh_.points, faces().corners[f]) +
                                              third.off_by_edges(f, place.at()) +
                                              shares_of_face(3, place.at())[0] * middle[f];
    }
  });
  parallel_for(mesh_.tets.size(), [&](std::size_t i) {
    const auto t = static_cast<TetIndex>(i);
    Vec3 at = straight_in_tet(t);
    for (const std::uint32_t e : edges_of_tet(t)) at += third.off_along(e, 0.25, 0.25);
    for (const std::uint32_t f : faces_of_tet(t)) at += shares_of_face(3, kMiddleOfTet)[0] * middle[f];
    base_[node_in_tet(t, 0) - corners()] = at;
  });
}

void BentNodes::aim_edges(const BentNodes& third, std::vector<NodeMoves>& by) const {
  parallel_for(edges().size(), [&](std::size_t i) {
    const auto e = static_cast<std::uint32_t>(i);
    if (bent_of_edge_[e] == kNone) return;
    for (std::size_t k = 0; k < nodes_in_edge(order()); ++k) {
      auto [low, high] = in_edge(order(), k).at();
      const double slid = third.slid_along(e, low, high);
      low -= slid, high += slid;
      const Vec3 straight = low * mesh_.points[edges().low[e]] + high * mesh_.points[edges().high[e]];
      by[e][k] = straight + third.part_of_edge(e) * moved_along(e, low, high) - base_[node_in_edge(e, k) - corners()];
    }
  });
}

void BentNodes::aim_faces(const BentNodes& third, std::vector<NodeMoves>& by) const {
  parallel_for(faces().corners.size(), [&](std::size_t i) {
    const auto f = static_cast<std::uint32_t>(i);
    if (bent_of_face_[f] == kNone) return;
    for (std::size_t k = 0; k < nodes_in_face(order()); ++k) {
      std::array<double, 3> at = in_face(order(), k).at();
      const Vec3 slid = third.slid_in_face(f, at);
      Vec3 to;
      for (std::size_t c = 0; c < 3; ++c) {
        at[c] += slid[static_cast<int>(c)];
        to += at[c] * mesh_.points[faces().corners[f][c]];
      }
      to += by_edges(f, at, [&](std::uint32_t e, std::size_t, std::size_t, double low, double high) {
        return third.part_of_edge(e) * moved_along(e, low, high);
      });
      to += moved_by(bent_[bent_of_face_[f]], third.part_of_face(f), shares_of_face(order(), at));
      by[f][k] = to - base_[node_in_face(f, k) - corners()];
    }
  });
}

void BentNodes::go_on_from(const BentNodes& third) {
  take_as_base(third);
  std::vector<NodeMoves> of_edges(edges().size()), of_faces(faces().corners.size());
  aim_edges(third, of_edges);
  aim_faces(third, of_faces);
  std::vector<Vec3> of_tets(bent_of_tet_.size());
  for (TetIndex t = 0; t < of_tets.size(); ++t)
    if (const std::uint32_t bent = bent_of_tet_[t]; bent != kNone)
      of_tets[t] = straight_in_tet(t) + moved_in_tet(t) + bent_[bent].by[0] - base_[node_in_tet(t, 0) - corners()];
  for (std::uint32_t e = 0; e < of_edges.size(); ++e) {
    if (bent_of_edge_[e] == kNone) continue;
    Bent& bent = bent_[bent_of_edge_[e]];
    bend(bent, of_edges[e]);
    bent.was_eased = third.part_of_edge(e) < 1;
  }
  for (std::uint32_t f = 0; f < of_faces.size(); ++f) {
    if (bent_of_face_[f] == kNone) continue;
    Bent& bent = bent_[bent_of_face_[f]];
    for (std::size_t k = 0; k < nodes_in_face(order()); ++k)
      of_faces[f][k] -= moved_in_face(f, in_face(order(), k).at());
    bend(bent, of_faces[f]);
    bent.was_eased = third.part_of_face(f) < 1;
  }
  for (TetIndex t = 0; t < of_tets.size(); ++t)
    if (const std::uint32_t bent = bent_of_tet_[t]; bent != kNone)
      bend(bent_[bent], {of_tets[t] - moved_in_tet(t), Vec3{}, Vec3{}});
  place_all();
}

}  // namespace octafront::curved
