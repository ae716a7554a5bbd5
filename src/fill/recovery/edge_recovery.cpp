#include <octafront/error.h>

#include "base/geometry/measures.h"
#include "fill/recovery/boundary_recovery.h"
#include "fill/recovery/facet_planes.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <fmt/core.h>

namespace octafront::recovery {

namespace {

// A segment that crosses more than this is not worked on by flips, it is divided first.
constexpr std::size_t kFlippedCrossings = 64;
constexpr int kRandomPasses = 6;

// The dyadic number of the fewest bits in [lo, hi], a part of (0, 1); NaN if it needs more than 50.
double short_dyadic(double lo, double hi) {
  if (!(lo > 0 && lo < hi && hi < 1)) return std::nan("");
  for (int bits = 1; bits <= 50; ++bits) {
    const double t = std::ldexp(std::ceil(std::ldexp(lo, bits)), -bits);
    if (t <= hi) return t;
  }
  return std::nan("");
}

}  // namespace

std::vector<Edge> BoundaryRecovery::missing_edges() {
  std::vector<Edge> missing;
  std::vector<VertexIndex> seen_from(points_.size(), kNone);
  VertexIndex from = kNone;
  for (const Edge& e : surface_.input_edges()) {
    if (e[0] != from) {
      from = e[0];
      if (from % 256 == 0) context_.check();
      for (const TetIndex t : mesh_.star(from)) {
        for (const VertexIndex v : mesh_.tets[t]) seen_from[v] = from;
      }
    }
    if (seen_from[e[1]] != from) missing.push_back(e);
  }
  std::ranges::stable_sort(missing, {}, [&](const Edge& e) {
    const double length = squared_distance(points_.at(e[0]), points_.at(e[1]));
    return longest_first_ ? -length : length;
  });
  return missing;
}

void BoundaryRecovery::recover_edges(const std::vector<Edge>& wanted) {
  std::deque<Edge> queue(wanted.begin(), wanted.end());
  SegmentWalk walk;
  while (!queue.empty()) {
    context_.check();
    const auto [a, b] = queue.front();
    queue.pop_front();
    if (edge_by_flips(a, b, walk)) {
      ++counts_.edges_by_flips;
      continue;
    }
    if (carrier_.size() > most_.points) throw TooManyPoints();
    const VertexIndex s = divide_edge(a, b, walk.crossings);
    if (points_.words(s) > most_.words) throw TooManyPoints();
    surface_.split_edge(a, b, s);
    queue.push_front({s, b});
    queue.push_front({a, s});
  }
}

bool BoundaryRecovery::edge_by_flips(VertexIndex a, VertexIndex b, SegmentWalk& walk) {
  const SegmentHindrance hindrance(points_, a, b, frame_);
  bool random_pass = false;
  for (int idle = 0; idle < (strict_ ? 1 : kRandomPasses);) {
    walk_segment(points_, mesh_, a, b, walk);
    if (walk.present) return true;
    if (walk.crossings.size() > kFlippedCrossings) return false;
    if (strict_ && (walk.crossings.size() > 1 || walk.crossings[0].is_edge)) return false;
    const bool improved = improve_once(walk, hindrance, random_pass);
    idle += random_pass;
    random_pass = !improved;
  }
  walk_segment(points_, mesh_, a, b, walk);
  return walk.present;
}

bool BoundaryRecovery::improve_once(const SegmentWalk& walk, const SegmentHindrance& hindrance, bool random_pass) {
  const std::size_t n = walk.crossings.size(), first = random_pass ? random() % n : 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (improve_at(walk.crossings[(first + k) % n], hindrance, random_pass)) return true;
    if (random_pass) break;  // the mesh may have changed
  }
  return false;
}

