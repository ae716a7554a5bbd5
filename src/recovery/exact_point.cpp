#include "recovery/exact_point.h"

#include <algorithm>
#include <cmath>

namespace octafront::recovery {

namespace {

BigFloat det2(const BigFloat& a, const BigFloat& b, const BigFloat& c, const BigFloat& d) {
  return a * d - b * c;
}

// The plane (n, k) through three homogeneous points, as the linear form that is zero on it. On (x, y, z, w) with w > 0
// it has the sign of orient3d(a, b, c, .).
Homogeneous plane_through(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c) {
  // Expanded along a: the 2x2 minors of b and c.
  const auto m = [&](int i, int j) { return det2(b[i], b[j], c[i], c[j]); };
  const BigFloat m01 = m(0, 1), m02 = m(0, 2), m03 = m(0, 3), m12 = m(1, 2), m13 = m(1, 3), m23 = m(2, 3);
  return {a[1] * m23 - a[2] * m13 + a[3] * m12, -(a[0] * m23 - a[2] * m03 + a[3] * m02),
          a[0] * m13 - a[1] * m03 + a[3] * m01, -(a[0] * m12 - a[1] * m02 + a[2] * m01)};
}

BigFloat value(const Homogeneous& plane, const Homogeneous& p) {
  return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3] * p[3];
}

double largest(Vec3 a) {
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

// orient3d of points whose coordinates carry a relative error of 2^-50; 0 if that does not decide.
int filtered_orient(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double det = dot(cross(u, v), w);
  const double error = 1.8e-15 * std::max({largest(a), largest(b), largest(c), largest(d)});
  const double p = largest(u) + error, q = largest(v) + error, r = largest(w) + error;
  const double bound = 6.1 * error * (p * q + q * r + r * p) + 1e-14 * p * q * r;
  return det > bound ? 1 : det < -bound ? -1 : 0;
}

}  // namespace

VertexIndex ExactPoints::add(Vec3 p) {
  if (first_steiner_ != kNone) steiner_.emplace_back();
  point_.push_back(p);
  return size() - 1;
}

VertexIndex ExactPoints::add(Homogeneous h) {
  if (h[3].sign() < 0) {
    for (BigFloat& x : h) x = -x;
  }
  if (first_steiner_ == kNone) first_steiner_ = size();
  point_.push_back({quotient(h[0], h[3]), quotient(h[1], h[3]), quotient(h[2], h[3])});
  steiner_.emplace_back(std::make_move_iterator(h.begin()), std::make_move_iterator(h.end()));
  return size() - 1;
}

VertexIndex ExactPoints::add_copy(VertexIndex v) {
  point_.push_back(Vec3(point_[v]));
  if (first_steiner_ != kNone)
    steiner_.push_back(v < first_steiner_ ? MaybeHomogeneous{} : MaybeHomogeneous(steiner_[v - first_steiner_]));
  return size() - 1;
}

void ExactPoints::pop() {
  point_.pop_back();
  if (first_steiner_ != kNone) steiner_.pop_back();
  if (steiner_.empty()) first_steiner_ = kNone;
}

void ExactPoints::move(VertexIndex v, Vec3 p) {
  point_[v] = p;
  if (v >= first_steiner_) steiner_[v - first_steiner_].clear();
}

Homogeneous ExactPoints::homogeneous(VertexIndex v) const {
  if (!is_double(v)) {
    const MaybeHomogeneous& h = steiner_[v - first_steiner_];
    return {h[0], h[1], h[2], h[3]};
  }
  return {BigFloat(point_[v].x), BigFloat(point_[v].y), BigFloat(point_[v].z), BigFloat(1.0)};
}

VertexIndex ExactPoints::add_between(VertexIndex a, VertexIndex b, double t) {
  const Homogeneous p = homogeneous(a), q = homogeneous(b);
  const BigFloat wp = BigFloat(1 - t) * q[3], wq = BigFloat(t) * p[3];
  return add(Homogeneous{wp * p[0] + wq * q[0], wp * p[1] + wq * q[1], wp * p[2] + wq * q[2], p[3] * q[3]});
}

VertexIndex ExactPoints::add_crossing(VertexIndex p, VertexIndex q, VertexIndex a, VertexIndex b, VertexIndex c) {
  const Homogeneous plane = plane_through(homogeneous(a), homogeneous(b), homogeneous(c));
  const Homogeneous hp = homogeneous(p), hq = homogeneous(q);
  const BigFloat dp = value(plane, hp), dq = value(plane, hq);
  Homogeneous h;
  for (int i = 0; i < 4; ++i) h[i] = hp[i] * dq - hq[i] * dp;
  return add(std::move(h));
}

int ExactPoints::orient_steiner(VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) const {
  const std::array<VertexIndex, 4> v{a, b, c, d};
  if (std::ranges::all_of(v, [&](VertexIndex i) { return is_double(i); })) {
    return orient3d(point_[a], point_[b], point_[c], point_[d]);
  }
  if (const int s = filtered_orient(point_[a], point_[b], point_[c], point_[d])) return s;
  return orient_exact(v);
}

int ExactPoints::orient_exact(const std::array<VertexIndex, 4>& v) const {
  return value(plane_through(homogeneous(v[0]), homogeneous(v[1]), homogeneous(v[2])), homogeneous(v[3])).sign();
}

int ExactPoints::orient(VertexIndex a, VertexIndex b, VertexIndex c, Vec3 p) const {
  if (is_double(a) && is_double(b) && is_double(c)) return orient3d(point_[a], point_[b], point_[c], p);
  if (const int s = filtered_orient(point_[a], point_[b], point_[c], p)) return s;
  const Homogeneous last{BigFloat(p.x), BigFloat(p.y), BigFloat(p.z), BigFloat(1.0)};
  return value(plane_through(homogeneous(a), homogeneous(b), homogeneous(c)), last).sign();
}

}  // namespace octafront::recovery
