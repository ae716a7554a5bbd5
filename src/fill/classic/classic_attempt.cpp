#include "fill/classic/classic_attempt.h"

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

/// Candidates lie at least this share of the ideal point's distance away from the face's centroid.
constexpr double kNearestClassicCandidate = 0.1;
/// Trying all candidates of a face much larger than its surroundings would cost the square of the neighbourhood.
constexpr std::size_t kMostClassicCandidates = 40;
/// The size used for a face stays within these multiples of its own edges (see the octree's front,
/// docs/how/volume-front.md).
constexpr double kLeastClassicSizePerEdge = 0.45, kMostClassicSizePerEdge = 2.0;

/// Degrees of the unfilled wedge at the edge from p to q between two faces that see it, one of them with p before q:
/// the first's third corner is a, the second's b.
double angle_between(Vec3 p, Vec3 q, Vec3 a, Vec3 b) {
  const Vec3 axis = normalized(q - p), u = a - p, v = b - p;
  const Vec3 x = u - axis * dot(u, axis), y = v - axis * dot(v, axis);
  double angle = elementary::atan2(dot(axis, cross(x, y)), dot(x, y)) * 180 / std::numbers::pi;
  return angle < 0 ? angle + 360 : angle;
}

}  // namespace

void ClassicAttempt::place(ClassicFront::Face face, const ClassicLimits& limits) {
  face_ = face;
  base_ = front_.corners(face);
  double longest = 0;
  for (int i = 0; i < 3; ++i) at_[i] = front_.at(base_[i]);
  for (int i = 0; i < 3; ++i) longest = std::max(longest, distance(at_[i], at_[(i + 1) % 3]));
  const Vec3 middle = centroid(at_[0], at_[1], at_[2]), twice_area = double_area_normal(at_[0], at_[1], at_[2]);
  const double edge = std::sqrt(length(twice_area) * 2 / std::numbers::sqrt3);
  size_ = std::clamp(sizes_.at(middle), kLeastClassicSizePerEdge * edge, kMostClassicSizePerEdge * longest);
  ideal_ = middle + normalized(twice_area) * (options_.ideal_distance * limits.ideal_factor * size_);
  const double r = limits.search_radius * size_;
  const Vec3 radius{r, r, r};
  vertices_.clear();
  front_.vertices_near({ideal_ - radius, ideal_ + radius}, vertices_);
  // What may come near: the base face, the sphere, and the clearance around them.
  Box3 box{ideal_ - radius, ideal_ + radius};
  for (const Vec3 p : at_) box.add(p);
  const double clearance = size_ * std::max({limits.vertex_clearance, limits.face_clearance, limits.edge_clearance});
  const Vec3 margin{clearance, clearance, clearance};
  found_.clear();
  front_.faces_near({box.lo - margin, box.hi + margin}, found_);
  near_.clear();
  for (const ClassicFront::Face f : found_) {
    if (f == face) continue;
    NearFace& n = near_.emplace_back();
    n.face = f;
    n.id = front_.corners(f);
    for (int k = 0; k < 3; ++k) n.box.add(n.at[k] = front_.at(n.id[k]));
  }
  counters_.found_faces += near_.size();
}

void ClassicAttempt::find_contact(Trial& trial) const {
  if (trial.apex == kNone) return;
  for (const NearFace& f : near_) {
    if (std::find(f.id.begin(), f.id.end(), trial.apex) == f.id.end()) continue;
    unsigned touched = 0;
    for (int i = 0; i < 3; ++i)
      if (std::find(f.id.begin(), f.id.end(), base_[i]) != f.id.end()) touched |= 1u << i;
    for (int i = 0; i < 3; ++i) {
      trial.edge[i] = trial.edge[i] || (touched >> i & 1);
      if (touched == (7u & ~(1u << i))) trial.side[i] = f.face;
    }
  }
}

/// Test of volume: positive by exact sign, and of a fair shape.
bool ClassicAttempt::has_volume(const Trial& trial, const ClassicLimits& limits) const {
  return tet_radius_ratio(at_[0], at_[1], at_[2], trial.at) >= limits.least_quality &&
         orient3d(at_[0], at_[1], at_[2], trial.at) > 0;
}

