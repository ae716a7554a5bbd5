#include "fill/front/attempt.h"

#include <octafront/quality.h>

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/segment_distance.h"
#include "fill/front/meeting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace octafront {

namespace {

constexpr Neighborhood::Index kNewVertex = kNone;
/// A candidate lies at least this share of the ideal point's distance away from the face's centroid (the paper's
/// tenth).
constexpr double kNearestCandidate = 0.1;
/// Candidates that are tried for a face. More than this lie in reach only of faces much larger than their surroundings,
/// where trying all would cost the square of the neighbourhood.
constexpr std::size_t kMostCandidates = 40;
/// Where sizes vary, the size for a face is the one this far ahead of it, in units of the size at its corners: the
/// elements to come are wanted, not those that are there.
constexpr double kLookAhead = 0.75;
/// The size used for a face stays within these multiples of its own edges: a kept surface may have triangles
/// that are much larger or smaller than what is wanted around them, and an apex at the wanted distance would make a
/// sliver.
constexpr double kLeastSizePerEdge = 0.45, kMostSizePerEdge = 2.0;

/// Candidates are culled in single precision and may lie a rounding error outside of the sphere; this much of the size
/// is far more than that.
constexpr double kTerritoryMargin = 1e-3;

bool strictly_inside(const Box3& box, const Box3& territory, double margin) {
  for (int axis = 0; axis < 3; ++axis)
    if (box.lo[axis] - margin <= territory.lo[axis] || box.hi[axis] + margin >= territory.hi[axis]) return false;
  return true;
}

/// The segments (p, p + u) and (q, q + v) come nearer to each other than the root of `squared`.
bool segments_nearer_than(double squared, Vec3 p, Vec3 u, Vec3 q, Vec3 v) {
  // The distance of the lines is a bound that needs no division and settles most.
  const Vec3 n = cross(u, v);
  const double volume = dot(p - q, n);
  if (volume * volume > squared * squared_length(n)) return false;
  return squared_segment_distance(p, u, q, v) < squared;
}

/// Rises with the solid angle at p of a triangle: tan(angle / 2) = volume / sum, mapped to [0, 2] without trigonometry.
/// (A. Van Oosterom and J. Strackee, "The Solid Angle of a Plane Triangle", 1983.)
double solid_angle_rank(const std::array<Vec3, 3>& triangle, Vec3 p) {
  const Vec3 a = triangle[0] - p, b = triangle[1] - p, c = triangle[2] - p;
  const double la = length(a), lb = length(b), lc = length(c);
  const double volume = std::abs(dot(a, cross(b, c)));
  const double sum = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return sum >= 0 ? volume / (volume + sum) : 1 - sum / (volume - sum);
}

/// Whether a front face on a side of the tetrahedron over the base (0, 1, 2) has it on its unfilled side: then its
/// corners turn like (j, i, apex).
bool sees_tet(const std::array<Neighborhood::Index, 3>& corners, Neighborhood::Index apex) {
  int k = 0;
  while (corners[k] != apex) ++k;
  return (corners[(k + 1) % 3] + 1) % 3 != corners[(k + 2) % 3];
}

}  // namespace

Attempt::Attempt(Front& front, const FrontTask& task, const Box3& territory, FrontCounters& counters)
    : front_(front),
      sizes_(task.sizes),
      options_(task.options),
      territory_(territory),
      counters_(counters),
      sizes_vary_(sizes_.min_size() < sizes_.max_size()) {}

