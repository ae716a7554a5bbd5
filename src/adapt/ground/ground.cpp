#include "adapt/ground/ground.h"

#include "base/core/disjoint_sets.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/nearest_that.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace octafront::adapt {
namespace {

/// A foot is not on the other side of a thin wall, nor around a sharp edge.
constexpr double kLeastCosineOfFoot = 0.5;
/// Triangles are divided into four so many times at most.
constexpr int kMostDivisionsOfGround = 5;
/// A given surface may be as far from the places of an element as this part of its longest edge, for its triangles do
/// not follow what is smaller.
constexpr double kReachOfEdge = 0.5;
/// What is nearer than this part of the reach lies on the given surface, whatever else is near; what is farther does
/// not if another wall is nearer than this part of the way.
constexpr double kSurelyOn = 0.01, kNearerWall = 0.5;
/// Places between vertices may be so many times as far from the given surface as these are.
constexpr double kFartherBetween = 2;

/// How far from an edge the ground is looked at for the way that it goes there, in parts of the triangle.
constexpr double kStepFromEdge = 1e-3;

/// A triangle by the barycentric weights of its corners, and how often it was divided.
struct Division {
  TriangleCorners weights;
  int depth;
};

template <class Visit>
void for_each_quarter(const Division& whole, const Visit& visit) {
  const auto& [a, b, c] = whole.weights;
  const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  for (const TriangleCorners& quarter : {TriangleCorners{a, ab, ca}, TriangleCorners{ab, b, bc},
                                         TriangleCorners{ca, bc, c}, TriangleCorners{ab, bc, ca}})
    visit(Division{quarter, whole.depth + 1});
}

constexpr Division kWholeTriangle{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, 0};

/// Whether the flat triangle is farther than `tolerance` from the places at its middle or at those of its edges;
/// at(weights) tells them.
template <class At>
bool strays_from_flat(const TriangleCorners& weights, const At& at, double tolerance) {
  const auto& [a, b, c] = weights;
  const TriangleCorners on{at(a), at(b), at(c)};
  const auto strays = [&](Vec3 w, Vec3 chord) { return distance(at(w), chord) > tolerance; };
  return strays(0.5 * (a + b), 0.5 * (on[0] + on[1])) || strays(0.5 * (b + c), 0.5 * (on[1] + on[2])) ||
         strays(0.5 * (c + a), 0.5 * (on[2] + on[0])) || strays(centroid(a, b, c), centroid(on[0], on[1], on[2]));
}

}  // namespace

std::vector<std::uint32_t> find_paths(std::size_t vertices, Features& lines,
                                      const std::function<bool(std::uint32_t, std::uint32_t)>& alike) {
  const Groups<> at = rows_at_vertices(vertices, lines.edges);
  std::vector<std::uint8_t> is_corner(vertices, 0);
  for (const VertexIndex v : lines.corners) is_corner[v] = 1;
  DisjointSets sets(lines.edges.size());
  for (VertexIndex v = 0; v < vertices; ++v) {
    if (at[v].empty()) continue;
    if (at[v].size() != 2 || !alike(at[v][0], at[v][1])) is_corner[v] = 1;
    if (!is_corner[v]) sets.join(at[v][0], at[v][1]);
  }
  lines.corners.clear();
  for (VertexIndex v = 0; v < is_corner.size(); ++v)
    if (is_corner[v]) lines.corners.push_back(v);
  std::map<std::uint32_t, std::uint32_t> number;
  std::vector<std::uint32_t> path;
  for (std::uint32_t e = 0; e < lines.edges.size(); ++e)
    path.push_back(number.try_emplace(sets.find(e), static_cast<std::uint32_t>(number.size())).first->second);
  return path;
}

Ground::Ground(Walls walls, const GivenSurface* given)
    : walls_(std::move(walls)),
      tree_(walls_.surface),
      smooth_(walls_.surface, walls_.edges, tree_, walls_.lines),
      given_(given) {
  std::vector<curved::Foot> on_surface(walls_.surface.triangles.size()), on_lines(walls_.lines.edges.size());
  for (std::uint32_t t = 0; t < on_surface.size(); ++t) on_surface[t].on = t;
  for (std::uint32_t e = 0; e < on_lines.size(); ++e) on_lines[e].on = e;
  smooth_.prepare(on_surface, on_lines);
  for (std::uint32_t e = 0; e < on_lines.size(); ++e) line_at_.find_or_add(walls_.lines.edges[e]) = e;
  has_line_.assign(on_surface.size(), 0);
  for (std::size_t e = 0; e < walls_.edges.size(); ++e)
    if (line_at_.find(walls_.edges.edges[e]))
      for (const HalfEdge h : walls_.edges.uses(e)) has_line_[h / 3] = 1;
  if (given_) find_covered();
}

