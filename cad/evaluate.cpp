#include "evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octafront::cad {

namespace {

/// The basis functions that are not zero at t: those of poles first, first + 1, ... (Piegl, Tiller, "The NURBS Book",
/// A2.2.)
struct Basis {
  std::size_t first = 0, count = 0;
  std::array<double, 32> values{};  // OpenCASCADE's degrees end at 25
};

Basis basis_at(const Knots& knots, double t) {
  const std::size_t p = knots.degree, n = knots.poles();
  const std::vector<double>& k = knots.knots;
  t = std::clamp(t, knots.first(), knots.last());
  const auto above =
      std::upper_bound(k.begin() + static_cast<std::ptrdiff_t>(p), k.begin() + static_cast<std::ptrdiff_t>(n), t);
  const std::size_t span = static_cast<std::size_t>(above - k.begin()) - 1;
  Basis out{span - p, p + 1, {}};
  std::array<double, 32> left{}, right{};
  out.values[0] = 1;
  for (std::size_t j = 1; j <= p; ++j) {
    left[j] = t - k[span + 1 - j], right[j] = k[span + j] - t;
    double saved = 0;
    for (std::size_t r = 0; r < j; ++r) {
      const double part = out.values[r] / (right[r + 1] + left[j - r]);
      out.values[r] = saved + right[r + 1] * part;
      saved = left[j - r] * part;
    }
    out.values[j] = saved;
  }
  return out;
}

Vec3 on_circle(const Frame& f, double radius, double minor, double t) {
  return f.x * (radius * std::cos(t)) + f.y * (minor * std::sin(t));
}

Vec3 nurbs_point(const CurveRecord& c, double t) {
  const Basis b = basis_at(c.knots, t);
  Vec3 sum;
  double weight = 0;
  for (std::size_t i = 0; i < b.count; ++i) {
    const double w = b.values[i] * (c.weights.empty() ? 1 : c.weights[b.first + i]);
    sum += c.poles[b.first + i] * w, weight += w;
  }
  return sum / weight;
}

Vec3 nurbs_point(const SurfaceRecord& s, Uv at) {
  const Basis u = basis_at(s.u_knots, wrapped(at.u, s.u_knots, s.u_period)),
              v = basis_at(s.v_knots, wrapped(at.v, s.v_knots, s.v_period));
  Vec3 sum;
  double weight = 0;
  for (std::size_t i = 0; i < u.count; ++i)
    for (std::size_t j = 0; j < v.count; ++j) {
      const std::size_t pole = (u.first + i) * s.v_knots.poles() + v.first + j;
      const double w = u.values[i] * v.values[j] * (s.weights.empty() ? 1 : s.weights[pole]);
      sum += s.poles[pole] * w, weight += w;
    }
  return sum / weight;
}

}  // namespace

double wrapped(double t, const Knots& knots, double period) {
  if (period <= 0 || (t >= knots.first() && t <= knots.last())) return t;
  return t - period * std::floor((t - knots.first()) / period);
}

Vec3 point_of(const CurveRecord& c, double t) {
  switch (c.kind) {
    case CurveRecord::Kind::kLine:
      return c.frame.origin + c.frame.x * t;
    case CurveRecord::Kind::kCircle:
      return c.frame.origin + on_circle(c.frame, c.radius, c.radius, t);
    case CurveRecord::Kind::kEllipse:
      return c.frame.origin + on_circle(c.frame, c.radius, c.minor, t);
    case CurveRecord::Kind::kNurbs:
      return nurbs_point(c, t);
    case CurveRecord::Kind::kNone:
      break;
  }
  return {};
}

Vec3 point_of(const SurfaceRecord& s, Uv at) {
  const Frame& f = s.frame;
  const auto around = [&](double radius) { return on_circle(f, radius, radius, at.u); };
  switch (s.kind) {
    case SurfaceRecord::Kind::kPlane:
      return f.origin + f.x * at.u + f.y * at.v;
    case SurfaceRecord::Kind::kCylinder:
      return f.origin + around(s.radius) + f.z * at.v;
    case SurfaceRecord::Kind::kCone:
      return f.origin + around(s.radius + at.v * std::sin(s.minor)) + f.z * (at.v * std::cos(s.minor));
    case SurfaceRecord::Kind::kSphere:
      return f.origin + around(s.radius * std::cos(at.v)) + f.z * (s.radius * std::sin(at.v));
    case SurfaceRecord::Kind::kTorus:
      return f.origin + around(s.radius + s.minor * std::cos(at.v)) + f.z * (s.minor * std::sin(at.v));
    case SurfaceRecord::Kind::kNurbs:
      return nurbs_point(s, at);
    case SurfaceRecord::Kind::kNone:
      break;
  }
  return {};
}

}  // namespace octafront::cad