/// Every tetrahedron that may be made lies in the hull of the base face and the sphere of candidates.
SearchRegion Attempt::region_to_search(double radius) const {
  SearchRegion region;
  const Vec3 centroid = (at_[0] + at_[1] + at_[2]) / 3;
  region.box = {ideal_at_ - Vec3{radius, radius, radius}, ideal_at_ + Vec3{radius, radius, radius}};
  double base_radius = 0;
  for (const Vec3 p : at_) {
    region.box.add(p);
    base_radius = std::max(base_radius, distance(centroid, p));
  }
  // A sphere about a point of the axis: the height at which the base and the candidates' sphere need the same radius.
  const double height = distance(centroid, ideal_at_), top = height + radius;
  const double up = std::clamp((top * top - base_radius * base_radius) / (2 * top), 0.0, height);
  region.center = centroid + normal_ * up;
  region.radius = std::max(elementary::hypot(base_radius, up), top - up);
  region.normal = normal_;
  region.offset = dot(normal_, centroid);
  return region;
}

bool Attempt::place(FaceIndex face, const Limits& limits) {
  base_ = front_.corners(face);
  double size = 0, longest = 0;
  for (int i = 0; i < 3; ++i) {
    at_[i] = front_.at(base_[i]);
    size += front_.vertex(base_[i]).size / 3.0;
  }
  for (int i = 0; i < 3; ++i) longest = std::max(longest, distance(at_[i], at_[(i + 1) % 3]));
  const Vec3 centroid = (at_[0] + at_[1] + at_[2]) / 3;
  const Vec3 twice_area = cross(at_[1] - at_[0], at_[2] - at_[0]);
  normal_ = normalized(twice_area);
  // The edge of the equilateral triangle of the same area: a needle's length says nothing about what fits on it.
  const double edge = std::sqrt(length(twice_area) * 2 / std::numbers::sqrt3);
  if (sizes_vary_) size = sizes_.at(centroid + normal_ * (kLookAhead * size));
  size = std::clamp(size, kLeastSizePerEdge * edge, kMostSizePerEdge * longest);
  ideal_distance_ = options_.ideal_distance * limits.ideal_factor;
  ideal_at_ = centroid + normal_ * (ideal_distance_ * size);
  const double r = limits.search_radius * size;
  SearchRegion region = region_to_search(r);
  region.of = front_.face(face).region;
  if (!strictly_inside(region.box, territory_, kTerritoryMargin * size)) return false;
  counters_.faces_found += near_.gather(front_, face, region, size);
  ideal_ = normal_ * ideal_distance_;
  return true;
}

void Attempt::collect_candidates(const Limits& limits) {
  candidates_.clear();
  const double r2 = limits.search_radius * limits.search_radius;
  const double least = kNearestCandidate * ideal_distance_;
  const std::array<Vec3, 3>& base = near_.base();
  for (Index i = 3; i < near_.size(); ++i) {
    const Vec3 p = near_.local(i);
    if (squared_length(p - ideal_) > r2 || dot(p, normal_) <= 0 || squared_length(p) < least * least) continue;
    const double quality = radius_ratio(base[0], base[1], base[2], p);
    if (quality < limits.least_quality) continue;
    candidates_.push_back({i, quality, quality});
  }
  if (options_.ranking == VolumeOptions::Ranking::kSolidAngle)
    for (Candidate& c : candidates_) c.rank = solid_angle_rank(base, near_.local(c.index));
  const auto better = [&](const Candidate& a, const Candidate& b) {
    return a.rank != b.rank ? a.rank > b.rank : near_.vertex(a.index) < near_.vertex(b.index);
  };
  const std::size_t tried = std::min(candidates_.size(), kMostCandidates);
  std::partial_sort(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(tried), candidates_.end(),
                    better);
  candidates_.resize(tried);
}

Attempt::Contact Attempt::contact_of(Index apex) const {
  Contact contact;
  for (const auto& f : near_.faces()) {
    const auto& c = f.corner;
    if (c[0] != apex && c[1] != apex && c[2] != apex) continue;
    unsigned touched = 0;
    for (int j = 0; j < 3; ++j)
      if (c[j] < 3) touched |= 1u << c[j];
    for (int i = 0; i < 3; ++i) contact.edge[i] = contact.edge[i] || (touched >> i & 1);
    // Side i has the two corners other than i.
    for (int i = 0; i < 3; ++i)
      if (touched == (7u & ~(1u << i)) && sees_tet(c, apex)) contact.face[i] = f.face, ++contact.closed;
  }
  return contact;
}

