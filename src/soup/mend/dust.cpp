#include "base/core/renumber.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/mesh/edge_table.h"
#include "soup/mend/mend_steps.h"

#include <algorithm>
#include <array>

namespace octafront::mend {
namespace {

/// One collapse may bring the next; dust that does not settle in so many passes stays.
constexpr int kMostDustPasses = 30;

using Corners = std::array<Vec3, 3>;

double longest_edge(const Corners& t) {
  return std::max({distance(t[0], t[1]), distance(t[1], t[2]), distance(t[2], t[0])});
}

double height(const Corners& t) {
  const double longest = longest_edge(t);
  return longest > 0 ? length(cross(t[1] - t[0], t[2] - t[0])) / longest : 0;
}

/// Changes of one pass do not touch each other, so that the tables made before it hold.
class DustPass {
 public:
  DustPass(SurfaceMesh& surface, double reach)
      : surface_(surface),
        reach_(reach),
        edges_(make_edge_table(surface.points.size(), surface.triangles)),
        edge_of_(edges_.edge_of_half_edge()),
        is_touched_(surface.points.size()),
        is_gone_(surface.triangles.size()) {
    fill_fans();
  }

  std::uint64_t run() {
    std::uint64_t done = 0;
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
      if (is_gone_[t] || height(corners(surface_.triangles[t])) >= reach_) continue;
      const HalfEdge shortest = extreme_edge(t, -1);
      done += edge_length(shortest) < reach_ ? collapse(shortest) : turn(extreme_edge(t, 1));
    }
    compact();
    return done;
  }

