#include "support/mixed_mesh.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace octafront::testing {
namespace {

using Quad = std::array<VertexIndex, 4>;

/// The diagonal of a quadrilateral starts at its lowest node.
std::array<Triangle, 2> halves(const Quad& q) {
  const auto low = static_cast<std::size_t>(std::min_element(q.begin(), q.end()) - q.begin());
  const Triangle one{q[low], q[(low + 1) % 4], q[(low + 2) % 4]}, other{q[low], q[(low + 2) % 4], q[(low + 3) % 4]};
  return {one, other};
}

class Maker {
 public:
  explicit Maker(int n) : n_(n) {
    for (int k = 0; k <= kLayers + n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
          mesh_.points.push_back({double(i), double(j), k <= kLayers ? 0.5 * k / kLayers : 0.5 + k - kLayers});
  }

  TetMesh make() {
    for (int j = 0; j < n_; ++j)
      for (int i = 0; i < n_; ++i) add_column(i, j);
    for (int j = 0; j < n_; ++j)
      for (int k = 0; k < kLayers; ++k) add_pyramid(j, k);
    add_faces();
    name();
    return std::move(mesh_);
  }

 private:
  static constexpr int kLayers = 2;

  VertexIndex at(int i, int j, int k) const { return static_cast<VertexIndex>((k * (n_ + 1) + j) * (n_ + 1) + i); }

  void add(Tet t, std::uint32_t region) {
    const auto& p = mesh_.points;
    if (dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), p[t[3]] - p[t[0]]) < 0) std::swap(t[2], t[3]);
    mesh_.tets.push_back(t);
    mesh_.region.push_back(region);
  }

