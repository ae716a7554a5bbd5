#include "base/geometry/triangle_box.h"

#include <algorithm>
#include <initializer_list>

namespace octafront {

namespace {

// More than the rounding of the few operations on each axis, in units of the largest term.
constexpr double kSlack = 1e-14;

constexpr Vec3 abs(Vec3 a) {
  return {a.x < 0 ? -a.x : a.x, a.y < 0 ? -a.y : a.y, a.z < 0 ? -a.z : a.z};
}

// A box about the origin with half extents h and points that span the other set, projected to an axis.
bool separated(Vec3 axis, Vec3 h, std::initializer_list<Vec3> points) {
  const Vec3 magnitude = abs(axis);
  double lo = std::numeric_limits<double>::infinity(), hi = -lo, largest = 0;
  for (const Vec3& p : points) {
    const double at = dot(axis, p);
    lo = std::min(lo, at);
    hi = std::max(hi, at);
    largest = std::max(largest, dot(magnitude, abs(p)));
  }
  const double reach = dot(magnitude, h) + kSlack * largest;
  return lo > reach || hi < -reach;
}

// The axes perpendicular to an edge u and one coordinate axis each.
bool separated_across(Vec3 u, Vec3 h, std::initializer_list<Vec3> points) {
  return separated({0, -u.z, u.y}, h, points) || separated({u.z, 0, -u.x}, h, points) ||
         separated({-u.y, u.x, 0}, h, points);
}

// Half extents about the rounded centre, grown by what the rounding may have cut off.
Vec3 half_extent(const Box3& box, Vec3 center) {
  const Vec3 h = max(box.hi - center, center - box.lo);
  return h + (abs(box.lo) + abs(box.hi)) * kSlack;
}

}  // namespace

bool triangle_overlaps_box(const TriangleCorners& t, const Box3& box) {
  if (!box_of(t).overlaps(box)) return false;
  for (const Vec3& p : t)
    if (box.contains(p)) return true;
  const Vec3 c = box.center(), h = half_extent(box, c);
  const Vec3 p = t[0] - c, q = t[1] - c, r = t[2] - c;
  if (separated(cross(q - p, r - p), h, {p, q, r})) return false;
  return !separated_across(q - p, h, {p, r}) && !separated_across(r - q, h, {p, q}) &&
         !separated_across(p - r, h, {p, q});
}

bool segment_overlaps_box(Vec3 p, Vec3 q, const Box3& box) {
  if (!Box3{min(p, q), max(p, q)}.overlaps(box)) return false;
  if (box.contains(p) || box.contains(q)) return true;
  const Vec3 c = box.center(), h = half_extent(box, c);
  return !separated_across(q - p, h, {p - c, q - c});
}

}  // namespace octafront
