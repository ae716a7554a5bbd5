#include "base/core/renumber.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"
#include "soup/cells/cell_steps.h"

#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace octafront::cells {
namespace {

/// How far triangles around a vertex that goes may turn: the cosine of 25 degrees.
constexpr double kTurn = 0.9;

class Dissolving {
 public:
  Dissolving(SurfaceMesh& complex, const std::vector<char>& may_go, double most, const RunContext& context)
      : mesh_(complex), may_go_(may_go), most_(most), context_(context), around_(complex.points.size()) {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const VertexIndex v : mesh_.triangles[t]) around_[v].push_back(t);
    gone_.assign(mesh_.triangles.size(), 0);
  }

  std::uint64_t result() {
    std::uint64_t went = 0;
    for (bool any = true; any;) {
      any = false;
      for (const VertexIndex v : shortest_first()) {
        context_.check();
        const std::optional<VertexIndex> to = best_neighbour(v);
        if (!to) continue;
        collapse(v, *to);
        any = true;
        ++went;
      }
    }
    tidy();
    return went;
  }

 private:
  const std::vector<Vec3>& points() const { return mesh_.points; }

  std::vector<VertexIndex> neighbours(VertexIndex v) const {
    std::vector<VertexIndex> all;
    for (const std::uint32_t t : around_[v])
      for (const VertexIndex w : mesh_.triangles[t])
        if (w != v) all.push_back(w);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Those that lie in the way of elements most go first.
  std::vector<VertexIndex> shortest_first() const {
    std::vector<std::pair<double, VertexIndex>> order;
    for (VertexIndex v = 0; v < around_.size(); ++v) {
      if (!may_go_[v] || around_[v].empty()) continue;
      double shortest = HUGE_VAL;
      for (const VertexIndex w : neighbours(v)) shortest = std::min(shortest, distance(points()[v], points()[w]));
      order.emplace_back(shortest, v);
    }
    std::sort(order.begin(), order.end());
    std::vector<VertexIndex> vertices;
    for (const auto& [length, v] : order) vertices.push_back(v);
    return vertices;
  }

  std::vector<std::uint32_t> at_edge(VertexIndex v, VertexIndex w) const {
    std::vector<std::uint32_t> both;
    for (const std::uint32_t t : around_[v])
      if (has(t, w)) both.push_back(t);
    return both;
  }
  bool has(std::uint32_t t, VertexIndex v) const {
    return std::find(mesh_.triangles[t].begin(), mesh_.triangles[t].end(), v) != mesh_.triangles[t].end();
  }

  /// Regions on either side, whichever way the triangle faces, and patch.
  auto kind(std::uint32_t t) const {
    const Sides s = mesh_.sides[t];
    return std::tuple(std::min(s[0], s[1]), std::max(s[0], s[1]), mesh_.patch_of(t));
  }

  bool is_line(VertexIndex v, VertexIndex w) const {
    const auto both = at_edge(v, w);
    return both.size() != 2 || kind(both[0]) != kind(both[1]);
  }

  std::optional<VertexIndex> best_neighbour(VertexIndex v) const {
    const std::vector<VertexIndex> all = neighbours(v);
    std::vector<VertexIndex> lines;
    for (const VertexIndex w : all)
      if (is_line(v, w)) lines.push_back(w);
    if (!lines.empty() && lines.size() != 2) return std::nullopt;
    if (!lines.empty() &&
        distance(points()[v], closest_point_on_segment(points()[v], points()[lines[0]], points()[lines[1]])) > most_)
      return std::nullopt;
    std::optional<VertexIndex> best;
    std::pair<double, double> least{most_, HUGE_VAL};
    for (const VertexIndex w : lines.empty() ? all : lines) {
      const std::optional<double> strays = strays_by(v, w, all);
      if (!strays) continue;
      const std::pair cost{*strays, distance(points()[v], points()[w])};
      if (cost > least) continue;
      least = cost;
      best = w;
    }
    return best;
  }

  /// How far the surface moves if v goes to w; nullopt if it may not.
  std::optional<double> strays_by(VertexIndex v, VertexIndex w, const std::vector<VertexIndex>& of_v) const {
    const std::vector<std::uint32_t> lost = at_edge(v, w);
    const std::vector<VertexIndex> of_w = neighbours(w);
    std::vector<VertexIndex> common;
    std::set_intersection(of_v.begin(), of_v.end(), of_w.begin(), of_w.end(), std::back_inserter(common));
    std::set<VertexIndex> apexes;
    for (const std::uint32_t t : lost)
      for (const VertexIndex x : mesh_.triangles[t])
        if (x != v && x != w) apexes.insert(x);
    if (common.size() != apexes.size()) return std::nullopt;
    const Vec3 p = points()[v];
    double nearest = HUGE_VAL;
    for (const std::uint32_t t : around_[v]) {
      if (has(t, w)) continue;
      Triangle made = mesh_.triangles[t];
      std::replace(made.begin(), made.end(), v, w);
      const Vec3 a = points()[made[0]], b = points()[made[1]], c = points()[made[2]];
      if (collinear(a, b, c) || exists(made, w)) return std::nullopt;
      const auto [i, j, k] = mesh_.triangles[t];
      if (dot(unit_normal(points()[i], points()[j], points()[k]), unit_normal(a, b, c)) < kTurn) return std::nullopt;
      nearest = std::min(nearest, distance(p, closest_point_on_triangle(p, a, b, c)));
    }
    return nearest;
  }

  bool exists(const Triangle& t, VertexIndex at) const {
    return std::any_of(around_[at].begin(), around_[at].end(),
                       [&](std::uint32_t s) { return face_key(mesh_.triangles[s]) == face_key(t); });
  }

  void collapse(VertexIndex v, VertexIndex w) {
    for (const std::uint32_t t : around_[v]) {
      if (has(t, w)) {
        gone_[t] = 1;
        for (const VertexIndex x : mesh_.triangles[t])
          if (x != v) std::erase(around_[x], t);
        continue;
      }
      std::replace(mesh_.triangles[t].begin(), mesh_.triangles[t].end(), v, w);
      around_[w].push_back(t);
    }
    around_[v].clear();
  }

  template <class T>
  void keep(std::vector<T>& values) const {
    if (values.empty()) return;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < gone_.size(); ++t)
      if (!gone_[t]) values[kept++] = values[t];
    values.resize(kept);
  }

  void tidy() {
    keep(mesh_.triangles);
    keep(mesh_.sides);
    keep(mesh_.patch);
    keep(mesh_.source);
    PointsTaken taken(mesh_.points);
    std::vector<Vec3> used;
    for (Triangle& t : mesh_.triangles) t = taken.take(t, used);
    mesh_.points = std::move(used);
  }

  SurfaceMesh& mesh_;
  const std::vector<char>& may_go_;
  double most_;
  const RunContext& context_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<char> gone_;
};

}  // namespace

std::uint64_t dissolve(SurfaceMesh& complex, const std::vector<char>& may_go, double most, const RunContext& context) {
  SurfaceMesh made = complex;
  const std::uint64_t went = Dissolving(made, may_go, most, context).result();
  if (went == 0 || !self_intersections(made.points, made.triangles, 1, context).empty()) return 0;
  complex = std::move(made);
  return went;
}

}  // namespace octafront::cells
