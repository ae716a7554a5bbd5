#include "cad/shapes/nearest_on.h"

#include "base/core/elementary.h"
#include "cad/shapes/nurbs.h"

#include <algorithm>
#include <cmath>

namespace octafront::cad {

namespace {

/// Iterations end when a step is shorter than this part of what lies between the seed and p, or of the coordinates.
constexpr double kLastStep = 1e-13;
/// A step this short is believed: squares of distances are too coarse to tell.
constexpr double kBelieved = 1e-6;
constexpr int kMostSteps = 30, kMostHalvings = 20;

/// Coordinates in a frame.
Vec3 into(const Frame& f, Vec3 p) {
  const Vec3 d = p - f.origin;
  return {dot(d, f.x), dot(d, f.y), dot(d, f.z)};
}
Vec3 out_of(const Frame& f, Vec3 q) {
  return f.origin + q.x * f.x + q.y * f.y + q.z * f.z;
}

/// The unit vector from the axis to q, across it; where q lies on the axis that of the seed.
struct Across {
  double x = 1, y = 0, length = 0;
};
Across across(Vec3 q, Vec3 seed) {
  const double l = std::sqrt(q.x * q.x + q.y * q.y);
  if (l > 0) return {q.x / l, q.y / l, l};
  const double s = std::sqrt(seed.x * seed.x + seed.y * seed.y);
  return s > 0 ? Across{seed.x / s, seed.y / s, 0} : Across{};
}

Vec3 on_cylinder(double radius, Vec3 q, Vec3 seed) {
  const Across a = across(q, seed);
  return {radius * a.x, radius * a.y, q.z};
}

/// On the nappe of the seed; the apex where that is nearer than all of the nappe.
Vec3 on_cone(const SurfaceRecord& s, Vec3 q, Vec3 seed) {
  const double sine = elementary::sin(s.minor), cosine = elementary::cos(s.minor);
  const double apex = -s.radius * cosine / sine;  // its z
  const bool above = (seed.z - apex) * sine * cosine >= 0;
  const Across a = across(q, seed);
  // In the half-plane through q: the line from the apex, the way that its nappe opens.
  const double along_r = std::abs(sine), along_z = (above == (sine > 0) ? 1 : -1) * std::abs(cosine);
  const double t = std::max(0.0, a.length * along_r + (q.z - apex) * along_z);
  return {t * along_r * a.x, t * along_r * a.y, apex + t * along_z};
}

Vec3 on_sphere(double radius, Vec3 q, Vec3 seed) {
  const double l = length(q);
  const Vec3 to = l > 0 ? q / l : normalized(seed);
  return radius * to;
}

/// A torus that meets itself on its axis has an inner sheet too, of circles about centres on the other side of it:
/// whether that of the seed is this one.
bool is_inner(const SurfaceRecord& s, Vec3 seed) {
  if (s.minor <= s.radius) return false;
  const double r = across(seed, {}).length;
  const double outer = elementary::hypot(r - s.radius, seed.z) - s.minor,
               inner = elementary::hypot(r + s.radius, seed.z) - s.minor;
  return std::abs(inner) < std::abs(outer);
}

Vec3 on_torus(const SurfaceRecord& s, Vec3 q, Vec3 seed) {
  const Across a = across(q, seed);
  const double radius = is_inner(s, seed) ? -s.radius : s.radius;
  const Vec3 centre{radius * a.x, radius * a.y, 0};
  Vec3 to = q - centre;
  if (length(to) == 0) to = seed - centre;
  return centre + s.minor * normalized(to);
}

/// A parameter within the knots: periods are taken off, or it is clamped.
double within(double t, double first, double last, double period) {
  if (period > 0) {
    if (!std::isfinite(t)) return first;
    if (t < first || t > last) t -= period * std::floor((t - first) / period);
  }
  return std::clamp(t, first, last);
}

/// Newton's iteration for the nearest point of a B-spline surface. Where the matrix of second derivatives is not
/// positive, that of first derivatives stands in (Gauss-Newton); a step that leads away is halved.
class SurfaceSearch {
 public:
  SurfaceSearch(const SurfaceRecord& surface, Vec3 p) : surface_(surface), p_(p) {}

  std::optional<Vec3> from(Uv at) {
    at = clamped(at);
    SurfaceJet here = jet(surface_, at);
    const double scale = length(here.p) + length(p_) + length(here.p - p_);
    for (int step = 0; step < kMostSteps; ++step) {
      const Uv by = step_at(here, at);
      const double moved = length(by.u * here.u + by.v * here.v);
      if (!(moved > kLastStep * scale)) break;
      if (!go(at, here, by, moved < kBelieved * scale)) break;
    }
    return here.p;
  }

 private:
  Uv clamped(Uv at) const {
    return {within(at.u, surface_.u_knots.first(), surface_.u_knots.last(), surface_.u_period),
            within(at.v, surface_.v_knots.first(), surface_.v_knots.last(), surface_.v_period)};
  }

  /// Whether the way along a parameter is barred by an end of it.
  static bool is_barred(double t, double gradient, const Knots& k, double period) {
    if (period > 0) return false;
    return (t <= k.first() && gradient > 0) || (t >= k.last() && gradient < 0);
  }

