#include "adapt/schedule/rim_metric.h"
#include "base/core/wording.h"
#include "base/geometry/self_intersection.h"
#include "base/geometry/triangle_tree.h"
#include "pipeline/stages/adapting.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {
namespace {

/// Walls are kept at places that cross and more and more layers of triangles around, so many times.
constexpr int kMostKeptLayers = 4;

class WallsApart {
 public:
  WallsApart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules, const TryWalls& attempt,
             const Stage& stage)
      : given_(given),
        metric_(metric),
        rules_(rules),
        attempt_(attempt),
        stage_(stage),
        tree_(given.points, given.boundary) {}

  void run() {
    adapt(metric_);
    if (crossings_.empty()) return;
    keep_where_it_crosses();
    if (crossings_.empty()) return;
    if (rules_.given) {
      const Vec3 p = place();
      rules_.given = nullptr;
      adapt(metric_);
      stage_.note(fmt::format(
          "on the surface given the boundary would have crossed itself at {}, where it is near to itself: it is on "
          "its own smooth surface instead, everywhere",
          at_point(p)));
      keep_where_it_crosses();
      if (crossings_.empty()) return;
    }
    keep_all();
  }

 private:
  void adapt(const adapt::MetricField& metric) { crossings_ = attempt_(metric, rules_); }

  Vec3 place() const { return crossings_[0][0]; }

  void keep_where_it_crosses() {
    if (!crossings_.empty() && !metric_.is_isotropic()) {  // with walls less near to the ground they may not meet
      rules_.walls_ahead = false;
      adapt(metric_);
    }
    if (crossings_.empty()) return;
    const Vec3 first = place();
    std::vector<std::uint8_t> kept(given_.points.size(), 0);
    for (int layers = 1; layers <= kMostKeptLayers && !crossings_.empty(); ++layers) {
      mark_crossings(kept);
      for (int k = 0; k < layers; ++k) add_layer(kept);
      const std::vector<std::uint8_t> stays = with_frozen(kept);
      rules_.kept = stays;
      adapt(adapt::RimMetric(given_, stays, metric_));
    }
    rules_.kept = {};
    if (!crossings_.empty()) return;
    const auto is_kept = [&](const Triangle& t) { return kept[t[0]] && kept[t[1]] && kept[t[2]]; };
    stage_.note(
        fmt::format("the boundary would have crossed itself, first at {}, where it is near to itself: {} of its "
                    "{} triangles stay as they were there; a smaller --max-deviation may help",
                    at_point(first), std::count_if(given_.boundary.begin(), given_.boundary.end(), is_kept),
                    given_.boundary.size()));
  }

  /// The old triangles that are nearest to the corners of those that cross.
  void mark_crossings(std::vector<std::uint8_t>& kept) const {
    for (const TriangleCorners& corners : crossings_)
      for (const Vec3 p : corners)
        if (const std::uint32_t t = tree_.nearest(p).triangle; t != kNone)
          for (const VertexIndex old : given_.boundary[t]) kept[old] = 1;
  }

  std::vector<std::uint8_t> with_frozen(std::vector<std::uint8_t> kept) const {
    for (VertexIndex v = 0; v < rules_.frozen.size(); ++v) kept[v] |= rules_.frozen[v];
    return kept;
  }

  void add_layer(std::vector<std::uint8_t>& kept) const {
    const std::vector<std::uint8_t> before = kept;
    for (const Triangle& t : given_.boundary)
      if (before[t[0]] || before[t[1]] || before[t[2]])
        for (const VertexIndex v : t) kept[v] = 1;
  }

  void keep_all() {
    stage_.note(
        fmt::format("the boundary would have crossed itself at {}, where it is near to itself: it stays as it "
                    "was, everywhere; a smaller --max-deviation may help",
                    at_point(place())));
    rules_.keep_walls = true;
    adapt(adapt::RimMetric(given_, with_frozen(adapt::on_walls(given_)), metric_));
  }

  const TetMesh& given_;
  const adapt::MetricField& metric_;
  adapt::AdaptRules rules_;
  const TryWalls& attempt_;
  const Stage& stage_;
  TriangleTree tree_;
  std::vector<TriangleCorners> crossings_;
};

/// More of them say no more about where.
constexpr std::size_t kMostCrossings = 100'000;

}  // namespace

std::vector<TriangleCorners> crossing_triangles(const std::vector<Vec3>& points, const std::vector<Triangle>& boundary,
                                                const Stage& stage) {
  std::vector<TriangleCorners> found;
  for (const auto& pair : self_intersections(points, boundary, kMostCrossings, stage.context()))
    for (const std::uint32_t f : pair) {
      const auto& [a, b, c] = boundary[f];
      found.push_back({points[a], points[b], points[c]});
    }
  return found;
}

void keep_walls_apart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules,
                      const TryWalls& attempt, const Stage& stage) {
  WallsApart(given, metric, rules, attempt, stage).run();
}

adapt::Adapted adapted_with_walls_apart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules,
                                        const Stage& stage) {
  adapt::Adapted made;
  const TryWalls attempt = [&](const adapt::MetricField& wanted, const adapt::AdaptRules& now) {
    made = adapt::adapt_mesh(given, wanted, now, stage);
    return crossing_triangles(made.mesh.points, made.mesh.boundary, stage);
  };
  keep_walls_apart(given, metric, rules, attempt, stage);
  return made;
}

}  // namespace octafront