double Ground::reach_of(double longest_edge) const {
  return std::max(given_->reach(), kReachOfEdge * longest_edge);
}

void Ground::find_covered() {
  const auto longest = [&](std::uint32_t t) {
    const auto& [a, b, c] = tree_.corners(t);
    return std::sqrt(longest_squared_edge(a, b, c));
  };
  covered_.assign(walls_.surface.triangles.size(), 0);
  std::vector<double> farthest(covered_.size(), 0);
  parallel_for(covered_.size(), [&](std::size_t k) {
    const auto t = static_cast<std::uint32_t>(k);
    const auto& [a, b, c] = tree_.corners(t);
    const double reach = reach_of(longest(t));
    for (const Vec3 p : {a, b, c, centroid(a, b, c)}) {
      const auto on = given_->on_surface(p, double_area_normal(a, b, c), walls_.outer[t] != 0, reach);
      if (!on) return;
      const double way = distance(p, on->at);
      // Another wall may be meant: an inner one beside the boundary must not be drawn to it.
      if (way > kSurelyOn * reach && tree_.is_within(on->at, kNearerWall * way)) return;
      farthest[t] = std::max(farthest[t], way);
    }
    covered_[t] = 1;
  });
  for (std::size_t t = 0; t < covered_.size(); ++t)
    if (covered_[t]) farthest_ = std::max(farthest_, kFartherBetween * farthest[t]);
  line_covered_.assign(walls_.lines.edges.size(), 0);
  parallel_for(line_covered_.size(), [&](std::size_t e) {
    const Vec3 p = walls_.surface.points[walls_.lines.edges[e][0]], q = walls_.surface.points[walls_.lines.edges[e][1]];
    const double reach = reach_of(distance(p, q));
    for (const Vec3 at : {p, q, 0.5 * (p + q)}) {
      const auto on = given_->on_line(at, q - p, reach);
      if (!on) return;
      const double way = distance(at, *on);
      if (way > kSurelyOn * reach && smooth_.curve_foot(*on, kNearerWall * way)) return;
    }
    line_covered_[e] = 1;
  });
  find_corners();
}

void Ground::find_corners() {
  const std::vector<Vec3>& points = walls_.surface.points;
  const std::vector<VertexIndex>& corners = walls_.lines.corners;
  const TriangleTree own = tree_of_points(points, corners);
  for (std::uint32_t k = 0; k < corners.size(); ++k) {
    const auto home = given_->corner(points[corners[k]], given_->reach());
    // One goes there alone: the nearest.
    if (home && own.nearest(*home).triangle == k) corner_home_.emplace_back(corners[k], *home);
  }
}

std::optional<Vec3> Ground::corner(VertexIndex v) const {
  const auto at = std::lower_bound(corner_home_.begin(), corner_home_.end(), v,
                                   [](const auto& entry, VertexIndex key) { return entry.first < key; });
  if (at == corner_home_.end() || at->first != v) return std::nullopt;
  return at->second;
}

std::optional<curved::Foot> Ground::foot(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach,
                                         std::uint32_t& near) const {
  const double least = kLeastCosineOfFoot * length(normal);
  const auto fits = [&](std::uint32_t t, const TriangleCorners& c) {
    if (walls_.surface.patch[t] != part) return false;
    const Vec3 n = double_area_normal(c[0], c[1], c[2]);
    const double cosine = dot(n, normal);
    return (outer ? cosine : std::abs(cosine)) >= least * length(n);
  };
  const TriangleTree::Nearest nearest = nearest_that(tree_, p, reach + farthest_, fits, near);
  if (nearest.triangle == kNone) return std::nullopt;
  near = nearest.triangle;
  return curved::Foot{nearest.point, nearest.triangle};
}

std::optional<Ground::Home> Ground::home(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach,
                                         std::uint32_t& near) const {
  const auto at = foot(p, part, outer, normal, reach, near);
  if (!at) return std::nullopt;
  const auto& [a, b, c] = tree_.corners(at->on);
  if (!is_covered(at->on)) return Home{smooth_over(*at), double_area_normal(a, b, c)};
  const auto on = given_->on_surface(p, normal, outer, reach_of(std::sqrt(longest_squared_edge(a, b, c))));
  if (!on) return std::nullopt;
  return Home{on->at, on->normal};
}