  void add_column(int i, int j) {
    const auto corner = [&](int c, int k) { return at(i + (c & 1), j + (c >> 1), k); };
    for (const auto& [a, b, c] : {std::array{0, 1, 3}, {0, 3, 2}})
      for (int k = 0; k < kLayers; ++k)
        add_wedge({corner(a, k), corner(b, k), corner(c, k), corner(a, k + 1), corner(b, k + 1), corner(c, k + 1)});
    for (int k = kLayers; k < kLayers + n_; ++k)
      for (const auto& path : {std::array{1, 2, 4}, {2, 4, 1}, {4, 1, 2}, {1, 4, 2}, {4, 2, 1}, {2, 1, 4}}) {
        Tet t{};
        int bits = 0;
        for (std::size_t step = 0; step < 4; bits |= step < 3 ? path[step] : 0, ++step)
          t[step] = at(i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2));
        add(t, 1);
      }
  }

  void add_wedge(const std::array<VertexIndex, 6>& w) {
    mesh_.wide_cells.push_back({static_cast<TetIndex>(mesh_.tets.size()), 3, w});
    // The lowest node is in the base; a tetrahedron for each half of the side that lacks it, and one for the top.
    const auto low = static_cast<std::size_t>(std::min_element(w.begin(), w.begin() + 3) - w.begin());
    const std::size_t p = (low + 1) % 3, q = (low + 2) % 3;
    for (const auto& [a, b, c] : halves({w[p], w[q], w[q + 3], w[p + 3]})) add({w[low], a, b, c}, 0);
    add({w[low], w[3], w[4], w[5]}, 0);
  }

  void add_pyramid(int j, int k) {
    const auto apex = static_cast<VertexIndex>(mesh_.points.size());
    mesh_.points.push_back({-0.5, j + 0.5, (k + 0.5) * 0.5 / kLayers});
    const Quad base{at(0, j, k), at(0, j, k + 1), at(0, j + 1, k + 1), at(0, j + 1, k)};
    mesh_.wide_cells.push_back(
        {static_cast<TetIndex>(mesh_.tets.size()), 2, {base[0], base[1], base[2], base[3], apex, kNone}});
    for (const auto& [a, b, c] : halves(base)) add({a, b, c, apex}, 0);
  }

  /// The side of the body that all corners lie on: 0 bottom, 1 top, 2 y low, 3 y high, 4 x high; 5: pyramids.
  template <class Row>
  std::uint32_t side_of(const Row& corners) const {
    const auto all = [&](const auto& lies) {
      return std::all_of(corners.begin(), corners.end(), [&](VertexIndex v) { return lies(mesh_.points[v]); });
    };
    const double n = n_;
    return all([](const Vec3& p) { return p.z == 0 && p.x >= 0; }) ? 0
           : all([n](const Vec3& p) { return p.z == n + 0.5; })    ? 1
           : all([](const Vec3& p) { return p.y == 0; })           ? 2
           : all([n](const Vec3& p) { return p.y == n; })          ? 3
           : all([n](const Vec3& p) { return p.x == n; })          ? 4
                                                                   : 5;
  }

  void add_faces() {
    std::map<Triangle, std::pair<int, Triangle>> seen;
    for (const Tet& t : mesh_.tets)
      for (const auto& f : kTetFaces) {
        const Triangle face{t[static_cast<std::size_t>(f[0])], t[static_cast<std::size_t>(f[1])],
                            t[static_cast<std::size_t>(f[2])]};
        Triangle key = face;
        std::sort(key.begin(), key.end());
        auto& [count, of] = seen[key];
        ++count;
        of = face;
      }
    std::map<Triangle, bool> is_done;
    const auto take = [&](const Triangle& t) {
      Triangle key = t;
      std::sort(key.begin(), key.end());
      if (seen[key].first != 1 || is_done[key]) return false;
      is_done[key] = true;
      mesh_.boundary.push_back(seen[key].second);
      mesh_.patch.push_back(side_of(t));
      return true;
    };
    for (const WideCell& cell : mesh_.wide_cells) {
      if (cell.tet_count == 2) continue;
      const auto& w = cell.nodes;
      for (const Quad& q : {Quad{w[0], w[1], w[4], w[3]}, Quad{w[1], w[2], w[5], w[4]}, Quad{w[2], w[0], w[3], w[5]}}) {
        const auto first = static_cast<std::uint32_t>(mesh_.boundary.size());
        const auto [one, other] = halves(q);
        if (take(one) && take(other)) mesh_.wide_faces.push_back({first, q});
      }
    }
    for (const auto& [key, of] : seen) take(key);
    for (const auto& [key, of] : seen) {
      const auto is_between = [&](VertexIndex v) { return mesh_.points[v].z == 0.5 && mesh_.points[v].x >= 0; };
      if (of.first == 2 && std::all_of(key.begin(), key.end(), is_between)) mesh_.interfaces.push_back(of.second);
    }
    mesh_.interface_patch.assign(mesh_.interfaces.size(), 6);
  }

  void name() {
    using Kind = NamedSet::Kind;
    mesh_.region_names = {"layers", "volume"};
    mesh_.patch_names = {"wall", "top", "low", "high", "end", "steps", "between"};
    const auto set_of = [&](const char* name_of, Kind kind, std::size_t count, const auto& is_member) {
      NamedSet set{name_of, kind, {}};
      for (std::uint32_t m = 0; m < count; ++m)
        if (is_member(m)) set.members.push_back(m);
      mesh_.sets.push_back(std::move(set));
    };
    const auto is_low = [&](VertexIndex v) { return mesh_.points[v].x <= 1; };
    set_of("low_nodes", Kind::kNodes, mesh_.points.size(), is_low);
    set_of("low_faces", Kind::kFaces, mesh_.boundary.size(), [&](std::uint32_t f) { return mesh_.patch[f] >= 4; });
    // Whole wedges and pyramids.
    std::vector<std::uint32_t> cell_of(mesh_.tets.size(), kNone);
    for (const WideCell& cell : mesh_.wide_cells) std::fill_n(cell_of.begin() + cell.first, cell.tet_count, cell.first);
    set_of("some_elements", Kind::kElements, mesh_.tets.size(),
           [&](std::uint32_t t) { return (cell_of[t] == kNone ? t : cell_of[t]) % 5 < 3; });
  }

  int n_;
  TetMesh mesh_;
};

}  // namespace

TetMesh mixed_mesh(int n) {
  return Maker(n).make();
}

TetMesh bent_quadratically(TetMesh mesh) {
  for (Vec3& p : mesh.points)
    p = p + Vec3{0.03 * p.y * p.y + 0.02 * p.x * p.z, 0.04 * p.x * p.x - 0.02 * p.y * p.z,
                 0.02 * p.x * p.y + 0.015 * p.z * p.z};
  return mesh;
}

}  // namespace octafront::testing
