#include "base/geometry/sight_line.h"

#include "base/geometry/big_float.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octafront {
namespace {

using exact::BigFloat;

/// Side of p, moved by an infinitesimal (e, e^2), to the line from a to b, seen along the axis; 0 only if a and b
/// coincide there.
int side_seen(int axis, Vec3 a, Vec3 b, Vec3 p) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const int s = orient2d(a[u], a[v], b[u], b[v], p[u], p[v]);
  if (s != 0) return s;
  if (a[v] != b[v]) return a[v] > b[v] ? 1 : -1;
  return detail::sign(b[u] - a[u]);
}

/// Where a line along the axis through p crosses the plane of a triangle: height, and how it changes as p moves across,
/// all over the same positive denominator.
struct Height {
  BigFloat over;
  std::array<BigFloat, 3> terms;  ///< at p, per step of p in the next axis, and in the one behind
};

Height height_of(const TriangleCorners& t, Vec3 p, int axis) {
  std::array<BigFloat, 3> e, f;
  for (int i = 0; i < 3; ++i) {
    e[i] = BigFloat(t[1][i]) - BigFloat(t[0][i]);
    f[i] = BigFloat(t[2][i]) - BigFloat(t[0][i]);
  }
  const auto normal = [&](int i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    return e[j] * f[k] - e[k] * f[j];
  };
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  BigFloat n = normal(axis), nu = normal(u), nv = normal(v);
  BigFloat at =
      n * BigFloat(t[0][axis]) + nu * (BigFloat(t[0][u]) - BigFloat(p[u])) + nv * (BigFloat(t[0][v]) - BigFloat(p[v]));
  if (n.sign() < 0) return {-n, {-at, nu, nv}};
  return {n, {at, -nu, -nv}};
}

bool lower(const Height& a, const Height& b) {
  for (int i = 0; i < 3; ++i)
    if (const int sign = (a.terms[i] * b.over - b.terms[i] * a.over).sign(); sign != 0) return sign < 0;
  return false;
}

}  // namespace

std::vector<SightLines::Crossing> SightLines::crossings(Vec3 p, int axis) const {
  Box3 line;
  line.add(p);
  for (const Vec3 end : {tree_.box().lo, tree_.box().hi}) {
    Vec3 q = p;
    q[axis] = end[axis];
    line.add(q);
  }
  struct Found {
    Crossing crossing;
    Height height;
  };
  std::vector<Found> found;
  tree_.for_each_overlapping(line, [&](std::uint32_t t) {
    const TriangleCorners c = corners(t);
    const int ab = side_seen(axis, c[0], c[1], p), bc = side_seen(axis, c[1], c[2], p),
              ca = side_seen(axis, c[2], c[0], p);
    if (ab != 0 && ab == bc && bc == ca) found.push_back({{t, ab > 0}, height_of(c, p, axis)});
  });
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return lower(a.height, b.height); });
  std::vector<Crossing> all;
  for (const Found& f : found) all.push_back(f.crossing);
  return all;
}

std::optional<Side> SightLines::first_side(Vec3 p, int axis) const {
  for (const Crossing& c : crossings(p, axis)) {
    const TriangleCorners t = corners(c.triangle);
    if (orient3d(t[0], t[1], t[2], p) * (c.faces_up ? 1 : -1) < 0) return c.below();
  }
  return std::nullopt;
}

std::optional<SightLines::Line> SightLines::line_through(std::uint32_t triangle) const {
  const TriangleCorners c = corners(triangle);
  const Vec3 n = double_area_normal(c[0], c[1], c[2]), middle = (c[0] + c[1] + c[2]) / 3;
  int axis = std::abs(n.x) >= std::abs(n.y) && std::abs(n.x) >= std::abs(n.z) ? 0
             : std::abs(n.y) >= std::abs(n.z)                                 ? 1
                                                                              : 2;
  for (int tries = 0; tries < 3; ++tries, axis = (axis + 1) % 3) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto side = [&](int i, int j) { return orient2d(c[i][u], c[i][v], c[j][u], c[j][v], middle[u], middle[v]); };
    const int ab = side(0, 1);
    if (ab != 0 && ab == side(1, 2) && ab == side(2, 0)) return Line{middle, axis};
  }
  return std::nullopt;
}

}  // namespace octafront