bool Attempt::edges_short_enough(Vec3 apex, const Contact& contact, double longest) const {
  for (int i = 0; i < 3; ++i)
    if (!contact.edge[i] && squared_length(apex - near_.base()[i]) > longest * longest) return false;
  return true;
}

/// The tetrahedron meets every face of the neighbourhood in nothing but shared corners, edges and faces.
bool Attempt::is_valid(Index apex, Vec3 apex_at, VertexIndex apex_id) {
  const auto& faces = near_.faces();
  // What blocked the last candidate is asked first: it often blocks the next one too.
  if (blocker_ < faces.size() && blocks(faces[blocker_], apex, apex_at, apex_id)) return false;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!blocks(faces[i], apex, apex_at, apex_id)) continue;
    blocker_ = i;
    return false;
  }
  return true;
}

/// A wall has two faces on the same corners, with their unfilled sides apart.
bool Attempt::is_back_of_wall(const std::array<Index, 3>& corners, Index apex) const {
  const auto has = [&](Index i) { return corners[0] == i || corners[1] == i || corners[2] == i; };
  return std::any_of(near_.faces().begin(), near_.faces().end(), [&](const Neighborhood::LocalFace& f) {
    return has(f.corner[0]) && has(f.corner[1]) && has(f.corner[2]) && sees_tet(f.corner, apex);
  });
}

/// The tetrahedron meets a face in more than shared corners, edges and faces.
bool Attempt::blocks(const Neighborhood::LocalFace& f, Index apex, Vec3 apex_at, VertexIndex apex_id) {
  const auto tet_corner = [&](Index i) { return i < 3 || i == apex; };
  const auto& c = f.corner;
  if (near_.code(c[0]) & near_.code(c[1]) & near_.code(c[2]) & Neighborhood::kOutside) return false;
  const int shared = tet_corner(c[0]) + tet_corner(c[1]) + tet_corner(c[2]);
  // A side of the tetrahedron: it must be seen from its unfilled side, or be the back of a wall of which that is so.
  if (shared == 3) return !sees_tet(c, apex) && !is_back_of_wall(c, apex);
  ++counters_.exact_tests;
  const std::array<NamedPoint, 4> tet{{{base_[0], at_[0]}, {base_[1], at_[1]}, {base_[2], at_[2]}, {apex_id, apex_at}}};
  std::array<NamedPoint, 3> face;
  for (int j = 0; j < 3; ++j) face[j] = {near_.vertex(c[j]), front_.at(near_.vertex(c[j]))};
  return meets_beyond_shared_simplex(tet, face);
}

bool Attempt::keeps_clear(Index apex, Vec3 apex_local, const Contact& contact, const Limits& limits) const {
  if (contact.edge[0] && contact.edge[1] && contact.edge[2]) return true;
  const double least = limits.edge_clearance * limits.edge_clearance;
  const std::array<Vec3, 3>& base = near_.base();
  for (const auto& f : near_.faces()) {
    const auto& c = f.corner;
    if (near_.code(c[0]) & near_.code(c[1]) & near_.code(c[2]) & Neighborhood::kClear) continue;
    for (int j = 0; j < 3; ++j) {
      const Index p = f.corner[j], q = f.corner[(j + 1) % 3];
      // Each edge has two faces that run through it in opposite directions: once is enough.
      if (p > q || p == apex || q == apex) continue;
      if (near_.code(p) & near_.code(q) & Neighborhood::kClear) continue;
      const Vec3 a = near_.local(p), ab = near_.local(q) - a;
      for (Index i = 0; i < 3; ++i) {
        if (contact.edge[i] || p == i || q == i) continue;
        if (segments_nearer_than(least, base[i], apex_local - base[i], a, ab)) return false;
      }
    }
  }
  return true;
}