bool ClassicAttempt::new_vertex_is_clear(Vec3 p, const ClassicLimits& limits) const {
  const double v2 = elementary::pow(limits.vertex_clearance * size_, 2),
               f2 = elementary::pow(limits.face_clearance * size_, 2);
  for (const NearFace& f : near_) {
    for (const Vec3 q : f.at)
      if (squared_distance(p, q) < v2) return false;
    if (squared_distance(p, closest_point_on_triangle(p, f.at[0], f.at[1], f.at[2])) < f2) return false;
  }
  return true;
}

bool ClassicAttempt::edges_are_clear(const Trial& trial, double clearance) const {
  if (clearance == 0) return true;
  const double least = clearance * clearance;
  Box3 reach;
  reach.add(trial.at);
  for (const Vec3 p : at_) reach.add(p);
  const Vec3 margin{clearance, clearance, clearance};
  reach = {reach.lo - margin, reach.hi + margin};
  for (const NearFace& f : near_) {
    if (!reach.overlaps(f.box)) continue;
    for (int j = 0; j < 3; ++j) {
      const VertexIndex p = f.id[j], q = f.id[(j + 1) % 3];
      // Each edge has two faces that run through it in opposite directions: once is enough.
      if (p > q || p == trial.apex || q == trial.apex) continue;
      for (int i = 0; i < 3; ++i) {
        if (trial.edge[i] || p == base_[i] || q == base_[i]) continue;
        if (squared_segment_distance(at_[i], trial.at - at_[i], f.at[j], f.at[(j + 1) % 3] - f.at[j]) < least)
          return false;
      }
    }
  }
  return true;
}

/// Test of distance: new edges are not too long, a new vertex and new edges not too near to the front.
bool ClassicAttempt::keeps_distance(const Trial& trial, const ClassicLimits& limits) const {
  const double longest = limits.longest_edge * size_;
  for (int i = 0; i < 3; ++i)
    if (!trial.edge[i] && distance(at_[i], trial.at) > longest) return false;
  if (trial.apex == kNone && !new_vertex_is_clear(trial.at, limits)) return false;
  return edges_are_clear(trial, limits.edge_clearance * size_);
}

/// Test of angle: between each new face and the front's face across an edge of the base no narrow wedge remains.
bool ClassicAttempt::keeps_angles(const Trial& trial, double least_degrees) const {
  if (least_degrees == 0) return true;
  for (int i = 0; i < 3; ++i) {
    if (trial.side[i] != kNone) continue;
    // Side i has the base's edge from corner i + 1 to corner i + 2; the front's face across runs the other way.
    const VertexIndex p = base_[(i + 1) % 3], q = base_[(i + 2) % 3];
    for (const NearFace& f : near_)
      for (int k = 0; k < 3; ++k) {
        if (f.id[k] != q || f.id[(k + 1) % 3] != p || f.id[(k + 2) % 3] == trial.apex) continue;
        if (angle_between(front_.at(p), front_.at(q), trial.at, f.at[(k + 2) % 3]) < least_degrees) return false;
      }
  }
  return true;
}

/// Test of inclusion: no vertex of the front lies in the tetrahedron. Exact.
bool ClassicAttempt::includes_vertex(const Trial& trial) const {
  Box3 box;
  box.add(trial.at);
  for (const Vec3 p : at_) box.add(p);
  for (const NearFace& f : near_) {
    if (!box.overlaps(f.box)) continue;
    for (int k = 0; k < 3; ++k) {
      const VertexIndex v = f.id[k];
      if (v == trial.apex || v == base_[0] || v == base_[1] || v == base_[2] || !box.contains(f.at[k])) continue;
      const Vec3 p = f.at[k];
      if (orient3d(at_[0], at_[1], at_[2], p) >= 0 && orient3d(at_[1], at_[0], trial.at, p) >= 0 &&
          orient3d(at_[2], at_[1], trial.at, p) >= 0 && orient3d(at_[0], at_[2], trial.at, p) >= 0)
        return true;
    }
  }
  return false;
}

