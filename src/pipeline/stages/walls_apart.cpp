#include "pipeline/stages/walls_apart.h"

#include "adapt/schedule/rim_metric.h"
#include "base/geometry/self_intersection.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {
namespace {

/// Walls are kept at places that cross and more and more layers of triangles around, so many times.
constexpr int kMostKeptLayers = 4;

std::string place_of(Vec3 p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

class WallsApart {
 public:
  WallsApart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules, const Stage& stage)
      : given_(given), metric_(metric), rules_(rules), stage_(stage), tree_(given.points, given.boundary) {}

  adapt::Adapted run() {
    adapt(metric_);
    if (crossings_.empty()) return std::move(made_);
    keep_where_it_crosses();
    if (crossings_.empty()) return std::move(made_);
    if (rules_.given) {
      const Vec3 p = place();
      rules_.given = nullptr;
      adapt(metric_);
      stage_.note(fmt::format(
          "on the surface given the boundary would have crossed itself at {}, where it is near to itself: it is on "
          "its own smooth surface instead, everywhere",
          place_of(p)));
      keep_where_it_crosses();
      if (crossings_.empty()) return std::move(made_);
    }
    keep_all();
    return std::move(made_);
  }

 private:
  void adapt(const adapt::MetricField& metric) {
    made_ = adapt::adapt_mesh(given_, metric, rules_, stage_);
    crossings_ = self_intersections(made_.mesh.points, made_.mesh.boundary, kMostCrossings, stage_.context());
  }

  Vec3 place() const { return made_.mesh.points[made_.mesh.boundary[crossings_[0][0]][0]]; }

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
      rules_.kept = kept;
      adapt(adapt::RimMetric(given_, kept, metric_));
    }
    rules_.kept = {};
    if (!crossings_.empty()) return;
    const auto is_kept = [&](const Triangle& t) { return kept[t[0]] && kept[t[1]] && kept[t[2]]; };
    stage_.note(
        fmt::format("the boundary would have crossed itself, first at {}, where it is near to itself: {} of its "
                    "{} triangles stay as they were there; a smaller --max-deviation may help",
                    place_of(first), std::count_if(given_.boundary.begin(), given_.boundary.end(), is_kept),
                    given_.boundary.size()));
  }

  /// The old triangles that are nearest to the corners of those that cross.
  void mark_crossings(std::vector<std::uint8_t>& kept) const {
    for (const auto& pair : crossings_)
      for (const std::uint32_t f : pair)
        for (const VertexIndex v : made_.mesh.boundary[f])
          for (const VertexIndex old : given_.boundary[tree_.nearest(made_.mesh.points[v]).triangle]) kept[old] = 1;
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
                    place_of(place())));
    rules_.keep_walls = true;
    made_ = adapt::adapt_mesh(given_, adapt::RimMetric(given_, adapt::on_walls(given_), metric_), rules_, stage_);
  }

  /// More of them say no more about where.
  static constexpr std::size_t kMostCrossings = 100'000;

  const TetMesh& given_;
  const adapt::MetricField& metric_;
  adapt::AdaptRules rules_;
  const Stage& stage_;
  TriangleTree tree_;
  adapt::Adapted made_;
  std::vector<std::array<std::uint32_t, 2>> crossings_;
};

}  // namespace

adapt::Adapted adapted_with_walls_apart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules,
                                        const Stage& stage) {
  return WallsApart(given, metric, rules, stage).run();
}

}  // namespace octafront
