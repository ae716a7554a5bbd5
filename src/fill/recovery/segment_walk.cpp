#include "fill/recovery/segment_walk.h"

#include <octafront/error.h>

#include <fmt/core.h>

namespace octafront::recovery {

namespace {

[[noreturn]] void throw_vertex_on_segment(const ExactPoints& points, VertexIndex a, VertexIndex b, VertexIndex v) {
  const Vec3 p = points.at(a), q = points.at(b), r = points.at(v);
  throw MeshingError(fmt::format(
      "the surface touches itself: vertex {} at ({}, {}, {}) lies on the edge from ({}, {}, {}) to ({}, {}, "
      "{}); repair the surface there",
      v, r.x, r.y, r.z, p.x, p.y, p.z, q.x, q.y, q.z));
}

// Steps of the walk; one object per segment.
class Walker {
 public:
  Walker(const ExactPoints& points, TetComplex& mesh, VertexIndex a, VertexIndex b)
      : points_(points), mesh_(mesh), a_(a), b_(b) {}

  // Fills `next` with the crossing after `c`. Returns false if the segment ends before; then the piece fields of `next`
  // tell where its last piece lies.
  bool advance(const Crossing& c, Crossing& next) { return c.is_edge ? from_edge(c, next) : from_face(c, next); }

 private:
  int side(VertexIndex x, VertexIndex y) const { return points_.orient(a_, b_, x, y); }

  static void set_edge(Crossing& c, TetIndex t, VertexIndex x, VertexIndex y) {
    c.is_edge = true;
    c.face = kNone;
    c.tet = t;
    c.x = x;
    c.y = y;
  }
  void set_face(Crossing& c, TetIndex t, VertexIndex opposite) const {
    c.is_edge = false;
    c.tet = t;
    c.face = mesh_.opposite(t, opposite);
  }

  bool from_face(const Crossing& c, Crossing& next) {
    const Triangle f = mesh_.face(c.face);
    const HalfFace o = mesh_.across[c.face];
    const TetIndex t = o / 4;
    const VertexIndex d = mesh_.apex(o);
    next.piece_tet = t;
    next.piece_face = kNone;
    if (d == b_) return false;
    const std::array<int, 3> s{side(f[0], d), side(f[1], d), side(f[2], d)};
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      // The projection along the segment: it leaves through (i, j, d) if it lies left of (j, d) and right of (i, d).
      if (s[j] > 0 && s[i] < 0) {
        set_face(next, t, f[k]);
        return true;
      }
      if (s[i] == 0 && s[j] > 0 && s[k] < 0) {
        set_edge(next, t, f[i], d);
        return true;
      }
    }
    throw_vertex_on_segment(points_, a_, b_, d);
  }

  bool from_edge(const Crossing& c, Crossing& next) {
    const VertexIndex x = c.x, y = c.y;
    if (!mesh_.closed_ring(c.tet, x, y, ring_)) throw_vertex_on_segment(points_, a_, b_, x);
    const std::size_t n = ring_.tets.size();
    for (std::size_t i = 0; i < n; ++i) {
      const VertexIndex p = ring_.ring[i], q = ring_.ring[(i + 1) % n];
      const int before = points_.orient(x, y, p, b_);
      const int after = p == b_ ? 1 : points_.orient(x, y, b_, q);
      next.piece_tet = ring_.tets[i];
      if (p == b_ || (before == 0 && after > 0)) return inside_face(x, y, p, q, next);
      if (before > 0 && after > 0) return inside_tet(x, y, p, q, next);
    }
    throw_vertex_on_segment(points_, a_, b_, x);
  }

  // The segment runs from edge (x, y) through next.piece_tet, inside the face (x, y, p); q is off its plane.
  bool inside_face(VertexIndex x, VertexIndex y, VertexIndex p, VertexIndex q, Crossing& next) {
    next.piece_face = mesh_.opposite(next.piece_tet, q);
    if (p == b_) return false;
    const int sp = side(q, p), sx = side(q, x);
    if (sp == 0) throw_vertex_on_segment(points_, a_, b_, p);
    set_edge(next, next.piece_tet, sp == sx ? y : x, p);
    return true;
  }

  bool inside_tet(VertexIndex x, VertexIndex y, VertexIndex p, VertexIndex q, Crossing& next) {
    next.piece_face = kNone;
    const int pq = side(p, q);
    if (pq == 0) {
      set_edge(next, next.piece_tet, p, q);
    } else {
      set_face(next, next.piece_tet, pq == side(x, p) ? y : x);
    }
    return true;
  }