/// Test of intersection: the tetrahedron and each face near it have but a shared simplex in common. Exact.
bool ClassicAttempt::intersects(const Trial& trial) const {
  Box3 box;
  box.add(trial.at);
  for (const Vec3 p : at_) box.add(p);
  const std::array<NamedPoint, 4> tet{
      {{base_[0], at_[0]}, {base_[1], at_[1]}, {base_[2], at_[2]}, {trial.apex, trial.at}}};
  for (const NearFace& f : near_) {
    if (!box.overlaps(f.box)) continue;
    int apex_at = -1, shared = 0;
    for (int k = 0; k < 3; ++k) {
      if (f.id[k] == trial.apex) apex_at = k;
      shared += f.id[k] == trial.apex || f.id[k] == base_[0] || f.id[k] == base_[1] || f.id[k] == base_[2];
    }
    if (shared == 3) {
      if (apex_at < 0) return true;
      // A side of the tetrahedron: it must face it, so run through the base's edge the other way.
      const VertexIndex p = f.id[(apex_at + 1) % 3], q = f.id[(apex_at + 2) % 3];
      bool faces_it = false;
      for (int i = 0; i < 3; ++i) faces_it = faces_it || (base_[i] == q && base_[(i + 1) % 3] == p);
      if (!faces_it) return true;
      continue;
    }
    if (meets_beyond_shared_simplex(tet, {{{f.id[0], f.at[0]}, {f.id[1], f.at[1]}, {f.id[2], f.at[2]}}})) return true;
  }
  return false;
}

bool ClassicAttempt::accept(Trial& trial, const ClassicLimits& limits) {
  ++counters_.candidates;
  find_contact(trial);
  const bool closes_all = trial.closes_all();
  if (closes_all ? orient3d(at_[0], at_[1], at_[2], trial.at) <= 0 : !has_volume(trial, limits))
    return ++counters_.too_flat, false;
  if (!closes_all && !keeps_distance(trial, limits)) return ++counters_.too_near, false;
  if (!closes_all && !keeps_angles(trial, limits.least_angle)) return ++counters_.too_sharp, false;
  if (includes_vertex(trial)) return ++counters_.including, false;
  if (intersects(trial)) return ++counters_.intersecting, false;
  return true;
}

bool ClassicAttempt::advance(ClassicFront::Face face, const ClassicLimits& limits,
                             std::vector<ClassicFront::Face>& created) {
  ++counters_.attempts;
  place(face, limits);
  const Vec3 middle = centroid(at_[0], at_[1], at_[2]);
  const double radius = limits.search_radius * size_, least = kNearestClassicCandidate * distance(ideal_, middle);
  std::vector<std::pair<double, VertexIndex>> candidates;
  for (const VertexIndex v : vertices_) {
    const Vec3 p = front_.at(v);
    const double d = distance(p, ideal_);
    if (v == base_[0] || v == base_[1] || v == base_[2] || d > radius || distance(p, middle) < least) continue;
    candidates.emplace_back(d, v);
  }
  std::sort(candidates.begin(), candidates.end());
  if (candidates.size() > kMostClassicCandidates) candidates.resize(kMostClassicCandidates);
  for (const auto& [d, v] : candidates) {
    Trial trial{v, front_.at(v)};
    if (!accept(trial, limits)) continue;
    commit(face, trial, created);
    return true;
  }
  if (!limits.new_points || !front_.domain().contains(ideal_)) return false;
  Trial trial{kNone, ideal_};
  if (!accept(trial, limits)) return false;
  ++counters_.ideal_points;
  trial.apex = front_.add_vertex(ideal_);
  commit(face, trial, created);
  return true;
}

void ClassicAttempt::commit(ClassicFront::Face face, const Trial& trial, std::vector<ClassicFront::Face>& created) {
  front_.add_tet(base_, trial.apex);
  for (int i = 0; i < 3; ++i)
    if (trial.side[i] == kNone)
      created.push_back(front_.add_face({base_[(i + 1) % 3], base_[(i + 2) % 3], trial.apex}));
  front_.remove_face(face);
  for (const ClassicFront::Face side : trial.side)
    if (side != kNone) front_.remove_face(side);
}

}  // namespace octafront
