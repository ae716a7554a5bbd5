#pragma once

// Slow, obviously exact answers for points on a small integer lattice: a triangle is clipped as a polygon of rational
// points against half-spaces, in 128-bit integers. Nothing here is shared with the code under test.

#include <octafront/vec.h>

#include <array>
#include <numeric>
#include <vector>

namespace octafront::testing {

__extension__ typedef __int128 Int;

/// (x, y, z) / w with w > 0, in lowest terms.
struct RationalPoint {
  Int x, y, z, w;
  friend bool operator==(const RationalPoint&, const RationalPoint&) = default;
};

inline RationalPoint rational(Vec3 p) {
  return {static_cast<Int>(p.x), static_cast<Int>(p.y), static_cast<Int>(p.z), 1};
}

inline Int gcd(Int a, Int b) {
  a = a < 0 ? -a : a;
  b = b < 0 ? -b : b;
  while (b != 0) {
    const Int r = a % b;
    a = b;
    b = r;
  }
  return a;
}

inline RationalPoint lowest_terms(RationalPoint p) {
  const Int g = gcd(gcd(p.x, p.y), gcd(p.z, p.w));
  return {p.x / g, p.y / g, p.z / g, p.w / g};
}

/// The half-space n . x >= c, integers.
struct HalfSpace {
  std::array<Int, 3> n;
  Int c;
  Int at(const RationalPoint& p) const { return n[0] * p.x + n[1] * p.y + n[2] * p.z - c * p.w; }
};

inline std::array<Int, 3> integer(Vec3 a) {
  return {static_cast<Int>(a.x), static_cast<Int>(a.y), static_cast<Int>(a.z)};
}

inline std::array<Int, 3> cross(const std::array<Int, 3>& a, const std::array<Int, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline HalfSpace half_space(const std::array<Int, 3>& n, Vec3 through) {
  const auto p = integer(through);
  return {n, n[0] * p[0] + n[1] * p[1] + n[2] * p[2]};
}

inline std::vector<RationalPoint> clipped(const std::vector<RationalPoint>& polygon, const HalfSpace& h) {
  std::vector<RationalPoint> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RationalPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Int hp = h.at(p), hq = h.at(q);
    if (hp >= 0) kept.push_back(p);
    if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) {
      const Int s = hp > 0 ? hp : -hp, t = hq > 0 ? hq : -hq;
      kept.push_back(lowest_terms({p.x * t + q.x * s, p.y * t + q.y * s, p.z * t + q.z * s, p.w * t + q.w * s}));
    }
  }
  return kept;
}

/// Corners of the intersection of a convex polygon (or segment, or point) with a triangle that is not degenerate.
inline std::vector<RationalPoint> intersection_with_triangle(std::vector<RationalPoint> polygon,
                                                             const std::array<Vec3, 3>& t) {
  const auto n = cross(integer(t[1] - t[0]), integer(t[2] - t[0]));
  polygon = clipped(polygon, half_space(n, t[0]));
  polygon = clipped(polygon, half_space({-n[0], -n[1], -n[2]}, t[0]));
  for (int i = 0; i < 3; ++i) polygon = clipped(polygon, half_space(cross(n, integer(t[(i + 1) % 3] - t[i])), t[i]));
  return polygon;
}

/// True if p lies on the closed segment ab.
inline bool on_segment(const RationalPoint& p, Vec3 a, Vec3 b) {
  const auto ia = integer(a), ab = integer(b - a);
  const std::array<Int, 3> ap{p.x - ia[0] * p.w, p.y - ia[1] * p.w, p.z - ia[2] * p.w};
  const auto c = cross(ab, ap);
  const Int along = ab[0] * ap[0] + ab[1] * ap[1] + ab[2] * ap[2];
  const Int whole = ab[0] * ab[0] + ab[1] * ab[1] + ab[2] * ab[2];
  if (whole == 0) return ap == std::array<Int, 3>{0, 0, 0};
  return c == std::array<Int, 3>{0, 0, 0} && along >= 0 && along <= whole * p.w;
}

}  // namespace octafront::testing
