#include "improve/curved/smooth_surface.h"

#include "base/core/disjoint_sets.h"
#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/nearest_that.h"

#include <algorithm>
#include <cmath>

namespace octafront::curved {

namespace {

// Triangles that are turned farther from the normal than this are not seen from above well enough to be fitted.
constexpr double kSteepest = 0.5;  // cosine
// A foot must not be on the other side of a thin wall, or around a sharp edge.
constexpr double kSameSide = 0.5;  // cosine
// Three rings of a triangulation have 36 vertices, enough for a polynomial of degree four; where those do not look
// smooth, two of them have 18 and may.
constexpr int kRings = 3;
// A vertex in which a hundred triangles meet would cost too much.
constexpr std::size_t kMostTriangles = 200;
// Vertices of a curve to either side.
constexpr int kAlong = 3, kAlongOneSided = 5;
// A smooth surface that turns by an angle over a triangle's height leaves it by a sixth of their product, and twice
// that where triangles are irregular. What leaves a triangle farther than this is not what its neighbours say, and flat
// triangles among flat ones stay flat.
constexpr double kMostSag = 0.6;
constexpr double kRounding = 1e-9;  // in parts of the longest edge
// Beside a flat face that is so many times as wide as the facets of the fillet that it ends in, the facets say how far.
constexpr double kMostUneven = 2.5;
// A curve that turns by an angle between two segments leaves them by an eighth of angle times length.
constexpr double kMostCurveSag = 0.4;
// Farther from a triangle than this, in its longest edges, a polynomial is not a surface between points any more.
constexpr double kFarthest = 0.25;

/// Per vertex that lies inside a curve: the two feature edges there.
std::vector<std::array<std::uint32_t, 2>> edges_inside_curves(std::size_t vertices, const Features& sharp) {
  std::vector<std::array<std::uint32_t, 2>> at(vertices, {kNone, kNone});
  for (std::uint32_t e = 0; e < sharp.edges.size(); ++e)
    for (const VertexIndex v : sharp.edges[e]) at[v][at[v][0] != kNone] = e;
  for (const VertexIndex v : sharp.corners) at[v] = {kNone, kNone};
  return at;
}

std::array<double, 3> barycentric(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = cross(b - a, c - a);
  const double area = squared_length(n);
  if (area == 0) return {1, 0, 0};
  const double in_b = dot(cross(p - a, c - a), n) / area, in_c = dot(cross(b - a, p - a), n) / area;
  return {1 - in_b - in_c, in_b, in_c};
}

/// A list of a few numbers, each once, in the order in which they came.
class FewNumbers {
 public:
  FewNumbers() { slots_.fill(kNone); }
  const std::vector<std::uint32_t>& list() const { return list_; }
  std::size_t size() const { return list_.size(); }

  /// False if it is there already, or there is no room.
  bool add(std::uint32_t number) {
    if (list_.size() >= kMost) return false;
    std::size_t at = (number * 2654435761u) >> (32 - kBits);
    for (; slots_[at] != kNone; at = (at + 1) % slots_.size())
      if (slots_[at] == number) return false;
    slots_[at] = number;
    list_.push_back(number);
    return true;
  }

