
#include "base/core/elementary.h"
#include "base/geometry/frame.h"
#include "base/geometry/symmetric_matrix.h"
#include "formats/jobs/job_plan.h"

#include <algorithm>
#include <cmath>

namespace octafront::io {
namespace {

/// Corners may be so far from the cylinder, of its radius: those of facets lie on it but for rounding in files.
constexpr double kOffCylinder = 0.02;

/// The direction in which the sum is least, by inverse iteration: a cylinder's normals have nothing along its axis.
Vec3 least_direction(const SymmetricMatrix& sum) {
  constexpr int kSteps = 40;
  const Vec3 columns[3]{{sum.xx, sum.xy, sum.xz}, {sum.xy, sum.yy, sum.yz}, {sum.xz, sum.yz, sum.zz}};
  // Across two of its columns, so not across the axis.
  Vec3 axis{};
  for (int i = 0; i < 3; ++i)
    if (const Vec3 across = cross(columns[i], columns[(i + 1) % 3]); squared_length(across) > squared_length(axis))
      axis = across;
  for (int step = 0; step < kSteps && squared_length(axis) > 0; ++step)
    axis = sum.damped_solve(normalized(axis), 1e-9 * sum.trace());
  return squared_length(axis) > 0 ? normalized(axis) : Vec3{};
}

/// Whether normals go around the axis: the matrix without it has two sizable eigenvalues.
bool goes_around(const SymmetricMatrix& sum, Vec3 axis) {
  constexpr double kAlong = 0.01, kLeastShare = 0.02;
  const double trace = sum.trace();
  const double minors =
      sum.xx * sum.yy - sum.xy * sum.xy + sum.xx * sum.zz - sum.xz * sum.xz + sum.yy * sum.zz - sum.yz * sum.yz;
  return dot(axis, sum.times(axis)) < kAlong * trace && minors > kLeastShare * trace * trace;
}

/// The circle through points of a plane, by least squares: x^2 + y^2 = 2 a x + 2 b y + c.
Vec3 circle_through(std::span<const Vec3> points) {
  SymmetricMatrix sum;
  Vec3 right{};
  for (const Vec3& p : points) {
    const Vec3 row{2 * p.x, 2 * p.y, 1};
    sum.add(row, 1);
    right = right + row * (p.x * p.x + p.y * p.y);
  }
  const Vec3 abc = sum.damped_solve(right, 0);
  return {abc.x, abc.y, std::sqrt(std::max(0.0, abc.z + abc.x * abc.x + abc.y * abc.y))};
}

/// How an axis leans, by what is left of the distances of points from it: along `u` and `v` for a step along it.
Vec3 lean(std::span<const Vec3> points, Vec3 circle, double middle) {
  SymmetricMatrix sum;
  Vec3 right{};
  for (const Vec3& p : points) {
    const double x = p.x - circle.x, y = p.y - circle.y, distance = elementary::hypot(x, y),
                 along = (p.z - middle) / distance;
    if (!(distance > 0)) continue;
    const Vec3 row{x * along, y * along, 1};
    sum.add(row, 1);
    right = right + row * (distance - circle.z);
  }
  return sum.damped_solve(right, 0);
}

/// By points that lie on it: the normals of facets tell an axis to a thousandth alone.
Cylinder fitted(std::span<const Vec3> points, Vec3 axis) {
  constexpr int kRounds = 20;
  std::vector<Vec3> local(points.size());
  Cylinder fit;
  for (int round = 0; round < kRounds; ++round) {
    const Frame frame = frame_at(points[0], axis);
    std::ranges::transform(points, local.begin(), [&](Vec3 p) { return frame.local(p); });
    const auto [low, high] = std::ranges::minmax(local, {}, &Vec3::z);
    const Vec3 circle = circle_through(local);
    const double along = (low.z + high.z) / 2;
    fit = {frame.origin + frame.u * circle.x + frame.v * circle.y + axis * along, axis, circle.z, (high.z - low.z) / 2};
    const Vec3 leans = lean(local, circle, along);
    axis = normalized(axis + frame.u * leans.x + frame.v * leans.y);
  }
  return fit;
}

double distance_from_axis(const Cylinder& c, Vec3 p) {
  return length(cross(p - c.middle, c.axis));
}

}  // namespace

std::optional<Cylinder> cylinder_of(std::span<const std::array<Vec3, 3>> triangles) {
  SymmetricMatrix normals;
  std::vector<Vec3> corners;
  for (const auto& t : triangles) {
    const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
    if (const double size = length(n); size > 0) normals.add(n / size, size);
    corners.insert(corners.end(), t.begin(), t.end());
  }
  if (corners.empty()) return std::nullopt;
  const Vec3 axis = least_direction(normals);
  if (squared_length(axis) == 0 || !goes_around(normals, axis)) return std::nullopt;
  const Cylinder fit = fitted(corners, axis);
  const auto is_off = [&](Vec3 p) {
    return !(std::abs(distance_from_axis(fit, p) - fit.radius) < kOffCylinder * fit.radius);
  };
  if (std::ranges::any_of(corners, is_off)) return std::nullopt;
  return fit;
}

Vec3 in_system_of(const Cylinder& cylinder, Vec3 at, Vec3 vector) {
  const Vec3 from = at - cylinder.middle;
  const Vec3 radial = normalized(from - cylinder.axis * dot(from, cylinder.axis));
  return {dot(vector, radial), dot(vector, cross(cylinder.axis, radial)), dot(vector, cylinder.axis)};
}

bool share_axis(const Cylinder& a, const Cylinder& b) {
  return length(cross(a.axis, b.axis)) < kOffCylinder &&
         distance_from_axis(a, b.middle) < kOffCylinder * std::max(a.radius, b.radius);
}

}  // namespace octafront::io
