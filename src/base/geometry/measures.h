#pragma once

// Lengths, areas, volumes, angles and shape of triangles and tetrahedra in plain floating point, inline for hot loops.
// They rank alternatives; what is valid is for predicates.h to say. None branches on the shape: a degenerate element
// gets the limit value 0 where a ratio is asked for, never a NaN, as long as sixth powers of its edge lengths neither
// overflow nor underflow (lengths within about 1e-50 ... 1e50).

#include <octafront/vec.h>

#include "base/core/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace octafront {

/// ((b - a) x (c - a)) . (d - a): six times the volume, positive for a positive tetrahedron.
constexpr double six_volumes(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return dot(cross(b - a, c - a), d - a);
}

/// Volume of the tetrahedron, negative if it is inverted.
constexpr double signed_volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return six_volumes(a, b, c, d) / 6;
}

/// Normal of the triangle, seen counter-clockwise, as long as twice its area.
constexpr Vec3 double_area_normal(Vec3 a, Vec3 b, Vec3 c) {
  return cross(b - a, c - a);
}

/// Normal of length 1; zero for a degenerate triangle.
inline Vec3 unit_normal(Vec3 a, Vec3 b, Vec3 c) {
  return normalized(double_area_normal(a, b, c));
}

/// The volume of a regular tetrahedron over the cube of its edge.
inline constexpr double kRegularTet = 0.11785113;
/// Edge of an equilateral triangle of area 1.
inline constexpr double kEdgeOfUnitArea = 1.5196713713031851;

inline double triangle_area(Vec3 a, Vec3 b, Vec3 c) {
  return 0.5 * length(double_area_normal(a, b, c));
}
inline double triangle_area(const std::vector<Vec3>& points, const std::array<std::uint32_t, 3>& t) {
  return triangle_area(points[t[0]], points[t[1]], points[t[2]]);
}

constexpr Vec3 centroid(Vec3 a, Vec3 b, Vec3 c) {
  return (a + b + c) / 3;
}
constexpr Vec3 centroid(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return (a + b + c + d) * 0.25;
}

constexpr double squared_distance(Vec3 a, Vec3 b) {
  return squared_length(a - b);
}

/// Angle at `apex` between the directions to b and c, radians, in [0, pi]; accurate for small and flat angles too.
inline double angle_at(Vec3 apex, Vec3 b, Vec3 c) {
  const Vec3 u = b - apex, v = c - apex;
  return elementary::atan2(length(cross(u, v)), dot(u, v));
}

/// Solid angle at `apex` of the triangle (a, b, c), steradians; positive if (a, b, c, apex) is a negative tetrahedron,
/// that is if the triangle turns counter-clockwise around the direction away from the apex. (Van Oosterom & Strackee
/// 1983.)
inline double solid_angle(Vec3 apex, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = a - apex, v = b - apex, w = c - apex;
  const double lu = length(u), lv = length(v), lw = length(w);
  return 2 * elementary::atan2(dot(u, cross(v, w)), lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv);
}

/// beta = 3 r / R of a tetrahedron: 1 if regular, 0 if flat, negative if inverted. Five square roots and a division.
inline double tet_radius_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  // The normal of face (b, c, d) follows from the other three: area vectors of a closed surface sum to zero.
  const double areas = length(vw) + length(wu) + length(uv) + length(vw + wu + uv);
  const double det = dot(u, vw);
  // |u|^2 (v x w) + |v|^2 (w x u) + |w|^2 (u x v) is 2 det times the circumcentre, seen from a.
  const double radius = length(squared_length(u) * vw + squared_length(v) * wu + squared_length(w) * uv);
  return 6 * det * std::abs(det) / (areas * radius + std::numeric_limits<double>::min());
}

/// 2 r / R of a triangle: 1 if equilateral, 0 if degenerate. Three square roots and a division.
inline double triangle_radius_ratio(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = b - a, v = c - a, w = c - b;
  const double lu = length(u), lv = length(v), lw = length(w);
  return 4 * squared_length(cross(u, v)) / ((lu + lv + lw) * lu * lv * lw + std::numeric_limits<double>::min());
}

/// Centre of the sphere through the corners; not finite if the tetrahedron is flat.
inline Vec3 circumcenter(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  return a + (squared_length(u) * vw + squared_length(v) * wu + squared_length(w) * uv) / (2 * dot(u, vw));
}

/// Centre of the circle through the corners, in their plane; not finite if the triangle is degenerate.
inline Vec3 circumcenter(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = b - a, v = c - a, n = cross(u, v);
  return a + cross(squared_length(u) * v - squared_length(v) * u, n) / (2 * squared_length(n));
}

inline double circumradius(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return distance(a, circumcenter(a, b, c, d));
}
inline double circumradius(Vec3 a, Vec3 b, Vec3 c) {
  return distance(a, circumcenter(a, b, c));
}

/// Radius of the inscribed sphere, negative if inverted; 0 if all four corners coincide.
inline double inradius(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double areas = length(vw) + length(wu) + length(uv) + length(vw + wu + uv);
  return dot(u, vw) / (areas + std::numeric_limits<double>::min());
}

/// Squared lengths of the longest edge of a triangle or tetrahedron.
constexpr double longest_squared_edge(Vec3 a, Vec3 b, Vec3 c) {
  return std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
}
constexpr double longest_squared_edge(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return std::max(longest_squared_edge(a, b, c),
                  std::max({squared_distance(a, d), squared_distance(b, d), squared_distance(c, d)}));
}

/// Cosines of the six dihedral angles in the order of kTetEdges (tet_mesh.h): no acos, for loops that compare with
/// cosines of thresholds. 0 at an edge with a degenerate face.
inline std::array<double, 6> dihedral_cosines(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  // Outward normals of the faces opposite a, b, c, d for a positive tetrahedron.
  const Vec3 nb = cross(v, w), nc = cross(w, u), nd = cross(u, v), na = -(nb + nc + nd);
  constexpr double kTiny = std::numeric_limits<double>::min();
  const double la = 1 / (length(na) + kTiny), lb = 1 / (length(nb) + kTiny), lc = 1 / (length(nc) + kTiny),
               ld = 1 / (length(nd) + kTiny);
  // The edge between two corners lies between the faces opposite the other two.
  return {-dot(nc, nd) * lc * ld, -dot(nb, nd) * lb * ld, -dot(nb, nc) * lb * lc,
          -dot(na, nd) * la * ld, -dot(na, nc) * la * lc, -dot(na, nb) * la * lb};
}

/// Nearest point of the segment ab to p.
Vec3 closest_point_on_segment(Vec3 p, Vec3 a, Vec3 b);

/// Nearest point of the triangle abc, degenerate or not, to p.
Vec3 closest_point_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace octafront
