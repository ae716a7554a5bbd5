#include "surface/lines/curve_points.h"

#include "base/geometry/measures.h"
#include "surface/edits/local_guards.h"

#include <algorithm>

namespace octafront::surface {

namespace {

/// Steps below this part of the size are not worth it, and none goes farther than this part of the way to a neighbour.
constexpr double kLeastCurveStep = 2e-2, kMostStep = 0.35;
/// Segments of the curve stay within these lengths, in wanted sizes.
constexpr double kShortestSegment = 0.7, kLongestSegment = 1.4;
/// Bends of the curve may always be cut by this part of the size.
constexpr double kFreeSagitta = 0.01;
/// The worst triangle may only get worse above this squared quality.
constexpr double kFairQuality = 0.3;
/// For the worst triangle a point may go this far, in parts of the way to its neighbours, within these lengths.
constexpr double kReliefSteps[] = {-0.6, -0.45, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.45, 0.6};
constexpr double kShortestRelief = 0.3, kLongestRelief = 1.6;
/// Triangles that stay worse than this 2r/R are left alone: in wedges of a few degrees nothing helps, and the
/// neighbours would suffer.
constexpr double kWorthIt = 0.42;
/// Edges are divided no nearer to an end than this part of them; a point farther off its place than this went astray.
constexpr double kLeastPartOfEdge = 0.2, kAstrayOfCurve = 0.2;
constexpr TurnLimits kCurveLimits{0.5, 0.2};

double wrapped(const Curve& curve, double along) {
  const double whole = curve.reach.back();
  return along < 0 ? along + whole : along > whole ? along - whole : along;
}

}  // namespace

CurvePoints::CurvePoints(WorkingMesh& mesh, const InputSurface& input, const std::vector<Curve>& curves,
                         const SizeField& sizes)
    : mesh_(mesh), input_(input), curves_(curves), sizes_(sizes) {
  for (std::uint32_t i = 0; i < curves.size(); ++i) {
    if (curves[i].samples.size() != 2) continue;
    const VertexIndex a = input.mesh.start[curves[i].half_edges.front()],
                      b = input.mesh.end(curves[i].half_edges.back());
    undivided_[{std::min(a, b), std::max(a, b)}] = i;
  }
}

bool CurvePoints::gather(VertexIndex v) {
  features_.clear();
  ring_.clear();
  mesh_.for_each_outgoing(v, [&](HalfEdge h) {
    if (mesh_.is_feature[h]) features_.push_back(h);
  });
  if (features_.size() != 2) return false;
  for (const HalfEdge first : features_) {
    const std::size_t begin = ring_.size();
    Vec3 star;
    HalfEdge h = first;
    do {
      ring_.push_back({mesh_.end(h), mesh_.apex(h), {}});
      star += mesh_.area_vector(h / 3);
      h = mesh_.rotated(h);
    } while (!mesh_.is_feature[h]);
    for (std::size_t i = begin; i < ring_.size(); ++i) ring_[i].star = star;
  }
  return true;
}

/// The curve's points on both sides. Corners, and points of other curves, stand at its ends.
bool CurvePoints::find_neighbours(VertexIndex v) {
  const CurvePlace place = mesh_.place[v];
  const Curve& curve = curves_[place.curve];
  const double whole = curve.reach.back();
  const Vec3 p = mesh_.points[v];
  const HalfEdge on = point_along(input_, curve, place.along).half_edge;
  const Vec3 forward = input_.mesh.points[input_.mesh.end(on)] - input_.mesh.points[input_.mesh.start[on]];
  VertexIndex a = mesh_.end(features_[0]), b = mesh_.end(features_[1]);
  if (dot(mesh_.points[a] - p, forward) > dot(mesh_.points[b] - p, forward)) std::swap(a, b);
  const auto place_of = [&](VertexIndex w, double otherwise) {
    const bool known = mesh_.kind[w] == VertexKind::kCurve && mesh_.place[w].curve == place.curve;
    return known ? mesh_.place[w].along : otherwise;
  };
  neighbours_ = {a, b, place_of(a, 0), place_of(b, whole)};
  if (curve.closed && neighbours_.from > place.along) neighbours_.from -= whole;
  if (curve.closed && neighbours_.to < place.along) neighbours_.to += whole;
  return neighbours_.from < place.along && place.along < neighbours_.to;
}

/// How far along the curve the triangles around would have the point: the mean of their centroids, by area over size.
double CurvePoints::step_wanted(VertexIndex v) const {
  const Vec3 p = mesh_.points[v];
  Vec3 sum;
  double weights = 0;
  for (const Corner& c : ring_) {
    const Vec3 a = mesh_.points[c.a] - p, b = mesh_.points[c.b] - p;
    const double size = mesh_.size[v] + mesh_.size[c.a] + mesh_.size[c.b];
    const double weight = length(cross(a, b)) / (size * size);
    sum += (a + b) * (weight / 3);
    weights += weight;
  }
  if (!(weights > 0)) return 0;
  const Vec3 before = mesh_.points[neighbours_.before], after = mesh_.points[neighbours_.after];
  const double most = kMostStep * std::min(distance(p, before), distance(p, after));
  return std::clamp(dot(sum / weights, normalized(after - before)), -most, most);
}

bool CurvePoints::judge(VertexIndex v, Vec3 p, Quality& quality) const {
  quality = {};
  for (const Corner& c : ring_) {
    const Vec3 a = mesh_.points[c.a], b = mesh_.points[c.b], area_vector = cross(a - p, b - p);
    if (!turns_little(area_vector, c.star, kCurveLimits.star)) return false;
    if (!faces_outward(mesh_, area_vector, {v, c.a, c.b}, kCurveLimits.surface)) return false;
    const double q = squared_quality(p, a, b);
    quality.sum += q;
    quality.worst = std::min(quality.worst, q);
  }
  return true;
}

/// How far the curve's own vertices between two places lie from the segment between the points there.
double CurvePoints::sagitta(const Curve& curve, double from, double to, Vec3 a, Vec3 b) const {
  const double whole = curve.reach.back();
  double most = 0;
  for (const double turn : {-whole, 0.0, whole}) {
    if (turn != 0 && !curve.closed) continue;
    auto it = std::upper_bound(curve.reach.begin(), curve.reach.end(), from - turn);
    for (; it != curve.reach.end() && *it + turn < to; ++it) {
      const HalfEdge h = curve.half_edges[static_cast<std::size_t>(it - curve.reach.begin())];
      const Vec3 x = input_.mesh.points[input_.mesh.end(h)];
      most = std::max(most, distance(x, closest_point_on_segment(x, a, b)));
    }
  }
  return most;
}

double CurvePoints::deviation(const Curve& curve, double along, Vec3 p) const {
  return std::max(sagitta(curve, neighbours_.from, along, mesh_.points[neighbours_.before], p),
                  sagitta(curve, along, neighbours_.to, p, mesh_.points[neighbours_.after]));
}

/// Whether both segments at p have lengths within these bounds.
bool CurvePoints::lengths_within(Vec3 p, double least, double most) const {
  const double l = distance(p, mesh_.points[neighbours_.before]), m = distance(p, mesh_.points[neighbours_.after]);
  return std::min(l, m) > least && std::max(l, m) < most;
}

void CurvePoints::move(VertexIndex v, const CurvePoint& x) {
  mesh_.points[v] = x.p;
  mesh_.face[v] = x.half_edge / 3;
  mesh_.place[v].along = x.along;
  mesh_.size[v] = sizes_.at(x.p);
  mesh_.mark_star_changed(v);
}

bool CurvePoints::slide(VertexIndex v) {
  if (mesh_.place[v].curve == kNone || !gather(v) || !find_neighbours(v)) return false;
  const Curve& curve = curves_[mesh_.place[v].curve];
  const double now = mesh_.place[v].along, h = mesh_.size[v], step = step_wanted(v);
  if (std::abs(step) < kLeastCurveStep * h) return false;
  Quality before;
  if (!judge(v, mesh_.points[v], before)) return false;
  const double allowed = std::max(kFreeSagitta * h, deviation(curve, now, mesh_.points[v]));
  for (const double part : {1.0, 0.4}) {
    const double along = now + part * step;
    if (!(along > neighbours_.from && along < neighbours_.to)) continue;
    const CurvePoint x = point_along(input_, curve, wrapped(curve, along));
    Quality after;
    if (!lengths_within(x.p, kShortestSegment * h, kLongestSegment * h) || !judge(v, x.p, after)) continue;
    if (!(after.sum > before.sum && after.worst >= std::min(before.worst, kFairQuality))) continue;
    if (deviation(curve, along, x.p) > allowed) continue;
    move(v, x);
    return true;
  }
  return false;
}

/// Least 2r/R of the triangles of the star with v at p; 0 if one turns too far, or is no better than `enough`.
double CurvePoints::worst_shape(VertexIndex v, Vec3 p, double enough) const {
  double worst = 1;
  for (const Corner& c : ring_) {
    worst = std::min(worst, triangle_radius_ratio(p, mesh_.points[c.a], mesh_.points[c.b]));
    if (!(worst > enough)) return 0;
  }
  Quality quality;
  return judge(v, p, quality) ? worst : 0;
}

bool CurvePoints::relieve(VertexIndex v, double gain) {
  if (mesh_.place[v].curve == kNone || !gather(v) || !find_neighbours(v)) return false;
  const Curve& curve = curves_[mesh_.place[v].curve];
  const double now = mesh_.place[v].along, h = mesh_.size[v];
  double best = std::max(kWorthIt, gain * worst_shape(v, mesh_.points[v], kWorthIt / gain));
  std::optional<CurvePoint> chosen;
  for (const double part : kReliefSteps) {
    const double along = now + part * (part > 0 ? neighbours_.to - now : now - neighbours_.from);
    const CurvePoint x = point_along(input_, curve, wrapped(curve, along));
    if (!lengths_within(x.p, kShortestRelief * h, kLongestRelief * h)) continue;
    const double worst = worst_shape(v, x.p, best);
    if (!(worst > best)) continue;
    best = worst;
    chosen = x;
  }
  if (chosen) move(v, *chosen);
  return chosen.has_value();
}

/// Whether an edge from a point inside the curve to a corner goes to the curve's start. Where both ends of the curve
/// are one corner, the lengths tell.
bool CurvePoints::ends_at_start(const Curve& curve, double along, VertexIndex inside, VertexIndex corner) const {
  const double whole = curve.reach.back();
  const Vec3 p = mesh_.points[corner];
  const double from_start = distance(p, point_along(input_, curve, 0).p);
  const double from_end = distance(p, point_along(input_, curve, whole).p);
  if (from_start != from_end) return from_start < from_end;
  const double l = distance(mesh_.points[inside], p);
  return std::abs(along - l) < std::abs(whole - along - l);
}

/// The place of the point that divides a feature edge in the proportion `part`, if its curve is known.
std::optional<CurvePlace> CurvePoints::place_between(HalfEdge h, double part) const {
  VertexIndex u = mesh_.start[h], w = mesh_.end(h);
  const auto is_inside = [&](VertexIndex v) {
    return mesh_.kind[v] == VertexKind::kCurve && mesh_.place[v].curve != kNone;
  };
  if (!is_inside(u)) std::swap(u, w), part = 1 - part;
  if (!is_inside(u)) {
    const auto it = undivided_.find({std::min(u, w), std::max(u, w)});
    if (it == undivided_.end()) return std::nullopt;
    const Curve& curve = curves_[it->second];
    if (input_.mesh.start[curve.half_edges.front()] != u) part = 1 - part;
    return CurvePlace{it->second, part * curve.reach.back()};
  }
  const CurvePlace from = mesh_.place[u];
  const Curve& curve = curves_[from.curve];
  const double whole = curve.reach.back();
  double to = mesh_.place[w].along;
  if (!is_inside(w)) {
    to = ends_at_start(curve, from.along, u, w) ? 0 : whole;
  } else if (mesh_.place[w].curve != from.curve) {
    return std::nullopt;
  } else if (curve.closed && std::abs(to - from.along) > 0.5 * whole) {
    to += to < from.along ? whole : -whole;
  }
  return CurvePlace{from.curve, wrapped(curve, from.along + part * (to - from.along))};
}

/// Least 2r/R of the two triangles at a feature edge.
double CurvePoints::shape_beside(HalfEdge h) const {
  double least = 1;
  for (const HalfEdge side : {h, mesh_.twin[h]})
    least = std::min(least, triangle_radius_ratio(mesh_.points[mesh_.start[side]], mesh_.points[mesh_.end(side)],
                                                  mesh_.points[mesh_.apex(side)]));
  return least;
}

/// The same of the four that a point on it makes; 0 if one turns too far.
double CurvePoints::shape_after_split(HalfEdge h, Vec3 x) const {
  double least = 1;
  for (const HalfEdge side : {h, mesh_.twin[h]}) {
    const Vec3 a = mesh_.points[mesh_.start[side]], b = mesh_.points[mesh_.end(side)],
               c = mesh_.points[mesh_.apex(side)];
    const Vec3 star = mesh_.area_vector(side / 3);
    if (!turns_little(cross(x - a, c - a), star, kCurveLimits.star)) return 0;
    if (!turns_little(cross(b - x, c - x), star, kCurveLimits.star)) return 0;
    least = std::min({least, triangle_radius_ratio(a, x, c), triangle_radius_ratio(x, b, c)});
  }
  return least;
}

/// The point of the curve that divides a feature edge in the proportion `part`, if its curve is known and passes there.
std::optional<CurvePoints::Division> CurvePoints::division(HalfEdge h, double part) const {
  const Vec3 a = mesh_.points[mesh_.start[h]], b = mesh_.points[mesh_.end(h)];
  const std::optional<CurvePlace> place = place_between(h, part);
  if (!place) return std::nullopt;
  const CurvePoint x = point_along(input_, curves_[place->curve], place->along);
  if (distance(x.p, a + (b - a) * part) > kAstrayOfCurve * distance(a, b)) return std::nullopt;
  return Division{*place, x};
}

void CurvePoints::split_at(HalfEdge h, const Division& at) {
  const Vec3 p = at.point.p;
  const VertexIndex v = mesh_.add_vertex(p, VertexKind::kCurve, {}, sizes_.at(p), at.point.half_edge / 3);
  mesh_.place[v] = at.place;
  mesh_.split_edge(h, v);
}

bool CurvePoints::split(HalfEdge h, double gain) {
  if (mesh_.is_seam(h)) return false;
  const Vec3 a = mesh_.points[mesh_.start[h]], b = mesh_.points[mesh_.end(h)], c = mesh_.points[mesh_.apex(h)];
  const double part = dot(c - a, b - a) / squared_length(b - a);
  const double shorter = std::min(part, 1 - part);
  if (!(shorter > kLeastPartOfEdge && shorter * distance(a, b) > kShortestRelief * mesh_.size[mesh_.start[h]]))
    return false;
  const std::optional<Division> at = division(h, part);
  if (!at || !(shape_after_split(h, at->point.p) > std::max(kWorthIt, gain * shape_beside(h)))) return false;
  split_at(h, *at);
  return true;
}

bool CurvePoints::halve(HalfEdge h) {
  if (mesh_.is_seam(h)) return false;
  const std::optional<Division> at = division(h, 0.5);
  if (!at || !(shape_after_split(h, at->point.p) > 0)) return false;
  split_at(h, *at);
  return true;
}

}  // namespace octafront::surface