 private:
  void fill_fans() {
    first_.assign(surface_.points.size() + 1, 0);
    for (const Triangle& t : surface_.triangles)
      for (const VertexIndex v : t) ++first_[v + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    fans_.resize(3 * surface_.triangles.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t)
      for (const VertexIndex v : surface_.triangles[t]) fans_[next[v]++] = t;
  }

  std::span<const std::uint32_t> fan(VertexIndex v) const {
    return {fans_.data() + first_[v], fans_.data() + first_[v + 1]};
  }

  Corners corners(const Triangle& t) const {
    return {surface_.points[t[0]], surface_.points[t[1]], surface_.points[t[2]]};
  }
  VertexIndex start(HalfEdge h) const { return start_of(surface_.triangles, h); }
  VertexIndex end(HalfEdge h) const { return end_of(surface_.triangles, h); }
  double edge_length(HalfEdge h) const { return distance(surface_.points[start(h)], surface_.points[end(h)]); }

  /// The longest edge of a triangle, or with -1 the shortest.
  HalfEdge extreme_edge(std::uint32_t t, double sign) const {
    HalfEdge best = 3 * t;
    for (HalfEdge h = 3 * t + 1; h < 3 * t + 3; ++h)
      if (sign * edge_length(h) > sign * edge_length(best)) best = h;
    return best;
  }

  bool touch(std::span<const std::uint32_t> triangles, bool mark) {
    for (const std::uint32_t t : triangles)
      for (const VertexIndex v : surface_.triangles[t]) {
        if (mark)
          is_touched_[v] = 1;
        else if (is_touched_[v])
          return true;
      }
    return false;
  }

  bool collapse(HalfEdge h) {
    const VertexIndex keep = std::min(start(h), end(h)), lost = std::max(start(h), end(h));
    if (touch(fan(keep), false) || touch(fan(lost), false) || common_neighbours(keep, lost) != 2) return false;
    for (const std::uint32_t t : fan(lost))
      if (!has(t, keep) && folds(surface_.triangles[t], with(surface_.triangles[t], lost, keep))) return false;
    touch(fan(keep), true);
    touch(fan(lost), true);
    for (const std::uint32_t t : fan(lost)) {
      is_gone_[t] = has(t, keep);
      surface_.triangles[t] = with(surface_.triangles[t], lost, keep);
    }
    return true;
  }

  bool has(std::uint32_t t, VertexIndex v) const { return std::ranges::count(surface_.triangles[t], v) > 0; }

  static Triangle with(Triangle t, VertexIndex old, VertexIndex now) {
    std::ranges::replace(t, old, now);
    return t;
  }

  /// Triangles that are dust themselves may face any way.
  bool folds(const Triangle& before, const Triangle& after) const {
    const Corners was = corners(before), is = corners(after);
    if (collinear(is[0], is[1], is[2])) return true;
    return height(was) >= reach_ &&
           dot(double_area_normal(was[0], was[1], was[2]), double_area_normal(is[0], is[1], is[2])) <= 0;
  }

  std::size_t common_neighbours(VertexIndex a, VertexIndex b) const {
    const std::vector<VertexIndex> of_a = neighbours(a), of_b = neighbours(b);
    return static_cast<std::size_t>(
        std::ranges::count_if(of_a, [&](VertexIndex v) { return std::ranges::binary_search(of_b, v); }));
  }

  std::vector<VertexIndex> neighbours(VertexIndex v) const {
    std::vector<VertexIndex> all;
    for (const std::uint32_t t : fan(v))
      for (const VertexIndex w : surface_.triangles[t])
        if (w != v) all.push_back(w);
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// The edge a-b between the vertices c and d, which becomes c-d.
  bool turn(HalfEdge h) {
    const auto uses = edges_.uses(edge_of_[h]);
    if (uses.size() != 2) return false;
    const HalfEdge g = uses[0] == h ? uses[1] : uses[0];
    const std::array<std::uint32_t, 2> both{h / 3, g / 3};
    if (touch(both, false)) return false;
    const VertexIndex a = start(h), b = end(h), c = end(next_of(h)), d = end(next_of(g));
    const Edge across{std::min(c, d), std::max(c, d)};
    if (c == d || std::ranges::binary_search(edges_.edges, across)) return false;
    const Triangle first{a, d, c}, second{d, b, c};
    const double before =
        std::min(height(corners(surface_.triangles[both[0]])), height(corners(surface_.triangles[both[1]])));
    const double after = std::min(height(corners(first)), height(corners(second)));
    if (after <= before || folds(surface_.triangles[both[1]], first) || folds(surface_.triangles[both[1]], second))
      return false;
    touch(both, true);
    surface_.triangles[both[0]] = first;
    surface_.triangles[both[1]] = second;
    follow(both[0], both[1]);
    return true;
  }

  /// A triangle in the plane of another one belongs where that does.
  void follow(std::uint32_t t, std::uint32_t other) {
    if (!surface_.patch.empty()) surface_.patch[t] = surface_.patch[other];
    if (!surface_.source.empty()) surface_.source[t] = surface_.source[other];
  }

  void compact() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < is_gone_.size(); ++t) {
      if (is_gone_[t]) continue;
      surface_.triangles[kept] = surface_.triangles[t];
      if (!surface_.patch.empty()) surface_.patch[kept] = surface_.patch[t];
      if (!surface_.source.empty()) surface_.source[kept] = surface_.source[t];
      ++kept;
    }
    surface_.triangles.resize(kept);
    if (!surface_.patch.empty()) surface_.patch.resize(kept);
    if (!surface_.source.empty()) surface_.source.resize(kept);
  }

  SurfaceMesh& surface_;
  double reach_;
  EdgeTable edges_;
  RawVector<std::uint32_t> edge_of_;         ///< per half-edge
  std::vector<std::uint32_t> first_, fans_;  ///< the triangles around each vertex
  std::vector<char> is_touched_;             ///< per vertex, by this pass
  std::vector<char> is_gone_;                ///< per triangle
};

}  // namespace

std::uint64_t drop_dust(SurfaceMesh& surface, double reach) {
  std::uint64_t all = 0;
  for (int pass = 0; pass < kMostDustPasses; ++pass) {
    const std::uint64_t done = DustPass(surface, reach).run();
    if (done == 0) break;
    all += done;
  }
  if (all > 0) drop_unused_points(surface.points, surface.triangles);
  return all;
}

}  // namespace octafront::mend
