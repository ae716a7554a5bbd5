#include "formats/parts/mesh_parts.h"

namespace octafront::io {

namespace {

constexpr std::array<std::uint8_t, 20> kVtk3{0, 1, 2, 3, 4, 5, 10, 11, 7, 6, 8, 9, 12, 13, 14, 15, 18, 16, 17, 19};
constexpr std::array<std::uint8_t, 35> kVtk4{0,  1,  2,  3,  4,  5,  6,  13, 14, 15, 9,  8,  7,  10, 11, 12, 16, 17,
                                             18, 19, 20, 21, 28, 29, 30, 23, 24, 22, 25, 26, 27, 31, 32, 33, 34};
// Both have edges 12 23 31 first; Gmsh goes on with 41 43 42, and faces 132 124 143 423.
constexpr std::array<std::uint8_t, 20> kGmsh3{0, 1, 2, 3, 4, 5, 10, 11, 7, 6, 9, 8, 15, 14, 13, 12, 19, 18, 17, 16};
constexpr std::array<std::uint8_t, 35> kGmsh4{0,  1,  2,  3,  4,  5,  6,  13, 14, 15, 9,  8,  7,  12, 11, 10, 21, 20,
                                              19, 18, 17, 16, 31, 32, 33, 28, 29, 30, 25, 26, 27, 24, 22, 23, 34};

/// The weights of a triangle's nodes: corners; of edges 12 23 31; inside, the one nearest to the first corner first.
std::vector<std::array<int, 3>> triangle_lattice(int order) {
  std::vector<std::array<int, 3>> all{{order, 0, 0}, {0, order, 0}, {0, 0, order}};
  for (std::size_t a = 0; a < 3; ++a)
    for (int k = 1; k < order; ++k) {
      std::array<int, 3> w{};
      w[a] = order - k, w[(a + 1) % 3] = k;
      all.push_back(w);
    }
  for (std::size_t k = 0; k < nodes_in_face(order); ++k) {
    std::array<int, 3> w{1, 1, 1};
    w[k] += order - 3;
    all.push_back(w);
  }
  return all;
}

const std::vector<std::array<int, 3>>& triangle_lattice_of(int order) {
  static const std::array<std::vector<std::array<int, 3>>, 2> kAll{triangle_lattice(3), triangle_lattice(4)};
  return kAll[static_cast<std::size_t>(order - 3)];
}

}  // namespace

std::size_t lattice_node_of_vtk(int order, std::size_t k) {
  return order == 3 ? kVtk3[k] : kVtk4[k];
}

std::size_t lattice_node_of_gmsh(int order, std::size_t k) {
  return order == 3 ? kGmsh3[k] : kGmsh4[k];
}

std::size_t vtk_node_of_gmsh(int order, std::size_t k) {
  const std::size_t node = lattice_node_of_gmsh(order, k);
  const auto find = [&](const auto& all) {
    return static_cast<std::size_t>(std::ranges::find(all, node) - all.begin());
  };
  return order == 3 ? find(kVtk3) : find(kVtk4);
}

HighNodes::HighNodes(const TetMesh& mesh) : mesh_(mesh) {
  if (mesh.high_order == 0) return;
  std::vector<bool> is_on_curve(mesh.points.size(), false);
  for (const Edge& edge : mesh.curve_edges)
    for (const VertexIndex v : edge) is_on_curve[v] = true;
  at_low_ = {mesh.points.size(), [&](const auto& add) {
               for (TetIndex t = 0; t < mesh.tets.size(); ++t)
                 for (const auto& [i, j] : kTetEdges) {
                   const VertexIndex a = mesh.tets[t][static_cast<std::size_t>(i)],
                                     b = mesh.tets[t][static_cast<std::size_t>(j)];
                   if (is_on_curve[a] && is_on_curve[b]) add(std::min(a, b), Use{std::max(a, b), t});
                 }
             }};
}

VertexIndex HighNodes::of_tet(std::size_t t, std::size_t k) const {
  const std::size_t node = lattice_node_of_vtk(mesh_.order(), k);
  return node < 4 ? mesh_.tets[t][node] : mesh_.high_nodes[t * mesh_.high_nodes_per_tet() + node - 4];
}

template <std::size_t kCorners>
VertexIndex HighNodes::node(TetIndex t, const std::array<VertexIndex, kCorners>& corners,
                            const std::array<int, kCorners>& weights) const {
  const Tet& tet = mesh_.tets[t];
  TetLattice::Weights w{};
  for (std::size_t i = 0; i < kCorners; ++i)
    w[static_cast<std::size_t>(std::ranges::find(tet, corners[i]) - tet.begin())] =
        static_cast<std::int8_t>(weights[i]);
  const std::size_t node = tet_lattice(mesh_.order()).at(w);
  return node < 4 ? tet[node] : mesh_.high_nodes[t * mesh_.high_nodes_per_tet() + node - 4];
}

VertexIndex HighNodes::of_face(const Side& side, const Triangle& corners, std::size_t k) const {
  return node<3>(side.tet, corners, triangle_lattice_of(mesh_.order())[k]);
}

VertexIndex HighNodes::of_edge(const Edge& edge, std::size_t k) const {
  if (k < 2) return edge[k];
  const auto [low, high] = std::minmax(edge[0], edge[1]);
  const std::span<const Use> uses = at_low_[low];
  const auto use = std::ranges::find(uses, high, &Use::high);
  const int second = static_cast<int>(k) - 1;
  return node<2>(use->tet, edge, {mesh_.order() - second, second});
}

}  // namespace octafront::io
