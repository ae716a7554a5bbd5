#include "adapt/cut/cutter.h"
#include "base/core/groups.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace octafront::adapt {
namespace {

/// Points move by this part of an edge at most: beyond, the one at its other end is as near.
constexpr double kFarthestMove = 0.4;
/// Elements become no worse than this part of the poorest of those around, or than what is sound anyhow (3 r / R).
constexpr double kWorstPart = 0.5, kSound = 0.25;

class SurfaceMover {
 public:
  SurfaceMover(CutState& state, std::size_t level_set)
      : mesh_(state.mesh),
        all_values_(state.values),
        values_(state.values[level_set]),
        around_(rows_at_vertices(mesh_.points.size(), mesh_.tets)),
        is_fixed_(mesh_.points.size(), 0) {
    fix_what_hangs_on();
  }

  std::uint64_t move_all() {
    std::uint64_t moved = 0;
    for (VertexIndex v = 0; v < mesh_.points.size(); ++v) moved += !is_fixed_[v] && values_[v] != 0 && move(v);
    return moved;
  }

 private:
  struct Crossing {
    VertexIndex end = kNone;
    double part = std::numeric_limits<double>::infinity();  ///< of the edge, from this end
  };

  /// Points of walls, curves and sets keep their places.
  void fix_what_hangs_on() {
    for (const auto* faces : {&mesh_.boundary, &mesh_.interfaces})
      for (const Triangle& f : *faces)
        for (const VertexIndex v : f) is_fixed_[v] = 1;
    for (const Edge& e : mesh_.curve_edges)
      for (const VertexIndex v : e) is_fixed_[v] = 1;
    for (const NamedSet& set : mesh_.sets)
      if (set.kind == NamedSet::Kind::kNodes)
        for (const VertexIndex v : set.members) is_fixed_[v] = 1;
    // Of surfaces along which it was cut before.
    for (std::size_t before = 0; &all_values_[before] != &values_; ++before)
      for (std::size_t v = 0; v < mesh_.points.size(); ++v) is_fixed_[v] |= all_values_[before][v] == 0;
  }

  Crossing nearest_crossing(VertexIndex v) const {
    Crossing best;
    for (const TetIndex t : around_[v])
      for (const VertexIndex w : mesh_.tets[t]) {
        if (w == v || values_[v] * values_[w] >= 0) continue;
        const double part = values_[v] / (values_[v] - values_[w]);
        if (part < best.part || (part == best.part && w < best.end)) best = {w, part};
      }
    return best;
  }

  double poorest_around(VertexIndex v) const {
    double poorest = 1;
    for (const TetIndex t : around_[v]) {
      const auto& [a, b, c, d] = mesh_.tets[t];
      const auto& p = mesh_.points;
      if (orient3d(p[a], p[b], p[c], p[d]) <= 0) return -1;
      poorest = std::min(poorest, tet_radius_ratio(p[a], p[b], p[c], p[d]));
    }
    return poorest;
  }

  bool move(VertexIndex v) {
    const Crossing to = nearest_crossing(v);
    if (!(to.part <= kFarthestMove)) return false;
    const Vec3 before = mesh_.points[v];
    const double wanted = std::min(kSound, kWorstPart * poorest_around(v));
    mesh_.points[v] = before + to.part * (mesh_.points[to.end] - before);
    if (poorest_around(v) < wanted) {
      mesh_.points[v] = before;
      return false;
    }
    for (std::vector<double>& values : all_values_) values[v] += to.part * (values[to.end] - values[v]);
    values_[v] = 0;
    return true;
  }

  TetMesh& mesh_;
  std::vector<std::vector<double>>& all_values_;
  std::vector<double>& values_;
  Groups<> around_;
  std::vector<std::uint8_t> is_fixed_;
};

}  // namespace

std::uint64_t move_to_surface(CutState& state, std::size_t level_set) {
  return SurfaceMover(state, level_set).move_all();
}

}  // namespace octafront::adapt