  const ExactPoints& points_;
  TetComplex& mesh_;
  VertexIndex a_, b_;
  EdgeRing ring_;
};

// The part of the star that the ray enters, if tet t holds it: all three signs nonnegative.
bool hit_in_tet(const TetComplex& mesh, TetIndex t, int at, const std::array<int, 3>& s, FirstHit& hit) {
  const Triangle f = mesh.face(4 * t + static_cast<HalfFace>(at));
  hit.tet = t;
  hit.vertex = kNone;
  hit.crossing = {};
  hit.crossing.tet = hit.crossing.piece_tet = t;
  const int zeros = (s[0] == 0) + (s[1] == 0) + (s[2] == 0);
  if (zeros == 0) {
    hit.crossing.face = 4 * t + static_cast<HalfFace>(at);
    return true;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (zeros == 1 && s[i] == 0) {
      hit.crossing.is_edge = true;
      hit.crossing.x = f[i];
      hit.crossing.y = f[j];
      hit.crossing.piece_face = mesh.opposite(t, f[k]);
      return true;
    }
    if (zeros == 2 && s[i] > 0) {
      hit.vertex = f[k];
      return true;
    }
  }
  return false;
}

}  // namespace

FirstHit first_hit(const ExactPoints& points, TetComplex& mesh, VertexIndex a, VertexIndex b) {
  FirstHit hit;
  // s[i] > 0: b lies inside of the plane through a and the i-th edge of the face opposite a. Returns the way out.
  std::array<int, 3> s{};
  const auto signs = [&](TetIndex t, int at, HalfFace from, unsigned shift) -> HalfFace {
    const Triangle f = mesh.face(4 * t + static_cast<HalfFace>(at));
    for (unsigned m = 0; m < 3; ++m) {
      const unsigned i = (m + shift) % 3;
      s[i] = points.orient(a, b, f[i], f[(i + 1) % 3]);
      const auto h = mesh.opposite(t, f[(i + 2) % 3]);
      if (s[i] < 0 && h != from) return h;
    }
    return kNone;
  };
  TetIndex t = mesh.tet_at[a];
  HalfFace from = kNone;
  std::uint32_t random = a * 2654435761u + b;
  constexpr int kMaxSteps = 400;
  for (int step = 0; step < kMaxSteps; ++step) {
    if (mesh.has(t, b)) {
      hit.vertex = b;
      hit.tet = t;
      return hit;
    }
    const int at = mesh.corner_of(t, a);
    random = random * 1664525u + 1013904223u;
    const HalfFace out = signs(t, at, from, random >> 24);
    if (out == kNone) {
      if (s[0] >= 0 && s[1] >= 0 && s[2] >= 0 && hit_in_tet(mesh, t, at, s, hit)) return hit;
      break;
    }
    const HalfFace o = mesh.across[out];
    if (is_outside(o)) break;
    from = o;
    t = o / 4;
  }
  // The walk lost itself (stars of a mesh that is not Delaunay may be that twisted): look everywhere.
  for (const TetIndex u : mesh.star(a)) {
    const int at = mesh.corner_of(u, a);
    if (mesh.has(u, b)) {
      hit.vertex = b;
      hit.tet = u;
      return hit;
    }
    const Triangle f = mesh.face(4 * u + static_cast<HalfFace>(at));
    for (unsigned i = 0; i < 3; ++i) s[i] = points.orient(a, b, f[i], f[(i + 1) % 3]);
    if (s[0] >= 0 && s[1] >= 0 && s[2] >= 0 && hit_in_tet(mesh, u, at, s, hit)) return hit;
  }
  throw std::logic_error("a segment leaves a vertex through no tetrahedron");
}

void walk_segment(const ExactPoints& points, TetComplex& mesh, VertexIndex a, VertexIndex b, SegmentWalk& walk) {
  walk.crossings.clear();
  walk.present = false;
  const FirstHit hit = first_hit(points, mesh, a, b);
  if (hit.vertex == b) {
    walk.present = true;
    return;
  }
  if (hit.vertex != kNone) throw_vertex_on_segment(points, a, b, hit.vertex);
  Walker walker(points, mesh, a, b);
  Crossing current = hit.crossing;
  while (walk.crossings.size() < SegmentWalk::kMostCrossings) {
    walk.crossings.push_back(current);
    Crossing next;
    if (!walker.advance(current, next)) {
      walk.last_piece_face = next.piece_face;
      walk.last_piece_tet = next.piece_tet;
      return;
    }
    current = next;
  }
}

TetIndex tet_with_edge(const ExactPoints& points, TetComplex& mesh, VertexIndex a, VertexIndex b) {
  const FirstHit hit = first_hit(points, mesh, a, b);
  return hit.vertex == b ? hit.tet : kNone;
}

}  // namespace octafront::recovery
