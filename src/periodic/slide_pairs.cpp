#include "periodic/slide_pairs.h"

#include <octafront/quality.h>
#include <octafront/surface_mesh.h>

#include "base/core/groups.h"
#include "base/geometry/predicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace octafront {

namespace {

constexpr int kSlideSweeps = 6;
/// Steps that are tried, in mean edges around the vertex, in eight directions.
constexpr double kSteps[] = {0.12, 0.04};
constexpr int kWaysOfPairs = 8;
constexpr double kDiagonal = 0.70710678118654752;
/// What the mean of an element's beta must gain by a move, and below which beta no element gets worse.
constexpr double kLeastGain = 2e-4, kPoor = 0.65;

class PairSlider {
 public:
  PairSlider(TetMesh& mesh, const SurfaceMesh& filled, const PeriodicCell& cell) : mesh_(mesh), cell_(cell) {
    find_pairs(filled);
    std::vector<std::uint8_t> is_paired(mesh.points.size(), 0);
    for (const Pair& pair : pairs_) is_paired[pair.low] = is_paired[pair.high] = 1;
    tets_ = Groups<>(mesh.points.size(), [&](const auto& add) {
      for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
        for (const VertexIndex v : mesh_.tets[t])
          if (is_paired[v]) add(v, t);
    });
  }

  std::uint64_t run(const Stage& stage) {
    std::uint64_t moves = 0;
    for (int sweep = 0; sweep < kSlideSweeps; ++sweep) {
      stage.check();
      const std::uint64_t before = moves;
      for (const Pair& pair : pairs_) moves += slide(pair);
      if (10 * (moves - before) < pairs_.size()) break;
    }
    return moves;
  }

 private:
  struct Pair {
    int period;
    VertexIndex low, high;
  };
  struct Worth {
    double sum = 0, worst = 1;
    std::size_t count = 0;
  };

  /// Vertices all of whose triangles lie in one face, and so do those of their copies.
  void find_pairs(const SurfaceMesh& filled) {
    std::vector<CellFace> face(filled.points.size(), kNone);
    std::vector<std::uint32_t> patch(filled.points.size(), kNone);
    std::vector<std::uint8_t> is_inside(filled.points.size(), 1);
    for (std::size_t t = 0; t < filled.triangles.size(); ++t) {
      const auto [a, b, c] = filled.triangles[t];
      const CellFace of = face_of_cell(cell_, filled.patch_of(t), mesh_.points[a], mesh_.points[b], mesh_.points[c]);
      for (const VertexIndex v : {a, b, c}) {
        if (of == kNone || (face[v] != kNone && (face[v] != of || patch[v] != filled.patch_of(t)))) is_inside[v] = 0;
        face[v] = of, patch[v] = filled.patch_of(t);
      }
    }
    VerticesByPlace high;
    for (VertexIndex v = 0; v < face.size(); ++v)
      if (is_inside[v] && face[v] != kNone && face[v] % 2 == 1) high.add(mesh_.points[v], v);
    for (VertexIndex v = 0; v < face.size(); ++v) {
      if (!is_inside[v] || face[v] == kNone || face[v] % 2 == 1) continue;
      const auto period = static_cast<int>(face[v] / 2);
      if (!is_flat(period)) continue;
      const VertexIndex copy = high.find(cell_.to_high(mesh_.points[v], period));
      if (copy != kNone) pairs_.push_back({period, v, copy});
    }
  }

  bool is_flat(int period) const { return cell_.is_box() || cell_.mapped[static_cast<std::size_t>(period)].is_flat; }

  Vec3 at(VertexIndex v, const Pair& pair, Vec3 place) const {
    return v == pair.low ? place : v == pair.high ? cell_.to_high(place, pair.period) : mesh_.points[v];
  }

  /// Two directions in the low face, at right angles.
  std::array<Vec3, 2> directions(int period) const {
    std::array<Vec3, 2> along{};
    if (cell_.is_box()) {
      along[0][(period + 1) % 3] = 1, along[1][(period + 2) % 3] = 1;
      return along;
    }
    const Vec3 n = cell_.mapped[static_cast<std::size_t>(period)].normal;
    const Vec3 aside = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    along[0] = normalized(cross(n, aside));
    along[1] = cross(n, along[0]);
    return along;
  }

  /// The elements around both with the vertex at the place; count 0 if one is not positive there.
  Worth worth(const Pair& pair, Vec3 place) const {
    Worth w;
    for (const VertexIndex v : {pair.low, pair.high})
      for (const TetIndex t : tets_[v]) {
        const auto [i, j, k, l] = mesh_.tets[t];
        const Vec3 a = at(i, pair, place), b = at(j, pair, place), c = at(k, pair, place), d = at(l, pair, place);
        if (orient3d(a, b, c, d) <= 0) return {};
        const double beta = radius_ratio(a, b, c, d);
        w.sum += beta, w.worst = std::min(w.worst, beta), ++w.count;
      }
    return w;
  }

  double mean_edge(VertexIndex v) const {
    double sum = 0;
    std::size_t count = 0;
    for (const TetIndex t : tets_[v])
      for (const VertexIndex u : mesh_.tets[t])
        if (u != v) sum += distance(mesh_.points[u], mesh_.points[v]), ++count;
    return count > 0 ? sum / static_cast<double>(count) : 0;
  }

  bool slide(const Pair& pair) {
    constexpr std::array<std::array<double, 2>, kWaysOfPairs> kWays{{{1, 0},
                                                                     {kDiagonal, kDiagonal},
                                                                     {0, 1},
                                                                     {-kDiagonal, kDiagonal},
                                                                     {-1, 0},
                                                                     {-kDiagonal, -kDiagonal},
                                                                     {0, -1},
                                                                     {kDiagonal, -kDiagonal}}};
    const Vec3 here = mesh_.points[pair.low];
    const double edge = mean_edge(pair.low);
    const Worth now = worth(pair, here);
    Worth best = now;
    Vec3 chosen = here;
    const std::array<Vec3, 2> along = directions(pair.period);
    for (const double step : kSteps)
      for (const auto& way : kWays) {
        const Vec3 place = cell_.on_grid(here + along[0] * (step * edge * way[0]) + along[1] * (step * edge * way[1]));
        const Worth w = worth(pair, place);
        if (w.count > 0 && w.sum > best.sum && w.worst >= std::min(now.worst, kPoor)) best = w, chosen = place;
      }
    if (best.sum - now.sum < kLeastGain * static_cast<double>(now.count)) return false;
    mesh_.points[pair.low] = chosen, mesh_.points[pair.high] = cell_.to_high(chosen, pair.period);
    return true;
  }

  TetMesh& mesh_;
  const PeriodicCell& cell_;
  std::vector<Pair> pairs_;
  Groups<> tets_;
};

}  // namespace

std::uint64_t slide_pairs(TetMesh& mesh, const SurfaceMesh& filled, const PeriodicCell& cell, const Stage& stage) {
  return PairSlider(mesh, filled, cell).run(stage);
}

}  // namespace octafront
