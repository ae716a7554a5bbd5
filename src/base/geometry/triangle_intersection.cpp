#include "base/geometry/triangle_intersection.h"

#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"

#include <span>

namespace octafront {

namespace {

// In all of this file edge i of a triangle is opposite corner i.
constexpr int next(int i) {
  return i == 2 ? 0 : i + 1;
}
constexpr int prev(int i) {
  return i == 0 ? 2 : i - 1;
}

// A plane's image under dropping one coordinate, which keeps incidences if the axis is not parallel to the plane.
struct Projection {
  int axis = 0;
  int turn = 0;  // orientation of the triangle that chose the axis; 0 if it is degenerate

  int orient(Vec3 a, Vec3 b, Vec3 c) const {
    const int u = next(axis), v = next(u);
    return orient2d(a[u], a[v], b[u], b[v], c[u], c[v]);
  }
};

Projection projection_of(const TriangleCorners& t) {
  const Vec3 n = double_area_normal(t[0], t[1], t[2]);
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  Projection p{x >= y && x >= z ? 0 : y >= z ? 1 : 2};
  for (int tries = 0; tries < 3; ++tries, p.axis = next(p.axis)) {
    p.turn = p.orient(t[0], t[1], t[2]);
    if (p.turn != 0) break;
  }
  return p;
}

// True if an edge of t has all `others` strictly outside; `turn` is the orientation of t.
bool edge_separates(const Projection& plane, const TriangleCorners& t, int turn, std::span<const Vec3> others) {
  for (int i = 0; i < 3; ++i) {
    bool all_outside = true;
    for (const Vec3& o : others) all_outside = all_outside && plane.orient(t[next(i)], t[prev(i)], o) * turn < 0;
    if (all_outside) return true;
  }
  return false;
}

// Disjoint convex polygons of the plane are separated by the line of an edge of one of them.
bool coplanar_triangles_meet(const TriangleCorners& s, const TriangleCorners& t) {
  const Projection plane = projection_of(s);
  const int turn = plane.orient(t[0], t[1], t[2]);
  if (plane.turn == 0 || turn == 0) return true;
  return !edge_separates(plane, s, plane.turn, t) && !edge_separates(plane, t, turn, s);
}

bool coplanar_segment_meets(Vec3 p, Vec3 q, const TriangleCorners& t) {
  const Projection plane = projection_of(t);
  if (plane.turn == 0) return true;
  if (edge_separates(plane, t, plane.turn, std::array{p, q})) return false;
  const int side = plane.orient(p, q, t[0]);
  return side == 0 || plane.orient(p, q, t[1]) != side || plane.orient(p, q, t[2]) != side;
}

// Signs of the volumes that the line pq spans with the edges of t.
std::array<int, 3> turns_around(Vec3 p, Vec3 q, const TriangleCorners& t) {
  return {orient3d(p, q, t[1], t[2]), orient3d(p, q, t[2], t[0]), orient3d(p, q, t[0], t[1])};
}

// The ends' sides of the plane of t are known.
bool segment_meets(Vec3 p, int p_side, Vec3 q, int q_side, const TriangleCorners& t) {
  if (p_side * q_side > 0) return false;
  if (p_side == 0 && q_side == 0) return coplanar_segment_meets(p, q, t);
  const int first = orient3d(p, q, t[1], t[2]);
  const int second = orient3d(p, q, t[2], t[0]);
  if (first * second < 0) return false;
  const int third = orient3d(p, q, t[0], t[1]);
  return first * third >= 0 && second * third >= 0;
}

std::array<int, 3> sides_of_plane(const TriangleCorners& t, const TriangleCorners& points) {
  return {orient3d(t[0], t[1], t[2], points[0]), orient3d(t[0], t[1], t[2], points[1]),
          orient3d(t[0], t[1], t[2], points[2])};
}

bool strictly_one_side(const std::array<int, 3>& side) {
  return side[0] != 0 && side[0] == side[1] && side[0] == side[2];
}

bool boxes_meet(const TriangleCorners& s, const TriangleCorners& t) {
  const Vec3 s_lo = min(min(s[0], s[1]), s[2]), s_hi = max(max(s[0], s[1]), s[2]);
  const Vec3 t_lo = min(min(t[0], t[1]), t[2]), t_hi = max(max(t[0], t[1]), t[2]);
  return Box3{s_lo, s_hi}.overlaps(Box3{t_lo, t_hi});
}

bool some_edge_meets(const TriangleCorners& s, const std::array<int, 3>& side, const TriangleCorners& t) {
  for (int i = 0; i < 3; ++i)
    if (segment_meets(s[i], side[i], s[next(i)], side[next(i)], t)) return true;
  return false;
}

// Corners of a triangle in the order of its turns: the apex i, then the ends of the edge opposite it.
struct Fan {
  Vec3 apex, first, second;
  Fan(const TriangleCorners& t, int i) : apex(t[i]), first(t[next(i)]), second(t[prev(i)]) {}
};

// True if, seen along an axis along which s is not degenerate, a line through the common apex separates the rest of two
// triangles: an edge of s or an edge of t. Then they have only the apex in common; nearly coplanar neighbours end here.
bool cones_apart_in_view(const Projection& view, const Fan& s, const Fan& t) {
  if (view.turn == 0) return false;
  const auto side_of_first = [&](Vec3 p) { return view.orient(s.apex, s.first, p) * view.turn; };
  const auto side_of_second = [&](Vec3 p) { return view.orient(s.second, s.apex, p) * view.turn; };
  if (side_of_first(t.first) < 0 && side_of_first(t.second) < 0) return true;
  if (side_of_second(t.first) < 0 && side_of_second(t.second) < 0) return true;
  const auto separates = [&](Vec3 end, Vec3 other) {
    const int side = view.orient(t.apex, end, s.first);
    return side != 0 && view.orient(t.apex, end, s.second) == side && view.orient(t.apex, end, other) * side <= 0;
  };
  return separates(t.first, t.second) || separates(t.second, t.first);
}

bool certainly_one_side(const TriangleCorners& t, Vec3 p, Vec3 q) {
  const int side = orient3d_filter(t[0], t[1], t[2], p);
  return side != 0 && side == orient3d_filter(t[0], t[1], t[2], q);
}

// Triangles that share corner s[i] = t[j]. If they share more, they share a segment from there to the far edge of one
// of them, for both are cones over their far edges.
bool conflict_beyond_corner(const TriangleCorners& s, int i, const TriangleCorners& t, int j) {
  const Fan u(s, i), v(t, j);
  if (certainly_one_side(s, v.first, v.second) || certainly_one_side(t, u.first, u.second)) return false;
  if (cones_apart_in_view(projection_of(s), u, v)) return false;
  const int side_v1 = orient3d(s[0], s[1], s[2], v.first), side_v2 = orient3d(s[0], s[1], s[2], v.second);
  if (side_v1 * side_v2 > 0) return false;
  const int side_u1 = orient3d(t[0], t[1], t[2], u.first), side_u2 = orient3d(t[0], t[1], t[2], u.second);
  if (side_u1 * side_u2 > 0) return false;
  return segment_meets(v.first, side_v1, v.second, side_v2, s) || segment_meets(u.first, side_u1, u.second, side_u2, t);
}

// Triangles that share the edges opposite s[i] and t[j]. On either side of the edge in any view, or not in one plane,
// they have nothing else in common.
bool conflict_beyond_edge(const TriangleCorners& s, int i, const TriangleCorners& t, int j) {
  if (orient3d_filter(s[0], s[1], s[2], t[j]) != 0) return false;
  const Projection view = projection_of(s);
  if (view.orient(s[next(i)], s[prev(i)], t[j]) * view.turn < 0) return false;
  return orient3d(s[0], s[1], s[2], t[j]) == 0;
}

// True if an edge of s, seen along an axis along which s is not degenerate, has all of t strictly outside.
bool apart_in_view(const TriangleCorners& s, const TriangleCorners& t) {
  const Projection view = projection_of(s);
  return view.turn != 0 && edge_separates(view, s, view.turn, t);
}

bool certainly_one_side(const TriangleCorners& t, const TriangleCorners& points) {
  return certainly_one_side(t, points[0], points[1]) && certainly_one_side(t, points[0], points[2]);
}

}  // namespace

bool triangles_meet(const TriangleCorners& s, const TriangleCorners& t) {
  if (!boxes_meet(s, t)) return false;
  if (certainly_one_side(s, t) || certainly_one_side(t, s) || apart_in_view(s, t)) return false;
  const auto t_side = sides_of_plane(s, t);
  if (strictly_one_side(t_side)) return false;
  const auto s_side = sides_of_plane(t, s);
  if (strictly_one_side(s_side)) return false;
  if (t_side == std::array{0, 0, 0} && s_side == std::array{0, 0, 0}) return coplanar_triangles_meet(s, t);
  return some_edge_meets(s, s_side, t) || some_edge_meets(t, t_side, s);
}

bool triangles_conflict(const TriangleCorners& s, const Triangle& s_ids, const TriangleCorners& t,
                        const Triangle& t_ids) {
  int shared = 0, s_index = 0, t_index = 0;  // sums of the shared corners' indices
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (s_ids[i] != t_ids[j]) continue;
      ++shared;
      s_index += i;
      t_index += j;
    }
  }
  switch (shared) {
    case 0:
      return triangles_meet(s, t);
    case 1:
      return conflict_beyond_corner(s, s_index, t, t_index);
    case 2:
      return conflict_beyond_edge(s, 3 - s_index, t, 3 - t_index);
    default:
      return true;
  }
}

