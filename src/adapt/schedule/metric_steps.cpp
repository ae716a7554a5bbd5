#include "adapt/schedule/metric_steps.h"

#include "base/core/elementary.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/mesh/face_table.h"

#include <algorithm>

namespace octafront::adapt {
namespace {

/// Each step makes lengths so many times as short at most.
constexpr double kStepOfMetric = 2;
/// Elements more than a million times as long as they are high are flat by rounding: of squared lengths.
constexpr double kMostRatioOfMetric = 1e12;
/// The ends of an arc look away from its chord by four times its height: as high an arc makes a chord too long.
constexpr double kMostHeightOfArc = kLongest / 4;
/// How long chords of higher arcs are made to be: so that they are divided.
constexpr double kLengthOfChord = 1.6;
/// How far the ground is looked for, in edge lengths.
constexpr double kReachOfArc = 0.5;

/// The logarithms of the metrics that elements imply; those flat to rounding say nothing.
class ImpliedMetrics {
 public:
  explicit ImpliedMetrics(const Parts& mesh) : logs_(mesh.tets.size()), speaks_(mesh.tets.size()) {
    parallel_for(logs_.size(), [&](std::size_t t) {
      const auto point = [&](int i) { return mesh.vertices[mesh.tets[t][i]].at; };
      Eigen implied = eigen(implied_metric(point(0), point(1), point(2), point(3)));
      const auto [least, most] = std::minmax_element(implied.value.begin(), implied.value.end());
      speaks_[t] = *least > 0 && *most < kMostRatioOfMetric * *least;
      if (!speaks_[t]) return;
      for (double& value : implied.value) value = elementary::log(value);
      logs_[t] = implied.tensor();
    });
  }

  /// The mean of those of `corners`, numbers of corners of elements; false if none speaks.
  bool mean(std::span<const std::uint32_t> corners, Metric& out) const {
    Metric sum{0, 0, 0, 0, 0, 0};
    int count = 0;
    for (const std::uint32_t c : corners)
      if (speaks_[c / 4]) sum = sum + logs_[c / 4], ++count;
    if (count > 0) out = exp_of((1.0 / count) * sum);
    return count > 0;
  }

 private:
  std::vector<Metric> logs_;
  std::vector<std::uint8_t> speaks_;
};

/// Edges of walls that lie so far from the ground that the metric would find their halves too long.
class HighArcs {
 public:
  HighArcs(const Parts& mesh, const Guide& guide) : mesh_(mesh), guide_(guide) {
    for (const Parts::Line& l : mesh.lines) lines_.find_or_add(l.edge) = l.path;
    collect();
    std::vector<std::uint8_t> high(edges_.size());
    parallel_for(edges_.size(), [&](std::size_t e) { high[e] = is_high(edges_[e]); });
    for (std::size_t e = 0; e < high.size(); ++e)
      if (high[e]) found_.push_back(edges_[e].ends);
  }

  const std::vector<Edge>& found() const { return found_; }

 private:
  struct WallEdge {
    Edge ends;
    Wall wall;
    Vec3 normal;  ///< of a triangle that has it
  };

  void collect() {
    FlatSet<Edge> seen;
    if (!guide_.kept.empty()) collect(seen, true);  // edges that they share with others stay, too
    collect(seen, false);
  }
  void collect(FlatSet<Edge>& seen, bool of_kept) {
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
      for (int i = 0; i < 4; ++i) {
        const Wall w = mesh_.wall[t][static_cast<std::size_t>(i)];
        if (w == 0 || guide_.keeps(w) != of_kept) continue;
        const Triangle f = face_of(mesh_.tets[t], i);
        const Vec3 n = double_area_normal(at(f[0]), at(f[1]), at(f[2]));
        for (std::size_t k = 0; k < 3; ++k) {
          const Edge ends = sorted_edge(f[k], f[(k + 1) % 3]);
          const bool may_change = !mesh_.vertices[ends[0]].frozen || !mesh_.vertices[ends[1]].frozen;
          if (may_change && seen.insert(ends) && !of_kept) edges_.push_back({ends, w, normalized(n)});
        }
      }
  }