 private:
  static constexpr int kBits = 9;
  static constexpr std::size_t kMost = 300;  // three fifths of the slots
  std::array<std::uint32_t, 1u << kBits> slots_;
  std::vector<std::uint32_t> list_;
};

/// `smooth` where it is near enough to p.
Vec3 within(Vec3 smooth, Vec3 p, double edge) {
  return squared_distance(smooth, p) <= kFarthest * kFarthest * edge * edge ? smooth : p;
}

}  // namespace

SmoothSurface::SmoothSurface(const SurfaceMesh& surface, const EdgeTable& edges, const TriangleTree& tree,
                             Features sharp)
    : surface_(surface),
      tree_(tree),
      sharp_(std::move(sharp)),
      curves_(tree_of_segments(surface.points, sharp_.edges)),
      curve_at_(edges_inside_curves(surface.points.size(), sharp_)),
      curve_fit_of_(2 * sharp_.edges.size(), kNone) {
  find_wedges(edges);
}

void SmoothSurface::find_wedges(const EdgeTable& edges) {
  DisjointSets sets(3 * surface_.triangles.size());
  neighbour_.assign(3 * surface_.triangles.size(), kNone);
  auto sharp = sharp_.edges.begin();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    while (sharp != sharp_.edges.end() && *sharp < edges.edges[e]) ++sharp;
    if (sharp != sharp_.edges.end() && *sharp == edges.edges[e]) continue;
    const auto uses = edges.uses(e);
    if (uses.size() != 2) continue;
    // The half-edges run in opposite directions.
    neighbour_[uses[0]] = uses[1] / 3;
    neighbour_[uses[1]] = uses[0] / 3;
    sets.join(uses[0], next_of(uses[1]));
    sets.join(next_of(uses[0]), uses[1]);
  }
  const auto corners = static_cast<std::uint32_t>(3 * surface_.triangles.size());
  wedge_of_.resize(corners);
  for (std::uint32_t c = 0; c < corners; ++c) wedge_of_[c] = sets.find(c);
  corners_of_ = group_by_owner(corners, corners, [this](std::uint32_t c) { return wedge_of_[c]; });
  fit_of_wedge_.assign(corners, kNone);
}

std::optional<Foot> SmoothSurface::surface_foot(Vec3 p, Vec3 normal, double reach) const {
  const auto nearest = nearest_that(tree_, p, reach, [&](std::uint32_t, const TriangleCorners& c) {
    const Vec3 n = double_area_normal(c[0], c[1], c[2]);
    return dot(n, normal) >= kSameSide * length(n);
  });
  if (nearest.triangle == kNone) return std::nullopt;
  return Foot{nearest.point, nearest.triangle};
}

std::optional<Foot> SmoothSurface::curve_foot(Vec3 p, double reach) const {
  const auto nearest = curves_.nearest(p, reach * reach);
  if (nearest.triangle == kNone) return std::nullopt;
  return Foot{nearest.point, nearest.triangle};
}

bool SmoothSurface::is_corner(const Foot& on_curve, double tolerance) const {
  for (const VertexIndex v : sharp_.edges[on_curve.on])
    if (curve_at_[v][0] == kNone && distance(surface_.points[v], on_curve.at) <= tolerance) return true;
  return false;
}

std::uint32_t SmoothSurface::fit_of_end(std::uint32_t end) const {
  const VertexIndex v = end_vertex(end);
  if (curve_at_[v][0] == kNone) return end;
  const std::uint32_t first = curve_at_[v][0];
  return 2 * first + (sharp_.edges[first][1] == v);
}

void SmoothSurface::prepare(std::span<const Foot> on_surface, std::span<const Foot> on_curves) {
  std::vector<Wedge> wedges;
  for (const Foot& foot : on_surface)
    for (std::uint32_t c = 3 * foot.on; c < 3 * foot.on + 3; ++c) {
      std::uint32_t& place = fit_of_wedge_[wedge_of_[c]];
      if (place != kNone) continue;
      place = static_cast<std::uint32_t>(fits_.size() + wedges.size());
      wedges.push_back(wedge_of_[c]);
    }
  std::vector<std::uint32_t> ends;
  for (const Foot& foot : on_curves)
    for (std::uint32_t end = 2 * foot.on; end < 2 * foot.on + 2; ++end) {
      std::uint32_t& place = curve_fit_of_[fit_of_end(end)];
      if (place != kNone) continue;
      place = static_cast<std::uint32_t>(curve_fits_.size() + ends.size());
      ends.push_back(fit_of_end(end));
    }
  const std::size_t first = fits_.size(), first_curve = curve_fits_.size();
  fits_.resize(first + wedges.size());
  parallel_for(wedges.size(), [&](std::size_t i) { fits_[first + i] = make_fit(wedges[i]); });
  curve_fits_.resize(first_curve + ends.size());
  parallel_for(ends.size(), [&](std::size_t i) { curve_fits_[first_curve + i] = make_curve_fit(ends[i]); });
}

