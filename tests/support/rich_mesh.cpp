#include "support/rich_mesh.h"

#include "base/geometry/tet_lattice.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace octafront::testing {
namespace {

using GridCell = std::array<int, 3>;

/// The side of the cube that all corners lie on: 0 to 5, or -1.
template <class Row>
std::vector<int> sides_of(const TetMesh& mesh, const Row& corners, int n) {
  std::vector<int> sides;
  for (int axis = 0; axis < 3; ++axis)
    for (const int high : {0, 1}) {
      const auto lies = [&](VertexIndex v) { return mesh.points[v][axis] == high * n; };
      if (std::all_of(corners.begin(), corners.end(), lies)) sides.push_back(2 * axis + high);
    }
  return sides;
}

void add_faces(TetMesh& mesh, int n) {
  for (const Tet& t : mesh.tets)
    for (const auto& f : kTetFaces) {
      const Triangle face{t[static_cast<std::size_t>(f[0])], t[static_cast<std::size_t>(f[1])],
                          t[static_cast<std::size_t>(f[2])]};
      const std::vector<int> sides = sides_of(mesh, face, n);
      if (!sides.empty()) {
        mesh.boundary.push_back(face);
        mesh.patch.push_back(static_cast<std::uint32_t>(sides[0]));
      }
      const auto in_middle = [&](VertexIndex v) { return 2 * mesh.points[v].x == n; };
      const bool from_left = std::any_of(t.begin(), t.end(), [&](VertexIndex v) { return 2 * mesh.points[v].x < n; });
      if (from_left && std::all_of(face.begin(), face.end(), in_middle)) {
        mesh.interfaces.push_back(face);
        mesh.interface_patch.push_back(6);
      }
    }
}

void add_curves(TetMesh& mesh, int n) {
  std::map<std::pair<int, int>, std::uint32_t> number;
  for (const Triangle& t : mesh.boundary)
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge{t[i], t[(i + 1) % 3]};
      const std::vector<int> sides = sides_of(mesh, edge, n);
      // Each edge of the cube is seen from two triangles.
      if (sides.size() < 2 || edge[0] > edge[1]) continue;
      const auto next = static_cast<std::uint32_t>(number.size());
      mesh.curve_edges.push_back(edge);
      mesh.curve.push_back(number.emplace(std::pair{sides[0], sides[1]}, next).first->second);
    }
  for (std::size_t c = 0; c < number.size(); ++c) mesh.curve_names.push_back("edge " + std::to_string(c));
}

template <class Member>
NamedSet set_of(const char* name, NamedSet::Kind kind, std::size_t count, const Member& is_member) {
  NamedSet set{name, kind, {}};
  for (std::uint32_t i = 0; i < count; ++i)
    if (is_member(i)) set.members.push_back(i);
  return set;
}

}  // namespace

TetMesh rich_mesh(int n) {
  TetMesh mesh;
  const auto at = [n](GridCell g) { return static_cast<VertexIndex>((g[0] * (n + 1) + g[1]) * (n + 1) + g[2]); };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) mesh.points.push_back({double(i), double(j), double(k)});
  constexpr int kPaths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int cell = 0; cell < n * n * n; ++cell)
    for (int path = 0; path < 6; ++path) {
      GridCell g{cell / (n * n), cell / n % n, cell % n};
      const bool is_right = 2 * g[0] >= n;
      Tet t{at(g)};
      for (std::size_t step = 0; step < 3; ++step) {
        ++g[static_cast<std::size_t>(kPaths[path][step])];
        t[step + 1] = at(g);
      }
      if (path >= 3) std::swap(t[0], t[1]);
      mesh.tets.push_back(t);
      mesh.region.push_back(is_right);
    }
  mesh.region_names = {"soft part", "Stahl \"42\""};
  add_faces(mesh, n);
  mesh.patch_names = {"fixed end", "load-1", "y<0 & more", "y_max", "", "z max", "glue"};
  add_curves(mesh, n);
  using Kind = NamedSet::Kind;
  const auto x = [&](VertexIndex v) { return mesh.points[v].x; };
  mesh.sets = {
      set_of("near origin", Kind::kNodes, mesh.points.size(), [&](std::uint32_t v) { return x(v) <= 1; }),
      set_of("rails", Kind::kEdges, mesh.curve_edges.size(), [&](std::uint32_t e) { return mesh.curve[e] < 2; }),
      set_of("wet", Kind::kFaces, mesh.boundary.size() + mesh.interfaces.size(),
             [&](std::uint32_t f) { return f >= mesh.boundary.size() || mesh.patch[f] == 3; }),
      set_of("core", Kind::kElements, mesh.tets.size(), [](std::uint32_t t) { return t % 3 == 0; })};
  return mesh;
}

TetMesh with_mid_nodes(TetMesh mesh) {
  std::map<Edge, VertexIndex> node_of;
  for (const Tet& t : mesh.tets) {
    std::array<VertexIndex, 6>& mids = mesh.mid_nodes.emplace_back();
    for (std::size_t e = 0; e < 6; ++e) {
      const VertexIndex a = t[static_cast<std::size_t>(kTetEdges[e][0])],
                        b = t[static_cast<std::size_t>(kTetEdges[e][1])];
      const auto [entry, is_new] =
          node_of.try_emplace(Edge{std::min(a, b), std::max(a, b)}, static_cast<VertexIndex>(mesh.points.size()));
      if (is_new) mesh.points.push_back((mesh.points[a] + mesh.points[b]) / 2);
      mids[e] = entry->second;
    }
  }
  return mesh;
}

TetMesh with_high_nodes(TetMesh mesh, int order) {
  const TetLattice& lattice = tet_lattice(order);
  mesh.high_order = static_cast<std::uint32_t>(order);
  // By the corners that have a share in a node, and their shares.
  std::map<std::vector<std::pair<VertexIndex, int>>, VertexIndex> node_of;
  for (const Tet& t : mesh.tets)
    for (std::size_t k = 4; k < lattice.size(); ++k) {
      std::vector<std::pair<VertexIndex, int>> shares;
      for (std::size_t c = 0; c < 4; ++c)
        if (const int w = lattice.weights(k)[c]; w > 0) shares.emplace_back(t[c], w);
      std::sort(shares.begin(), shares.end());
      const auto [entry, is_new] = node_of.try_emplace(shares, static_cast<VertexIndex>(mesh.points.size()));
      mesh.high_nodes.push_back(entry->second);
      if (!is_new) continue;
      Vec3 place;
      for (const auto& [v, w] : shares) place += mesh.points[v] * (static_cast<double>(w) / order);
      mesh.points.push_back(place);
    }
  return mesh;
}

}  // namespace octafront::testing