bool triangles_conflict(const std::vector<Vec3>& points, const Triangle& s, const Triangle& t) {
  return triangles_conflict({points[s[0]], points[s[1]], points[s[2]]}, s, {points[t[0]], points[t[1]], points[t[2]]},
                            t);
}

SegmentHit segment_triangle_hit(Vec3 p, Vec3 q, const TriangleCorners& t) {
  SegmentHit hit;
  const int p_side = orient3d(t[0], t[1], t[2], p), q_side = orient3d(t[0], t[1], t[2], q);
  if (p_side * q_side > 0) return hit;
  if (p_side == 0 && q_side == 0) {
    if (coplanar_segment_meets(p, q, t)) hit.kind = SegmentHit::Kind::kCoplanar;
    return hit;
  }
  const auto turn = turns_around(p, q, t);
  if (turn[0] * turn[1] < 0 || turn[1] * turn[2] < 0 || turn[2] * turn[0] < 0) return hit;
  hit.kind = SegmentHit::Kind::kPoint;
  hit.end = p_side == 0 ? 0 : q_side == 0 ? 1 : -1;
  hit.from_side = p_side != 0 ? p_side : -q_side;
  const int zeros = (turn[0] == 0) + (turn[1] == 0) + (turn[2] == 0);
  if (zeros == 0) return hit;
  hit.part = zeros == 1 ? SegmentHit::Part::kEdge : SegmentHit::Part::kCorner;
  // On one edge's line: that edge. On two: the corner opposite the third.
  for (int i = 0; i < 3; ++i)
    if ((turn[i] == 0) == (zeros == 1)) hit.index = i;
  return hit;
}

}  // namespace octafront