SurfaceFit SmoothSurface::make_fit(Wedge wedge) const {
  const auto normal_of = [&](std::uint32_t t) {
    const auto& [a, b, c] = surface_.triangles[t];
    return double_area_normal(surface_.points[a], surface_.points[b], surface_.points[c]);
  };
  Vec3 normal;
  for (const std::uint32_t c : corners_of_[wedge]) normal += normal_of(c / 3);
  normal = normalized(normal);
  const auto is_seen = [&](std::uint32_t t) {
    const Vec3 n = normal_of(t);
    return dot(n, normal) >= kSteepest * length(n);
  };

  FewNumbers triangles, reached, vertices;
  reached.add(wedge);
  vertices.add(corner_vertex(wedge));
  std::size_t from = 0, nearer = 1;  // where the newest ring begins in `reached`, in `vertices`
  for (int ring = 0; ring < kRings; ++ring) {
    const std::size_t to = reached.size();
    nearer = vertices.size();
    for (; from < to; ++from)
      for (const std::uint32_t corner : corners_of_[reached.list()[from]]) {
        const std::uint32_t t = corner / 3;
        if (triangles.size() >= kMostTriangles || !triangles.add(t) || !is_seen(t)) continue;
        for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c)
          if (reached.add(wedge_of_[c])) vertices.add(corner_vertex(c));
      }
  }
  std::vector<Vec3> points;
  points.reserve(vertices.size());
  for (const VertexIndex v : vertices.list()) points.push_back(surface_.points[v]);
  const std::span<const Vec3> around = std::span<const Vec3>(points).subspan(1);
  SurfaceFit fit = fit_surface(points.front(), normal, around);
  if (fit.trusted && stays_near(fit, wedge)) return fit;
  fit = fit_surface(points.front(), normal, around.first(nearer - 1));
  fit.trusted = fit.trusted && stays_near(fit, wedge);
  return fit;
}

double SmoothSurface::sag_over(std::uint32_t h) const {
  const auto& [a, b, c] = tree_.corners(h / 3);
  const auto& [d, e, f] = tree_.corners(neighbour_[h]);
  const Vec3 normal = double_area_normal(a, b, c), other = double_area_normal(d, e, f);
  const double turn = elementary::atan2(length(cross(normal, other)), dot(normal, other));
  const double edge =
      distance(surface_.points[start_of(surface_.triangles, h)], surface_.points[end_of(surface_.triangles, h)]);
  return edge > 0 ? turn * std::min(length(normal), kMostUneven * length(other)) / edge : 0;
}

double SmoothSurface::sag(std::uint32_t t) const {
  const auto sag_over_edges = [&](std::uint32_t u) {
    double most = 0;
    for (std::uint32_t h = 3 * u; h < 3 * u + 3; ++h)
      if (neighbour_[h] != kNone) most = std::max(most, sag_over(h));
    return most;
  };
  double most = sag_over_edges(t);
  const auto first = neighbour_.begin() + 3 * t;
  if (std::find(first, first + 3, kNone) == first + 3) return most;
  // The strip of triangles along the end of a rolled sheet is flat: how the sheet turns only those behind it can tell.
  for (auto beside = first; beside != first + 3; ++beside)
    if (*beside != kNone) most = std::max(most, sag_over_edges(*beside));
  return most;
}

bool SmoothSurface::stays_near(const SurfaceFit& fit, Wedge wedge) const {
  for (const std::uint32_t corner : corners_of_[wedge]) {
    const auto& [a, b, c] = tree_.corners(corner / 3);
    const double limit = kMostSag * sag(corner / 3) + kRounding * std::sqrt(longest_squared_edge(a, b, c));
    for (const Vec3 p : {centroid(a, b, c), 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)})
      if (distance(fit.at(p), p) > limit) return false;
  }
  return true;
}