  bool is_high(const WallEdge& e) const {
    const std::uint32_t* path = lines_.find(e.ends);
    if (path && *path == Parts::kStays) return false;
    const Vec3 a = at(e.ends[0]), b = at(e.ends[1]), middle = 0.5 * (a + b);
    const double reach = kReachOfArc * distance(a, b);
    const auto offset = [&](Vec3 p) {
      const auto home =
          path ? guide_.ground.on_line(p, *path, reach)
               : guide_.ground.on_surface(p, (e.wall & ~kOuter) - 1, (e.wall & kOuter) != 0, e.normal, reach);
      return home ? *home - p : Vec3{};
    };
    std::uint32_t hint = mesh_.vertices[e.ends[0]].hint;
    const auto wanted_at = [&](VertexIndex v) {
      return mesh_.vertices[v].exact ? mesh_.vertices[v].metric : guide_.metric.at(at(v), hint);
    };
    // Divided for the height alone it would be collapsed again.
    if (metric_length(b - a, wanted_at(e.ends[0]), wanted_at(e.ends[1])) <= kLongest) return false;
    const Metric metric = guide_.metric.at(middle, hint);
    const auto is_long = [&](Vec3 d) { return metric.squared(d) > kMostHeightOfArc * kMostHeightOfArc; };
    const Vec3 height = offset(middle);
    // Where its ends could not come to the ground its halves could not either.
    return is_long(height) && is_long(height - 0.5 * (offset(a) + offset(b)));
  }

  Vec3 at(VertexIndex v) const { return mesh_.vertices[v].at; }

  const Parts& mesh_;
  const Guide& guide_;
  FlatMap<Edge, std::uint32_t> lines_;
  std::vector<WallEdge> edges_;
  std::vector<Edge> found_;
};

/// Makes the metric of a vertex such that e is at least so long.
void ask_along(Vertex& vertex, Vec3 e, double length) {
  const Metric& m = vertex.metric;
  const double had = m.squared(e);
  if (!(had > 0) || had >= length * length) return;
  const Vec3 g = m.times(e);
  const double more = (length * length / had - 1) / had;
  vertex.metric = m + more * Metric{g.x * g.x, g.x * g.y, g.x * g.z, g.y * g.y, g.y * g.z, g.z * g.z};
  vertex.density = density_of(vertex.metric);
  vertex.exact = false;
}

}  // namespace

std::size_t take_step(Parts& mesh, const Guide& guide, bool last, bool walls_ahead) {
  const auto vertices = static_cast<std::uint32_t>(mesh.vertices.size());
  const ImpliedMetrics implied(mesh);
  const Groups<> corners = group_by_owner(vertices, static_cast<std::uint32_t>(4 * mesh.tets.size()),
                                          [&](std::uint32_t c) { return mesh.tets[c / 4][c % 4]; });
  std::vector<Metric> had(vertices);
  parallel_for(vertices, [&](std::size_t v) {
    Vertex& vertex = mesh.vertices[v];
    had[v] = vertex.metric, vertex.exact = true;
    guide.ask(vertex);
    Metric is;
    if (last || !implied.mean(corners[v], is)) return;
    vertex.metric = step_towards(is, vertex.metric, kStepOfMetric, vertex.exact);
    vertex.density = density_of(vertex.metric);
  });
  if (!last && walls_ahead) {
    const HighArcs arcs(mesh, guide);
    for (const Edge& e : arcs.found())
      for (const VertexIndex v : e)
        ask_along(mesh.vertices[v], mesh.vertices[e[1]].at - mesh.vertices[e[0]].at, kLengthOfChord);
  }
  for (VertexIndex v = 0; v < vertices; ++v) {
    Vertex& vertex = mesh.vertices[v];
    if (vertex.metric == had[v]) continue;
    vertex.active = vertex.loose = true, vertex.calmness = Vertex::kStirred;
  }
  const auto is_on_the_way = [](const Vertex& v) { return !v.exact; };
  return static_cast<std::size_t>(std::count_if(mesh.vertices.begin(), mesh.vertices.end(), is_on_the_way));
}

}  // namespace octafront::adapt
