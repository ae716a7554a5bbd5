#include "support/nasty_surfaces.h"
#include "support/random.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace octafront::testing {

namespace {

using Cell = std::array<int, 3>;

// Which unit cubes of an n x n x n grid are present; there are none outside.
class Voxels {
 public:
  Voxels(int n, double density, Random& random) : n_(n), full_(static_cast<std::size_t>(n * n * n)) {
    for (std::size_t i = 0; i < full_.size(); ++i) full_[i] = random.unit() < density;
    full_[0] = true;
  }
  Voxels(int n, const std::vector<Cell>& cubes) : n_(n), full_(static_cast<std::size_t>(n * n * n)) {
    for (const Cell& c : cubes) full_[index(c)] = true;
  }
  int cells() const { return n_ * n_ * n_; }
  Cell cell(int i) const { return {i % n_, i / n_ % n_, i / (n_ * n_)}; }
  bool filled(Cell c) const { return inside(c) && full_[index(c)]; }

  // Fills cubes where the surface would be pinched, until it is a manifold everywhere.
  void fill_pinches() {
    for (bool changed = true; changed;) {
      changed = false;
      for (int i = 0; i < (n_ + 1) * (n_ + 1) * (n_ + 1); ++i) {
        const Cell corner{i % (n_ + 1), i / (n_ + 1) % (n_ + 1), i / ((n_ + 1) * (n_ + 1))};
        changed = fill_at(corner) || changed;
      }
    }
  }

 private:
  bool inside(Cell c) const {
    for (const int x : c) {
      if (x < 0 || x >= n_) return false;
    }
    return true;
  }
  std::size_t index(Cell c) const { return static_cast<std::size_t>(c[0] + n_ * (c[1] + n_ * c[2])); }
  static Cell around(Cell corner, unsigned k) {
    return {corner[0] - static_cast<int>(k & 1), corner[1] - static_cast<int>(k >> 1 & 1),
            corner[2] - static_cast<int>(k >> 2 & 1)};
  }

  // Whether the cubes around a corner that are full (or those that are not) hang together through faces.
  bool hang_together(Cell corner, bool full) const {
    unsigned members = 0;
    for (unsigned k = 0; k < 8; ++k) members |= unsigned(filled(around(corner, k)) == full) << k;
    unsigned reached = members & (~members + 1);
    for (unsigned before = 0; before != reached;) {
      before = reached;
      for (unsigned k = 0; k < 8; ++k) {
        if (reached >> k & 1) reached |= members & (1u << (k ^ 1) | 1u << (k ^ 2) | 1u << (k ^ 4));
      }
    }
    return reached == members;
  }

  bool fill_at(Cell corner) {
    if (hang_together(corner, true) && hang_together(corner, false)) return false;
    for (unsigned k = 0; k < 8; ++k) {
      const Cell c = around(corner, k);
      if (!inside(c) || filled(c)) continue;
      full_[index(c)] = true;
      return true;
    }
    return false;
  }

  int n_;
  std::vector<bool> full_;
};

// The four grid points of a cube's side, counter-clockwise seen from outside.
std::array<Cell, 4> side_of(Cell c, int axis, int side) {
  constexpr int kCorner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::array<Cell, 4> q{};
  for (int k = 0; k < 4; ++k) {
    q[k] = c;
    q[k][axis] += side;
    q[k][(axis + 1) % 3] += kCorner[k][0];
    q[k][(axis + 2) % 3] += kCorner[k][1];
  }
  if (!side) std::swap(q[1], q[3]);
  return q;
}

/// Sides of two triangles each, divided along either diagonal by chance.
SurfaceMesh boundary_of(const Voxels& voxels, double jitter, Random& random) {
  SurfaceMesh s;
  std::map<Cell, VertexIndex> index;
  const auto vertex = [&](Cell g) {
    const auto [it, is_new] = index.try_emplace(g, static_cast<VertexIndex>(s.points.size()));
    if (is_new) {
      const auto coordinate = [&](int k) { return g[k] + jitter * random.between(-1, 1); };
      const double x = coordinate(0), y = coordinate(1), z = coordinate(2);
      s.points.push_back({x, y, z});
    }
    return it->second;
  };
  for (int i = 0; i < voxels.cells(); ++i) {
    const Cell c = voxels.cell(i);
    if (!voxels.filled(c)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Cell next = c;
        next[axis] += side ? 1 : -1;
        if (voxels.filled(next)) continue;
        std::array<VertexIndex, 4> q{};
        const std::array<Cell, 4> corners = side_of(c, axis, side);
        for (int k = 0; k < 4; ++k) q[k] = vertex(corners[k]);
        if (random.unit() < 0.5) std::rotate(q.begin(), q.begin() + 1, q.end());
        s.triangles.push_back({q[0], q[1], q[2]});
        s.triangles.push_back({q[0], q[2], q[3]});
      }
    }
  }
  return s;
}

}  // namespace

SurfaceMesh random_voxels(int n, double density, double jitter, Pinches pinches, std::uint64_t seed) {
  Random random(seed);
  Voxels voxels(n, density, random);
  if (pinches == Pinches::kFilled) voxels.fill_pinches();
  return boundary_of(voxels, jitter, random);
}

SurfaceMesh boundary_of_cubes(int n, const std::vector<std::array<int, 3>>& cubes) {
  Random random(1);
  return boundary_of(Voxels(n, cubes), 0, random);
}

std::vector<std::array<int, 3>> all_cubes_but(int n, const std::vector<std::array<int, 3>>& gaps) {
  std::vector<std::array<int, 3>> cubes;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        if (std::find(gaps.begin(), gaps.end(), Cell{x, y, z}) == gaps.end()) cubes.push_back({x, y, z});
  return cubes;
}

}  // namespace octafront::testing