bool BoundaryRecovery::improve_at(const Crossing& c, const SegmentHindrance& hindrance, bool random_pass) {
  // In a random pass a change that leaves the hindrance as it is counts too.
  const double limit = random_pass ? 0 : -0.5;
  const int depth = random_pass ? 1 : 0;
  // A failed attempt at a crossing before may have changed the mesh here.
  if (!mesh_.alive(c.is_edge ? c.tet : c.face / 4)) return false;
  if (c.is_edge) {
    return mesh_.has(c.tet, c.x) && mesh_.has(c.tet, c.y) &&
           flipper_.remove_edge_deep({c.tet, c.x, c.y}, hindrance, limit, depth);
  }
  if (flipper_.flip_face(c.face, hindrance, limit)) return true;
  const Triangle f = mesh_.face(c.face);
  const unsigned shift = random_pass ? random() % 3 : 0;
  for (unsigned i = 0; i < 3; ++i) {
    const VertexIndex p = f[(i + shift) % 3], q = f[(i + shift + 1) % 3];
    if (!mesh_.alive(c.tet) || !mesh_.has(c.tet, p) || !mesh_.has(c.tet, q)) return false;
    if (flipper_.remove_edge_deep({c.tet, p, q}, hindrance, limit, depth)) return true;
  }
  return false;
}

Edge BoundaryRecovery::line_of(VertexIndex a, VertexIndex b) const {
  const auto carrier = [&](VertexIndex v) {
    return v >= frame_ + kFrameVertices
               ? Edge{carrier_[v - frame_ - kFrameVertices].from, carrier_[v - frame_ - kFrameVertices].to}
               : Edge{kNone, kNone};
  };
  const Edge ca = carrier(a), cb = carrier(b);
  const auto ends = [](const Edge& line, VertexIndex v) { return line[0] == v || line[1] == v; };
  if (ca[0] != kNone && (ends(ca, b) || ca == cb)) return ca;
  if (cb[0] != kNone && ends(cb, a)) return cb;
  return {a, b};
}

// Parts of an edge that was crossed before lie on its line; the ends of that line have shorter coordinates.
Edge BoundaryRecovery::crossed_line(VertexIndex x, VertexIndex y) const {
  const auto crossed = [&](VertexIndex v) {
    return v >= frame_ + kFrameVertices ? carrier_[v - frame_ - kFrameVertices].crossed : Edge{kNone, kNone};
  };
  const Edge cx = crossed(x), cy = crossed(y);
  if (cx[0] != kNone && (cx[0] == y || cx[1] == y || cx == cy)) return cx;
  if (cy[0] != kNone && (cy[0] == x || cy[1] == x)) return cy;
  return {x, y};
}

double BoundaryRecovery::parameter(const Edge& line, VertexIndex v) const {
  if (v == line[0]) return 0;
  if (v == line[1]) return 1;
  return carrier_[v - frame_ - kFrameVertices].t;
}

void BoundaryRecovery::refuse_intersection(Vec3 at) const {
  throw MeshingError(fmt::format("the surface intersects itself near ({}, {}, {}); repair it there", at.x, at.y, at.z));
}

VertexIndex BoundaryRecovery::divide_edge(VertexIndex a, VertexIndex b, const std::vector<Crossing>& crossings) {
  for (const Crossing& c : crossings) {
    if (c.is_edge && surface_.edges().contains(c.x, c.y)) refuse_intersection(points_.at(c.x));
    if (!c.is_edge && mesh_.label(c.face) != kNone) refuse_intersection(points_.at(mesh_.face(c.face)[0]));
  }
  learn_planes();
  // Where along the segment the crossings lie, about.
  const Vec3 pa = points_.at(a), direction = points_.at(b) - pa;
  std::vector<double> at;
  for (const Crossing& c : crossings) {
    double t = 0;
    if (c.is_edge) {
      const Vec3 x = points_.at(c.x), d = points_.at(c.y) - x, n = cross(direction, d);
      t = dot(cross(x - pa, d), n) / squared_length(n);
    } else {
      const Triangle f = mesh_.face(c.face);
      const Vec3 n = cross(points_.at(f[1]) - points_.at(f[0]), points_.at(f[2]) - points_.at(f[0]));
      t = dot(points_.at(f[0]) - pa, n) / dot(direction, n);
    }
    at.push_back(t);
  }
  // The longest inner pieces first. The first and the last piece touch an end: a point there would bring nothing.
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i < crossings.size(); ++i) {
    if (crossings[i].piece_face == kNone && at[i] > at[i - 1]) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return at[i] - at[i - 1]; });
  if (order.size() > 4) order.resize(4);
  for (const std::size_t i : order) {
    if (const VertexIndex s = place_inside(a, b, crossings[i].piece_tet, at[i - 1], at[i]); s != kNone) return s;
  }
  std::size_t best = crossings.size() / 2;
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const bool better_kind = crossings[i].is_edge && !crossings[best].is_edge;
    const bool nearer = std::abs(at[i] - 0.5) < std::abs(at[best] - 0.5);
    if (better_kind || (crossings[i].is_edge == crossings[best].is_edge && nearer)) best = i;
  }
  return place_at_crossing(a, b, crossings[best], at[best]);
}

