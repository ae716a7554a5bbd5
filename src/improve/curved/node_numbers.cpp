#include "improve/curved/node_numbers.h"

#include "base/core/parallel.h"
#include "base/mesh/face_table.h"
#include "improve/curved/node_places.h"

#include <algorithm>

namespace octafront::curved {

std::array<double, 3> shares_of_edge(int order, double low, double high) {
  std::array<double, 3> shares{};
  const auto at = [&](int k) { return 2.0 * k / order - 1; };
  for (int k = 1; k < order; ++k) {
    double share = low * high * order * order / (k * (order - k));
    for (int i = 1; i < order; ++i)
      if (i != k) share *= (high - low - at(i)) / (at(k) - at(i));
    shares[static_cast<std::size_t>(k - 1)] = share;
  }
  return shares;
}

std::array<double, 3> shares_of_face(int order, const std::array<double, 3>& corners) {
  const double bubble = corners[0] * corners[1] * corners[2];
  if (order == 3) return {27 * bubble, 0, 0};
  std::array<double, 3> shares{};
  const double all = corners[0] + corners[1] + corners[2];
  for (std::size_t k = 0; k < 3; ++k) shares[k] = 32 * bubble * (4 * corners[k] - all);
  return shares;
}

NumberedNodes::NumberedNodes(TetMesh& mesh, int order)
    : mesh_(mesh),
      order_(order),
      corners_(mesh.points.size()),
      faces_(faces_of_tets(mesh.tets, corners_)),
      edges_(edges_of_tets(mesh.tets, corners_, edge_of_)) {
  first_in_face_ = corners_ + edges_.size() * nodes_in_edge(order);
  first_in_tet_ = first_in_face_ + faces_.corners.size() * nodes_in_face(order);
  mesh.points.resize(first_in_tet_ + mesh.tets.size() * nodes_in_tet(order));
  mesh.high_order = static_cast<std::uint32_t>(order);
  number_nodes();
}

/// The nodes of each element in the order of the lattice, whichever way its edges and faces run.
void NumberedNodes::number_nodes() {
  const std::size_t each = mesh_.high_nodes_per_tet();
  mesh_.high_nodes.resize(mesh_.tets.size() * each);
  parallel_for(mesh_.tets.size(), [&](std::size_t t) {
    const Tet& tet = mesh_.tets[t];
    VertexIndex* to = mesh_.high_nodes.data() + t * each;
    for (std::size_t e = 0; e < 6; ++e) {
      const bool runs = tet[static_cast<std::size_t>(kTetEdges[e][0])] < tet[static_cast<std::size_t>(kTetEdges[e][1])];
      const std::size_t inside = nodes_in_edge(order_);
      for (std::size_t k = 0; k < inside; ++k) *to++ = node_in_edge(edge_of_[t][e], runs ? k : inside - 1 - k);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Triangle face = octafront::face_of(tet, static_cast<int>(i));
      const Triangle& sorted = faces_.corners[faces_.of_tet[t][i]];
      for (std::size_t k = 0; k < nodes_in_face(order_); ++k) {
        const auto corner = static_cast<std::size_t>(std::ranges::find(sorted, face[k]) - sorted.begin());
        *to++ = node_in_face(faces_.of_tet[t][i], order_ == 3 ? 0 : corner);
      }
    }
    for (std::size_t k = 0; k < nodes_in_tet(order_); ++k) *to++ = node_in_tet(static_cast<TetIndex>(t), k);
  });
}

std::vector<char> NumberedNodes::is_on_wall() const {
  std::vector<char> is(mesh_.points.size());
  const auto mark = [&](const Triangle& wall) {
    const auto [a, b, c] = face_key(wall);
    const auto f = std::ranges::lower_bound(faces_.corners, Triangle{a, b, c}) - faces_.corners.begin();
    for (std::size_t k = 0; k < nodes_in_face(order_); ++k) is[node_in_face(static_cast<std::uint32_t>(f), k)] = 1;
    for (const std::uint32_t e : {edges_.find(a, b), edges_.find(a, c), edges_.find(b, c)})
      for (std::size_t k = 0; k < nodes_in_edge(order_); ++k) is[node_in_edge(e, k)] = 1;
  };
  for (const Triangle& wall : mesh_.boundary) mark(wall);
  for (const Triangle& wall : mesh_.interfaces) mark(wall);
  return is;
}

Vec3 NumberedNodes::off_edge(std::uint32_t e, std::size_t k) const {
  return mesh_.points[node_in_edge(e, k)] - in_edge(order_, k).mean(mesh_.points, edge(e));
}

Vec3 NumberedNodes::off_along(std::uint32_t e, double low, double high) const {
  const std::array<double, 3> shares = shares_of_edge(order_, low, high);
  Vec3 sum;
  for (std::size_t k = 0; k < nodes_in_edge(order_); ++k) sum += shares[k] * off_edge(e, k);
  return sum;
}

Vec3 NumberedNodes::off_by_edges(std::uint32_t f, const std::array<double, 3>& at) const {
  return by_edges(f, at, [&](std::uint32_t e, std::size_t, std::size_t, double low, double high) {
    return off_along(e, low, high);
  });
}

Vec3 NumberedNodes::off_middle(std::uint32_t f) const {
  const Vec3 straight = in_face(order_, 0).mean(mesh_.points, faces_.corners[f]);
  return mesh_.points[node_in_face(f, 0)] - straight - off_by_edges(f, kMiddleOfFace);
}

}  // namespace octafront::curved