  Uv step_at(const SurfaceJet& s, Uv at) const {
    const Vec3 r = s.p - p_;
    const double gu = dot(r, s.u), gv = dot(r, s.v);
    const bool no_u = is_barred(at.u, gu, surface_.u_knots, surface_.u_period) || squared_length(s.u) == 0;
    const bool no_v = is_barred(at.v, gv, surface_.v_knots, surface_.v_period) || squared_length(s.v) == 0;
    const double uu = dot(s.u, s.u), uv = dot(s.u, s.v), vv = dot(s.v, s.v);
    const double huu = uu + dot(r, s.uu), huv = uv + dot(r, s.uv), hvv = vv + dot(r, s.vv);
    if (no_u && no_v) return {};
    if (no_u) return {0, -gv / (hvv > 0 ? hvv : vv)};
    if (no_v) return {-gu / (huu > 0 ? huu : uu), 0};
    if (const double det = huu * hvv - huv * huv; huu > 0 && det > 0)
      return {(huv * gv - hvv * gu) / det, (huv * gu - huu * gv) / det};
    if (const double det = uu * vv - uv * uv; det > 0) return {(uv * gv - vv * gu) / det, (uv * gu - uu * gv) / det};
    return {-gu / uu, -gv / vv};
  }

  /// Goes there, or a part of the way; false if no part of it leads nearer.
  bool go(Uv& at, SurfaceJet& here, Uv by, bool believed) const {
    const double now = squared_length(here.p - p_);
    for (int k = 0; k < kMostHalvings; ++k) {
      const Uv to = clamped({at.u + by.u, at.v + by.v});
      const SurfaceJet there = jet(surface_, to);
      if (believed || squared_length(there.p - p_) < now) {
        at = to, here = there;
        return true;
      }
      by.u *= 0.5, by.v *= 0.5;
    }
    return false;
  }

  const SurfaceRecord& surface_;
  Vec3 p_;
};

std::optional<Vec3> nearest_on_spline(const CurveRecord& curve, double t, Vec3 p) {
  const double first = curve.knots.first(), last = curve.knots.last();
  t = std::clamp(t, first, last);
  CurveJet here = jet(curve, t);
  const double scale = length(here.p) + length(p) + length(here.p - p);
  for (int step = 0; step < kMostSteps; ++step) {
    const Vec3 r = here.p - p;
    const double g = dot(r, here.d), dd = dot(here.d, here.d), h = dd + dot(r, here.dd);
    if ((t <= first && g > 0) || (t >= last && g < 0) || dd == 0) break;
    double by = -g / (h > 0 ? h : dd);
    const double moved = std::abs(by) * length(here.d);
    if (!(moved > kLastStep * scale)) break;
    const double now = squared_length(r);
    bool gone = false;
    for (int k = 0; k < kMostHalvings && !gone; ++k, by *= 0.5) {
      const double to = std::clamp(t + by, first, last);
      const CurveJet there = jet(curve, to);
      gone = moved < kBelieved * scale || squared_length(there.p - p) < now;
      if (gone) t = to, here = there;
    }
    if (!gone) break;
  }
  return here.p;
}

/// By Newton's iteration on the unit circle: (c, s) stands for the angle, so that no angle need be known.
Vec3 on_ellipse(const CurveRecord& curve, Vec3 q, Vec3 seed) {
  const double a = curve.radius, b = curve.minor;
  double c = seed.x / a, s = seed.y / b;
  const double l = std::sqrt(c * c + s * s);
  if (!(l > 0)) return seed;
  c /= l, s /= l;
  for (int step = 0; step < kMostSteps; ++step) {
    const double rx = a * c - q.x, ry = b * s - q.y;
    const double g = -rx * a * s + ry * b * c;
    const double speed = a * a * s * s + b * b * c * c, h = speed - rx * a * c - ry * b * s;
    const double by = std::clamp(-g / (h > 0 ? h : speed), -0.5, 0.5);
    const double x = c - s * by, y = s + c * by, n = std::sqrt(x * x + y * y);
    c = x / n, s = y / n;
    if (std::abs(by) < kLastStep) break;
  }
  return {a * c, b * s, 0};
}

}  // namespace

std::optional<Vec3> nearest_on(const SurfaceRecord& surface, const SurfaceSeed& seed, Vec3 p) {
  using Kind = SurfaceRecord::Kind;
  if (surface.kind == Kind::kNone) return std::nullopt;
  if (surface.kind == Kind::kNurbs) return SurfaceSearch(surface, p).from(seed.at);
  const Vec3 q = into(surface.frame, p), from = into(surface.frame, seed.p);
  switch (surface.kind) {
    case Kind::kPlane:
      return out_of(surface.frame, {q.x, q.y, 0});
    case Kind::kCylinder:
      return out_of(surface.frame, on_cylinder(surface.radius, q, from));
    case Kind::kCone:
      return out_of(surface.frame, on_cone(surface, q, from));
    case Kind::kSphere:
      return out_of(surface.frame, on_sphere(surface.radius, q, from));
    default:
      return out_of(surface.frame, on_torus(surface, q, from));
  }
}

std::optional<Vec3> nearest_on(const CurveRecord& curve, const CurveSeed& seed, Vec3 p) {
  using Kind = CurveRecord::Kind;
  if (curve.kind == Kind::kNone) return std::nullopt;
  if (curve.kind == Kind::kNurbs) return nearest_on_spline(curve, seed.at, p);
  const Vec3 q = into(curve.frame, p), from = into(curve.frame, seed.p);
  switch (curve.kind) {
    case Kind::kLine:
      return out_of(curve.frame, {q.x, 0, 0});
    case Kind::kCircle: {
      const Across a = across(q, from);
      return out_of(curve.frame, {curve.radius * a.x, curve.radius * a.y, 0});
    }
    default:
      return out_of(curve.frame, on_ellipse(curve, q, from));
  }
}

}  // namespace octafront::cad