// Parts of the way through an element that are kept free at both ends. A wide middle holds a short number; where that
// is not inside, one nearer to the middle is.
constexpr double kMargins[] = {0.25, 0.4, 0.49};

VertexIndex BoundaryRecovery::place_inside(VertexIndex a, VertexIndex b, TetIndex tet, double enter, double leave) {
  const Edge line = line_of(a, b);
  const double ta = parameter(line, a), tb = parameter(line, b);
  for (const double margin : kMargins) {
    double lo = ta + (tb - ta) * (enter + margin * (leave - enter));
    double hi = ta + (tb - ta) * (leave - margin * (leave - enter));
    if (lo > hi) std::swap(lo, hi);
    const double t = short_dyadic(lo, hi);
    if (std::isnan(t)) continue;
    const VertexIndex s = points_.add_between(line[0], line[1], t);
    bool inside = true;
    for (HalfFace h = 4 * tet; h < 4 * tet + 4 && inside; ++h) {
      const Triangle f = mesh_.face(h);
      inside = points_.orient(f[0], f[1], f[2], s) < 0;
    }
    if (!inside) {
      points_.pop();
      continue;
    }
    carrier_.push_back({line[0], line[1], t, {kNone, kNone}});
    insert(s, {&tet, 1});
    ++counts_.edge_points;
    return s;
  }
  return kNone;
}

VertexIndex BoundaryRecovery::place_at_crossing(VertexIndex a, VertexIndex b, const Crossing& c, double at) {
  const Edge line = line_of(a, b);
  const double ta = parameter(line, a), tb = parameter(line, b);
  VertexIndex s = kNone;
  Edge crossed{kNone, kNone};
  std::vector<TetIndex> tets;
  if (c.is_edge) {
    crossed = crossed_line(c.x, c.y);
    s = points_.add_crossing(line[0], line[1], crossed[0], crossed[1]);
    mesh_.closed_ring(c.tet, c.x, c.y, ring_);
    tets = ring_.tets;
  } else {
    const Triangle f = mesh_.face(c.face);
    s = points_.add_crossing(line[0], line[1], f[0], f[1], f[2]);
    tets = {c.face / 4, mesh_.across[c.face] / 4};
  }
  carrier_.push_back({line[0], line[1], ta + (tb - ta) * at, crossed});
  insert(s, tets);
  ++counts_.crossing_points;
  return s;
}

void BoundaryRecovery::insert(VertexIndex s, std::span<const TetIndex> tets) {
  mesh_.tet_at.resize(points_.size(), kNone);
  const std::uint32_t inside = mesh_.new_mark();
  for (const TetIndex t : tets) mesh_.marks[t] = inside;
  std::vector<Tet> fresh;
  for (const TetIndex t : tets) {
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      if (const HalfFace o = mesh_.across[h]; !is_outside(o) && mesh_.marks[o / 4] == inside) continue;
      const Triangle f = mesh_.face(h);
      fresh.push_back({f[0], f[2], f[1], s});
    }
  }
  const std::vector<TetIndex> old(tets.begin(), tets.end());
  mesh_.replace(old, fresh);
}

// Only Steiner points need them.
void BoundaryRecovery::learn_planes() {
  if (planes_known_) return;
  planes_known_ = true;
  points_.set_planes(surface_.triangles(), facet_planes(points_, surface_.triangles()));
}

void BoundaryRecovery::run() {
  const std::vector<Edge> missing = missing_edges();
  counts_.missing_edges = missing.size();
  recover_edges(missing);
  recover_facets();
}

}  // namespace octafront::recovery