std::optional<Vec3> Ground::on_surface(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach,
                                       std::uint32_t& near) const {
  const auto at = home(p, part, outer, normal, reach, near);
  if (!at) return std::nullopt;
  return at->at;
}

std::optional<Vec3> Ground::on_line(Vec3 p, std::uint32_t path, double reach) const {
  const auto at = smooth_.curve_foot(p, reach + farthest_);
  if (!at || walls_.path[at->on] != path) return std::nullopt;
  if (!given_) return smooth_.curve_point(*at);
  const auto& [u, v] = walls_.lines.edges[at->on];
  const Vec3 along = walls_.surface.points[v] - walls_.surface.points[u];
  if (line_covered_[at->on]) return given_->on_line(p, along, reach_of(length(along)));
  return beside_line(smooth_.curve_point(*at), at->on);
}

Vec3 Ground::beside_line(Vec3 p, std::uint32_t edge) const {
  const Edge& ends = walls_.lines.edges[edge];
  const auto& all = walls_.edges.edges;
  const auto e = static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), ends) - all.begin());
  std::optional<Vec3> best;
  for (const std::uint32_t h : walls_.edges.uses(e)) {
    const std::uint32_t t = h / 3;
    if (!is_covered(t)) continue;
    const auto& [a, b, c] = tree_.corners(t);
    const auto on = given_->on_surface(p, double_area_normal(a, b, c), walls_.outer[t] != 0,
                                       reach_of(std::sqrt(longest_squared_edge(a, b, c))));
    if (on && (!best || squared_distance(on->at, p) < squared_distance(*best, p))) best = on->at;
  }
  return best.value_or(p);
}

std::uint32_t Ground::wall_at(Vec3 on_given) const {
  const TriangleTree::Nearest nearest = tree_.nearest(on_given);
  if (nearest.triangle == kNone) return kNone;
  const auto& [a, b, c] = tree_.corners(nearest.triangle);
  const double reach = reach_of(std::sqrt(longest_squared_edge(a, b, c)));
  return nearest.squared_distance <= reach * reach ? nearest.triangle : kNone;
}

Vec3 Ground::smooth_over(const curved::Foot& foot) const {
  if (!has_line_[foot.on]) return smooth_.surface_point(foot);
  const auto& [a, b, c] = tree_.corners(foot.on);
  const Vec3 n = double_area_normal(a, b, c);
  const double area = squared_length(n);
  if (area == 0) return smooth_.surface_point(foot);
  const double in_b = dot(double_area_normal(a, foot.at, c), n) / area;
  const double in_c = dot(double_area_normal(a, b, foot.at), n) / area;
  return smooth_at(foot.on, {1 - in_b - in_c, in_b, in_c});
}

Vec3 Ground::smooth_at(std::uint32_t triangle, Vec3 weights) const {
  const auto& corners = tree_.corners(triangle);
  const auto flat = [&](Vec3 w) { return w.x * corners[0] + w.y * corners[1] + w.z * corners[2]; };
  Vec3 at = smooth_.surface_point({flat(weights), triangle});
  // Where a side lies on a line the surface goes along with it: patches end at smooth lines, not at their chords.
  const Triangle& t = walls_.surface.triangles[triangle];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double share = weights[j] + weights[k];
    const std::uint32_t* line =
        line_at_.find(sorted_edge(t[static_cast<std::size_t>(j)], t[static_cast<std::size_t>(k)]));
    if (!line || share <= 0) continue;
    Vec3 beside{};
    beside[j] = weights[j] / share, beside[k] = weights[k] / share;
    const Vec3 foot = flat(beside);
    at += share * share * (smooth_.curve_point({foot, *line}) - smooth_.surface_point({foot, triangle}));
  }
  return at;
}

std::vector<TriangleCorners> Ground::divided(std::uint32_t triangle, double tolerance) const {
  const auto at = [&](Vec3 weights) { return smooth_at(triangle, weights); };
  std::vector<Division> stack{kWholeTriangle};
  std::vector<TriangleCorners> made;
  while (!stack.empty()) {
    const Division part = stack.back();
    stack.pop_back();
    if (part.depth < kMostDivisionsOfGround && strays_from_flat(part.weights, at, tolerance))
      for_each_quarter(part, [&](const Division& quarter) { stack.push_back(quarter); });
    else
      made.push_back({at(part.weights[0]), at(part.weights[1]), at(part.weights[2])});
  }
  return made;
}

