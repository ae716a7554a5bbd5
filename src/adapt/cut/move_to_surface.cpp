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

/// Points move by this part of their shortest edge at most: beyond, others are as near, and what is as small as an
/// element would vanish.
constexpr double kFarthestMove = 0.4;
/// Elements become no worse than this part of the poorest of those around, or than what is sound anyhow (3 r / R).
constexpr double kWorstPart = 0.5, kSound = 0.25;
/// Points that cannot go are taken for points of the surface if it is nearer than this part of an edge: pieces that
/// thin are no elements.
constexpr double kTakenForOn = 0.1;
/// The cosine of the angle by which triangles of a smooth wall may be turned, 10 degrees.
constexpr double kSmooth = 0.985;

/// Who may go where.
enum class Freedom : std::uint8_t { kInside, kOnWall, kFixed };

class SurfaceMover {
 public:
  SurfaceMover(CutState& state, std::size_t level_set)
      : state_(state),
        mesh_(state.mesh),
        all_values_(state.values),
        values_(state.values[level_set]),
        around_(rows_at_vertices(mesh_.points.size(), mesh_.tets)),
        walls_around_(rows_at_vertices(mesh_.points.size(), mesh_.boundary)),
        freedom_(mesh_.points.size(), Freedom::kInside) {
    find_walls();
    fix_what_hangs_on();
  }

  void move_all(LevelSetReport& report) {
    for (VertexIndex v = 0; v < mesh_.points.size(); ++v) {
      if (values_[v] == 0) continue;
      if (freedom_[v] != Freedom::kFixed && move(v)) {
        ++report.moved;
      } else if (nearest_crossing(v, false).part < kTakenForOn) {
        values_[v] = 0, ++report.on;
      }
    }
  }

 private:
  struct Crossing {
    VertexIndex end = kNone;
    double part = std::numeric_limits<double>::infinity();  ///< of the edge, from this end
  };

  Vec3 normal(std::uint32_t face) const {
    const auto& [a, b, c] = mesh_.boundary[face];
    return unit_normal(mesh_.points[a], mesh_.points[b], mesh_.points[c]);
  }
  std::uint32_t patch(std::uint32_t face) const { return mesh_.patch.empty() ? 0 : mesh_.patch[state_.old_face[face]]; }

  /// On the boundary points may go along it where it is smooth and of one patch.
  void find_walls() {
    for (VertexIndex v = 0; v < mesh_.points.size(); ++v) {
      const auto faces = walls_around_[v];
      if (faces.empty()) continue;
      const Vec3 first = normal(faces[0]);
      const bool is_smooth = std::all_of(faces.begin(), faces.end(), [&](std::uint32_t f) {
        return patch(f) == patch(faces[0]) && dot(first, normal(f)) >= kSmooth;
      });
      freedom_[v] = is_smooth ? Freedom::kOnWall : Freedom::kFixed;
    }
  }

  /// Points of interfaces, curves, sets and of surfaces along which it was cut before keep their places.
  void fix_what_hangs_on() {
    const auto fix = [&](VertexIndex v) { freedom_[v] = Freedom::kFixed; };
    for (const Triangle& f : mesh_.interfaces)
      for (const VertexIndex v : f) fix(v);
    for (const Edge& e : mesh_.curve_edges)
      for (const VertexIndex v : e) fix(v);
    for (const NamedSet& set : mesh_.sets)
      if (set.kind == NamedSet::Kind::kNodes)
        for (const VertexIndex v : set.members) fix(v);
    for (std::size_t before = 0; &all_values_[before] != &values_; ++before)
      for (VertexIndex v = 0; v < mesh_.points.size(); ++v)
        if (all_values_[before][v] == 0) fix(v);
  }

  void look_along(VertexIndex v, VertexIndex w, Crossing& best) const {
    if (w == v || values_[v] * values_[w] >= 0) return;
    const double part = values_[v] / (values_[v] - values_[w]);
    if (part < best.part || (part == best.part && w < best.end)) best = {w, part};
  }

  Crossing nearest_crossing(VertexIndex v, bool along_wall) const {
    Crossing best;
    if (along_wall) {
      for (const std::uint32_t f : walls_around_[v])
        for (const VertexIndex w : mesh_.boundary[f]) look_along(v, w, best);
    } else {
      for (const TetIndex t : around_[v])
        for (const VertexIndex w : mesh_.tets[t]) look_along(v, w, best);
    }
    return best;
  }

  double shortest_edge(VertexIndex v) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const TetIndex t : around_[v])
      for (const VertexIndex w : mesh_.tets[t])
        if (w != v) shortest = std::min(shortest, distance(mesh_.points[v], mesh_.points[w]));
    return shortest;
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

  bool walls_stay(VertexIndex v, Vec3 before) const {
    const auto faces = walls_around_[v];
    return std::all_of(faces.begin(), faces.end(), [&](std::uint32_t f) { return dot(before, normal(f)) >= kSmooth; });
  }

  bool move(VertexIndex v) {
    const bool is_on_wall = freedom_[v] == Freedom::kOnWall;
    const Crossing to = nearest_crossing(v, is_on_wall);
    if (to.end == kNone) return false;
    const Vec3 before = mesh_.points[v], direction = is_on_wall ? normal(walls_around_[v][0]) : Vec3{};
    if (to.part * distance(before, mesh_.points[to.end]) > kFarthestMove * shortest_edge(v)) return false;
    const double wanted = std::min(kSound, kWorstPart * poorest_around(v));
    mesh_.points[v] = before + to.part * (mesh_.points[to.end] - before);
    if (poorest_around(v) < wanted || (is_on_wall && !walls_stay(v, direction))) {
      mesh_.points[v] = before;
      return false;
    }
    for (std::vector<double>& values : all_values_) values[v] += to.part * (values[to.end] - values[v]);
    values_[v] = 0;
    return true;
  }

  const CutState& state_;
  TetMesh& mesh_;
  std::vector<std::vector<double>>& all_values_;
  std::vector<double>& values_;
  Groups<> around_, walls_around_;
  std::vector<Freedom> freedom_;
};

}  // namespace

void move_to_surface(CutState& state, std::size_t level_set, LevelSetReport& report) {
  SurfaceMover(state, level_set).move_all(report);
}

}  // namespace octafront::adapt
