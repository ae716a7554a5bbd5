#include "fill/recovery/exact_points.h"

#include "base/geometry/double_double.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace octafront::recovery {

namespace {

using exact::det2;
using exact::kRounded;
using exact::plane_through;
using exact::value;

double largest(Vec3 a) {
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

// orient3d of points whose coordinates carry a relative error of 2^-50; 0 if that does not decide.
int filtered_orient(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double det = dot(cross(u, v), w);
  const double error = kRounded * std::max({largest(a), largest(b), largest(c), largest(d)});
  const double p = largest(u) + error, q = largest(v) + error, r = largest(w) + error;
  const double bound = 6.1 * error * (p * q + q * r + r * p) + 1e-14 * p * q * r;
  return det > bound ? 1 : det < -bound ? -1 : 0;
}

using exact::DoubleDouble;
using DoublePoint = std::array<DoubleDouble, 3>;

DoublePoint two_doubles(Vec3 p, Vec3 rest) {
  DoublePoint sum;
  for (int k = 0; k < 3; ++k) sum[k] = exact::TwoDoubles{p[k], rest[k]};
  return sum;
}

double largest(const DoublePoint& p) {
  return std::max({std::abs(p[0].hi), std::abs(p[1].hi), std::abs(p[2].hi)});
}

// orient3d of points whose coordinates have a relative error of 2^-99; 0 if that does not decide. The bounds are those
// of filtered_orient with 2^-95 for 2^-50: room for the errors of DoubleDouble.
int filtered_orient(const std::array<DoublePoint, 4>& p) {
  std::array<DoublePoint, 3> d;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) d[i][k] = p[i + 1][k] - p[0][k];
  }
  const auto minor = [&](int i, int j) { return d[1][i] * d[2][j] - d[1][j] * d[2][i]; };
  const DoubleDouble det = d[0][0] * minor(1, 2) + d[0][1] * minor(2, 0) + d[0][2] * minor(0, 1);
  const double error = 0x1p-94 * std::max({largest(p[0]), largest(p[1]), largest(p[2]), largest(p[3])});
  const double u = largest(d[0]) + error, v = largest(d[1]) + error, w = largest(d[2]) + error;
  const double bound = 6.1 * error * (u * v + v * w + w * u) + 0x1p-90 * u * v * w;
  return det.hi > bound ? 1 : det.hi < -bound ? -1 : 0;
}

}  // namespace

VertexIndex ExactPoints::add(Vec3 p) {
  if (first_steiner_ != kNone) steiner_.emplace_back();
  point_.push_back(p);
  return size() - 1;
}

VertexIndex ExactPoints::add(Homogeneous h, std::vector<std::uint32_t> planes) {
  h = exact::with_positive_weight(std::move(h));
  if (first_steiner_ == kNone) first_steiner_ = size();
  const Vec3 p = exact::rounded(h);
  Vec3 rest;
  for (int i = 0; i < 3; ++i) rest[i] = quotient(h[i] - h[3] * BigFloat(p[i]), h[3]);
  point_.push_back(p);
  steiner_.push_back({{h.begin(), h.end()}, rest, std::move(planes), {}});
  steiner_.back().lines.fill({kNone, kNone});
  return size() - 1;
}

VertexIndex ExactPoints::add_copy(VertexIndex v) {
  point_.push_back(Vec3(point_[v]));
  if (first_steiner_ != kNone)
    steiner_.push_back(v < first_steiner_ ? Steiner{} : Steiner(steiner_[v - first_steiner_]));
  return size() - 1;
}

void ExactPoints::set_planes(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& plane) {
  plane_of_triangle_ = plane;
  planes_at_ = {point_.size(), [&](const auto& add) {
                  for (std::size_t f = 0; f < triangles.size(); ++f)
                    for (const VertexIndex v : triangles[f]) add(v, plane[f]);
                }};
  for (std::size_t v = 0; v < planes_at_.size(); ++v) std::ranges::sort(planes_at_[v]);
}

void ExactPoints::add_plane(VertexIndex v, std::uint32_t plane) {
  std::vector<std::uint32_t>& planes = steiner_[v - first_steiner_].planes;
  planes.insert(std::ranges::lower_bound(planes, plane), plane);
}

ExactPoints::Planes ExactPoints::planes_of(VertexIndex v) const {
  if (v >= first_steiner_) return steiner_[v - first_steiner_].planes;
  return v < planes_at_.size() ? planes_at_[v] : Planes{};
}

std::vector<std::uint32_t> ExactPoints::shared_planes(VertexIndex a, VertexIndex b) const {
  std::vector<std::uint32_t> shared;
  std::ranges::set_intersection(planes_of(a), planes_of(b), std::back_inserter(shared));
  shared.erase(std::unique(shared.begin(), shared.end()), shared.end());
  return shared;
}

// Three of the four on the line of a Steiner point.
bool ExactPoints::share_line(const std::array<VertexIndex, 4>& v) const {
  const auto on = [&](VertexIndex u, const Edge& line) {
    // An end that has moved off is a double point now.
    if (u == line[0] || u == line[1]) return u < first_steiner_ || !is_double(u);
    return u >= first_steiner_ && std::ranges::count(steiner_[u - first_steiner_].lines, line) > 0;
  };
  for (const VertexIndex u : v) {
    if (is_double(u)) continue;
    for (const Edge& line : steiner_[u - first_steiner_].lines) {
      if (line[0] == kNone) continue;
      if (std::ranges::count_if(v, [&](VertexIndex w) { return on(w, line); }) >= 3) return true;
    }
  }
  return false;
}