Ground::GivenPieces Ground::divided_given(std::uint32_t triangle, double tolerance,
                                          const std::function<bool(Vec3)>& stands) const {
  const TriangleCorners& corners = given_->corners(triangle);
  const auto at = [&](Vec3 w) {
    return given_->over(triangle, w.x * corners[0] + w.y * corners[1] + w.z * corners[2]);
  };
  std::vector<Division> stack{kWholeTriangle};
  GivenPieces made;
  while (!stack.empty()) {
    const Division part = stack.back();
    stack.pop_back();
    const auto& [a, b, c] = part.weights;
    const int standing = stands(at(a)) + stands(at(b)) + stands(at(c)) + stands(at(centroid(a, b, c)));
    const bool is_mixed = standing != 0 && standing != 4;
    if (part.depth < kMostDivisionsOfGround && (is_mixed || strays_from_flat(part.weights, at, tolerance)))
      for_each_quarter(part, [&](const Division& quarter) { stack.push_back(quarter); });
    else
      (standing == 4 ? made.standing : made.others).push_back({at(a), at(b), at(c)});
  }
  return made;
}

Vec3 Ground::way_from(HalfEdge h) const {
  const std::uint32_t t = h / 3;
  const int i = static_cast<int>(h % 3), j = (i + 1) % 3, k = (i + 2) % 3;
  Vec3 middle{}, inside{};
  middle[i] = middle[j] = 0.5;
  inside[k] = kStepFromEdge, inside[i] = inside[j] = 0.5 * (1 - kStepFromEdge);
  const auto& corners = tree_.corners(t);
  const Vec3 along = normalized(corners[static_cast<std::size_t>(j)] - corners[static_cast<std::size_t>(i)]);
  const Vec3 way = smooth_at(t, inside) - smooth_at(t, middle);
  return normalized(way - dot(way, along) * along);
}

double Ground::cut_off(std::size_t edge, double length) const {
  const auto uses = walls_.edges.uses(edge);
  for (const HalfEdge h : uses) {
    const auto& [a, b, c] = tree_.corners(h / 3);
    length = std::min(length, octafront::length(double_area_normal(a, b, c)) /
                                  distance(walls_.surface.points[walls_.edges.edges[edge][0]],
                                           walls_.surface.points[walls_.edges.edges[edge][1]]));
  }
  // Both halves of the edge go these ways; it cuts off half of the difference.
  return 0.25 * length * octafront::length(way_from(uses[0]) + way_from(uses[1]));
}

std::vector<Edge> Ground::kinks(const std::function<double(Vec3, Vec3)>& wanted,
                                std::span<const double> tolerance) const {
  const auto& all = walls_.edges.edges;
  std::vector<std::uint8_t> is_kink(all.size(), 0);
  parallel_for(all.size(), [&](std::size_t e) {
    const auto uses = walls_.edges.uses(e);
    if (uses.size() != 2 || line_at_.find(all[e])) return;
    const std::uint32_t t = uses[0] / 3, u = uses[1] / 3;
    if (walls_.surface.patch[t] != walls_.surface.patch[u] || is_covered(t) || is_covered(u)) return;
    const Vec3 a = walls_.surface.points[all[e][0]], b = walls_.surface.points[all[e][1]];
    is_kink[e] = cut_off(e, wanted(0.5 * (a + b), way_from(uses[0]))) > tolerance[walls_.surface.patch[t]];
  });
  std::vector<Edge> found;
  for (std::size_t e = 0; e < all.size(); ++e)
    if (is_kink[e]) found.push_back(all[e]);
  return found;
}

Ground::Truth Ground::truth_at(Vec3 place, Vec3 normal, std::uint32_t part, bool outer, double reach,
                               std::uint32_t& near) const {
  const auto at = home(place, part, outer, normal, reach, near);
  if (!at) return {HUGE_VAL, -1};
  const double cosine = dot(at->normal, normal) / (length(at->normal) * length(normal) + 1e-300);
  return {distance(place, at->at), outer ? cosine : std::abs(cosine)};
}

Ground::Truth Ground::truth_of(const TriangleCorners& t, std::uint32_t part, bool outer, double reach,
                               std::uint32_t near) const {
  const Vec3 normal = double_area_normal(t[0], t[1], t[2]);
  Truth truth = truth_at(centroid(t[0], t[1], t[2]), normal, part, outer, reach, near);
  for (std::size_t k = 0; k < 3 && std::isfinite(truth.distance); ++k) {
    const Truth beside = truth_at(0.5 * (t[k] + t[(k + 1) % 3]), normal, part, outer, reach, near);
    if (!std::isfinite(beside.distance)) return beside;
    truth.distance = std::max(truth.distance, beside.distance);
  }
  return truth;
}

}  // namespace octafront::adapt