bool Attempt::clear_of_faces(Vec3 apex, float least) const {
  for (const auto& f : near_.faces()) {
    const auto& c = f.corner;
    if (near_.code(c[0]) & near_.code(c[1]) & near_.code(c[2]) & Neighborhood::kClear) continue;
    const Vec3 p = near_.local(c[0]), q = near_.local(c[1]), r = near_.local(c[2]);
    const Vec3 n = cross(q - p, r - p), w = apex - p;
    const double height = dot(w, n), area2 = squared_length(n);
    if (height * height > least * least * area2) continue;
    // Beside the triangle, its edges and corners are what is near: keeps_clear sees to those.
    if (dot(cross(q - p, w), n) >= 0 && dot(cross(w, r - p), n) >= 0 && dot(cross(r - q, apex - q), n) >= 0)
      return false;
  }
  return true;
}

std::optional<Attempt::Contact> Attempt::try_candidate(const Candidate& candidate, const Limits& limits) {
  ++counters_.candidates;
  face_tests_ += near_.faces().size();
  const Index apex = candidate.index;
  const Vec3 p = near_.local(apex);
  const Contact contact = contact_of(apex);
  const bool closes_all = contact.closed == 3;
  if (!closes_all && !edges_short_enough(p, contact, limits.longest_edge)) return {};
  const VertexIndex id = near_.vertex(apex);
  const Vec3 apex_at = front_.at(id);
  if (orient3d(at_[0], at_[1], at_[2], apex_at) <= 0) return {};
  near_.classify(apex, near_.to_local(apex_at), static_cast<float>(limits.edge_clearance));
  if (!is_valid(apex, apex_at, id)) return {};
  if (!closes_all && !keeps_clear(apex, p, contact, limits)) return {};
  return contact;
}

bool Attempt::try_ideal_point(const Limits& limits) {
  if (!front_.domain().contains(ideal_at_) || orient3d(at_[0], at_[1], at_[2], ideal_at_) <= 0) return false;
  near_.classify(kNewVertex, ideal_, static_cast<float>(limits.edge_clearance));
  return is_valid(kNewVertex, ideal_at_, kNone) && keeps_clear(kNewVertex, ideal_, {}, limits) &&
         clear_of_faces(ideal_, static_cast<float>(limits.face_clearance));
}

Attempt::Outcome Attempt::advance(FaceIndex face, const Limits& limits, std::vector<QueuedFace>& created) {
  if (!place(face, limits)) return Outcome::kBeyond;
  ++counters_.attempts;
  blocker_ = near_.faces().size();
  collect_candidates(limits);
  for (const Candidate& c : candidates_) {
    const std::optional<Contact> contact = try_candidate(c, limits);
    if (!contact) continue;
    commit(face, near_.vertex(c.index), *contact, created);
    return Outcome::kAdvanced;
  }
  if (!limits.new_points || !try_ideal_point(limits)) return Outcome::kStuck;
  ++counters_.ideal_points;
  commit(face, front_.add_vertex(ideal_at_, sizes_.at(ideal_at_)), {}, created);
  return Outcome::kAdvanced;
}

void Attempt::commit(FaceIndex face, VertexIndex apex, const Contact& contact, std::vector<QueuedFace>& created) {
  const std::uint32_t region = front_.face(face).region;
  front_.add_tet(base_, apex);
  front_.remove_face(face);
  for (int i = 0; i < 3; ++i)
    if (contact.face[i] != kNone) front_.remove_face(contact.face[i]);
  for (int i = 0; i < 3; ++i)
    if (contact.face[i] == kNone)
      created.push_back(front_.queued(front_.add_face({{base_[(i + 1) % 3], base_[(i + 2) % 3], apex}, region})));
}

}  // namespace octafront