bool ExactPoints::share_plane(const std::array<VertexIndex, 4>& v) const {
  std::array<Planes, 4> planes;
  for (int i = 0; i < 4; ++i) {
    planes[i] = planes_of(v[i]);
    if (planes[i].empty()) return false;
    if (planes[i].size() < planes[0].size()) std::swap(planes[i], planes[0]);
  }
  return std::ranges::any_of(planes[0], [&](std::uint32_t p) {
    return std::all_of(planes.begin() + 1, planes.end(), [p](Planes s) { return std::ranges::binary_search(s, p); });
  });
}

void ExactPoints::pop() {
  point_.pop_back();
  if (first_steiner_ != kNone) steiner_.pop_back();
  if (steiner_.empty()) first_steiner_ = kNone;
}

void ExactPoints::move(VertexIndex v, Vec3 p) {
  point_[v] = p;
  if (v >= first_steiner_) steiner_[v - first_steiner_] = {};
}

Homogeneous ExactPoints::homogeneous(VertexIndex v) const {
  if (!is_double(v)) {
    const std::vector<BigFloat>& h = steiner_[v - first_steiner_].coordinate;
    return {h[0], h[1], h[2], h[3]};
  }
  return exact::homogeneous(point_[v]);
}

std::size_t ExactPoints::words(VertexIndex v) const {
  std::size_t most = 1;
  if (!is_double(v))
    for (const BigFloat& x : steiner_[v - first_steiner_].coordinate) most = std::max(most, x.words());
  return most;
}

VertexIndex ExactPoints::add_between(VertexIndex a, VertexIndex b, double t) {
  const Homogeneous p = homogeneous(a), q = homogeneous(b);
  const BigFloat wp = BigFloat(1 - t) * q[3], wq = BigFloat(t) * p[3];
  const VertexIndex s =
      add(Homogeneous{wp * p[0] + wq * q[0], wp * p[1] + wq * q[1], wp * p[2] + wq * q[2], p[3] * q[3]},
          shared_planes(a, b));
  steiner_.back().lines[0] = {a, b};
  return s;
}

VertexIndex ExactPoints::add_crossing(VertexIndex p, VertexIndex q, VertexIndex a, VertexIndex b, VertexIndex c) {
  const Homogeneous plane = plane_through(homogeneous(a), homogeneous(b), homogeneous(c));
  const VertexIndex s = add(exact::line_meets_plane(homogeneous(p), homogeneous(q), plane), shared_planes(p, q));
  steiner_.back().lines[0] = {p, q};
  return s;
}

VertexIndex ExactPoints::add_crossing(VertexIndex p, VertexIndex q, VertexIndex x, VertexIndex y) {
  const Homogeneous hp = homogeneous(p), hq = homogeneous(q), hx = homogeneous(x), hy = homogeneous(y);
  // Seen along an axis in which the two lines do not coincide, (x, y) is the linear form l.
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const std::array<BigFloat, 3> l{det2(hx[v], hx[3], hy[v], hy[3]), -det2(hx[u], hx[3], hy[u], hy[3]),
                                    det2(hx[u], hx[v], hy[u], hy[v])};
    const BigFloat dp = l[0] * hp[u] + l[1] * hp[v] + l[2] * hp[3], dq = l[0] * hq[u] + l[1] * hq[v] + l[2] * hq[3];
    if (dp.sign() * dq.sign() >= 0) continue;
    const VertexIndex s = add(exact::zero_between(hp, dp, hq, dq), shared_planes(p, q));
    steiner_.back().lines = {Edge{p, q}, Edge{x, y}};
    return s;
  }
  throw std::logic_error("two segments that should cross do not");
}

int ExactPoints::orient_steiner(VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) const {
  const std::array<VertexIndex, 4> v{a, b, c, d};
  if (std::ranges::all_of(v, [&](VertexIndex i) { return is_double(i); })) {
    return orient3d(point_[a], point_[b], point_[c], point_[d]);
  }
  if (const int s = filtered_orient(point_[a], point_[b], point_[c], point_[d])) return s;
  if (share_line(v) || share_plane(v)) return 0;
  if (const int s = filtered_orient({two_doubles(point_[a], rest_of(a)), two_doubles(point_[b], rest_of(b)),
                                     two_doubles(point_[c], rest_of(c)), two_doubles(point_[d], rest_of(d))}))
    return s;
  return orient_exact(v);
}

int ExactPoints::orient_exact(const std::array<VertexIndex, 4>& v) const {
  return value(plane_through(homogeneous(v[0]), homogeneous(v[1]), homogeneous(v[2])), homogeneous(v[3])).sign();
}

int ExactPoints::orient(VertexIndex a, VertexIndex b, VertexIndex c, Vec3 p) const {
  if (is_double(a) && is_double(b) && is_double(c)) return orient3d(point_[a], point_[b], point_[c], p);
  if (const int s = filtered_orient(point_[a], point_[b], point_[c], p)) return s;
  if (const int s = filtered_orient({two_doubles(point_[a], rest_of(a)), two_doubles(point_[b], rest_of(b)),
                                     two_doubles(point_[c], rest_of(c)), two_doubles(p, {})}))
    return s;
  return value(plane_through(homogeneous(a), homogeneous(b), homogeneous(c)), exact::homogeneous(p)).sign();
}

}  // namespace octafront::recovery