std::vector<Vec3> SmoothSurface::points_along(VertexIndex from, std::uint32_t edge) const {
  const int most = curve_at_[from][0] == kNone ? kAlongOneSided : kAlong;
  std::vector<Vec3> points;
  for (VertexIndex v = from; static_cast<int>(points.size()) < most;) {
    const auto& [a, b] = sharp_.edges[edge];
    v = a == v ? b : a;
    if (v == from) break;
    points.push_back(surface_.points[v]);
    if (curve_at_[v][0] == kNone) break;
    edge = curve_at_[v][curve_at_[v][0] == edge];
  }
  return points;
}

CurveFit SmoothSurface::make_curve_fit(std::uint32_t end) const {
  const VertexIndex v = end_vertex(end);
  const Vec3 p = surface_.points[v];
  const bool inside = curve_at_[v][0] != kNone;
  const std::uint32_t first = inside ? curve_at_[v][0] : end / 2;
  std::vector<Vec3> around = points_along(v, first);
  Vec3 tangent = normalized(around.front() - p);
  if (inside) {
    const std::vector<Vec3> ahead = points_along(v, curve_at_[v][1]);
    tangent = normalized(ahead.front() - around.front());
    around.insert(around.end(), ahead.begin(), ahead.end());
  }
  CurveFit fit = fit_curve(p, tangent, around);
  fit.trusted = fit.trusted && stays_near(fit, first) && (!inside || stays_near(fit, curve_at_[v][1]));
  return fit;
}

double SmoothSurface::sag_at(VertexIndex v, std::uint32_t edge) const {
  const auto& [e, f] = curve_at_[v];
  if (e == kNone || f == kNone) return TriangleTree::kFar;
  const auto along = [&](std::uint32_t i) {
    return surface_.points[sharp_.edges[i][sharp_.edges[i][0] == v]] - surface_.points[v];
  };
  const Vec3 here = along(edge), next = along(e == edge ? f : e);
  const double turn = elementary::atan2(length(cross(here, next)), -dot(here, next));
  return turn * std::min(length(here), kMostUneven * length(next));
}

bool SmoothSurface::stays_near(const CurveFit& fit, std::uint32_t edge) const {
  const auto& [a, b] = sharp_.edges[edge];
  const Vec3 p = surface_.points[a], q = surface_.points[b], middle = 0.5 * (p + q);
  const double sag = std::min(sag_at(a, edge), sag_at(b, edge));
  if (sag == TriangleTree::kFar) return false;  // from corner to corner: nothing is known of its shape
  return distance(fit.at(middle), middle) <= kMostCurveSag * sag + kRounding * distance(p, q);
}

Vec3 SmoothSurface::surface_point(const Foot& foot) const {
  const auto& [a, b, c] = tree_.corners(foot.on);
  const auto weight = barycentric(foot.at, a, b, c);
  Vec3 smooth;
  for (std::uint32_t i = 0; i < 3; ++i)
    smooth += weight[i] * fits_[fit_of_wedge_[wedge_of_[3 * foot.on + i]]].at(foot.at);
  return within(smooth, foot.at, std::sqrt(longest_squared_edge(a, b, c)));
}

Vec3 SmoothSurface::curve_point(const Foot& foot) const {
  const auto& [a, b] = sharp_.edges[foot.on];
  const Vec3 p = surface_.points[a], q = surface_.points[b];
  const double edge = distance(p, q), in_b = edge > 0 ? distance(p, foot.at) / edge : 0;
  const auto& at_a = curve_fits_[curve_fit_of_[fit_of_end(2 * foot.on)]];
  const auto& at_b = curve_fits_[curve_fit_of_[fit_of_end(2 * foot.on + 1)]];
  return within((1 - in_b) * at_a.at(foot.at) + in_b * at_b.at(foot.at), foot.at, edge);
}

}  // namespace octafront::curved
