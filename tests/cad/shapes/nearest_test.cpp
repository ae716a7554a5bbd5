#include "cad/shapes/nearest_on.h"
#include "cad/shapes/nurbs.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

constexpr double kPi = std::numbers::pi;

SurfaceRecord analytic(SurfaceRecord::Kind kind, double radius, double minor) {
  SurfaceRecord s;
  s.kind = kind, s.radius = radius, s.minor = minor;
  s.frame = {{1, -2, 3}, {0, 0.6, 0.8}, {0, -0.8, 0.6}, {1, 0, 0}};
  return s;
}

Vec3 out_of(const Frame& f, Vec3 q) {
  return f.origin + q.x * f.x + q.y * f.y + q.z * f.z;
}

/// By the formulas of SurfaceRecord.
Vec3 point_of(const SurfaceRecord& s, double u, double v) {
  using Kind = SurfaceRecord::Kind;
  const double c = std::cos(u), n = std::sin(u);
  switch (s.kind) {
    case Kind::kPlane:
      return out_of(s.frame, {u, v, 0});
    case Kind::kCylinder:
      return out_of(s.frame, {s.radius * c, s.radius * n, v});
    case Kind::kCone: {
      const double r = s.radius + v * std::sin(s.minor);
      return out_of(s.frame, {r * c, r * n, v * std::cos(s.minor)});
    }
    case Kind::kSphere:
      return out_of(s.frame, {s.radius * std::cos(v) * c, s.radius * std::cos(v) * n, s.radius * std::sin(v)});
    default: {
      const double r = s.radius + s.minor * std::cos(v);
      return out_of(s.frame, {r * c, r * n, s.minor * std::sin(v)});
    }
  }
}

/// Off the surface along its normal: back comes the point that was left.
void expect_found_again(const SurfaceRecord& s, double u, double v, double off) {
  const Vec3 p = point_of(s, u, v);
  const double h = 1e-5;
  const Vec3 du = point_of(s, u + h, v) - point_of(s, u - h, v), dv = point_of(s, u, v + h) - point_of(s, u, v - h);
  const Vec3 n = normalized(cross(du, dv));
  const Vec3 seed = point_of(s, u + 0.05, v - 0.03);
  const auto found = nearest_on(s, {{}, seed}, p + off * n);
  ASSERT_TRUE(found);
  EXPECT_LT(distance(*found, p), 1e-8) << u << " " << v;
}

TEST(Nearest, IsWhereAnalyticSurfacesWereLeft) {
  using Kind = SurfaceRecord::Kind;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < 200; ++k) {
    const double a = any(random), b = any(random), off = 0.2 * any(random);
    expect_found_again(analytic(Kind::kPlane, 0, 0), 5 * a, 5 * b, off);
    expect_found_again(analytic(Kind::kCylinder, 2, 0), kPi * a, 5 * b, off);
    expect_found_again(analytic(Kind::kCone, 2, 0.4), kPi * a, 2 + b, off);
    expect_found_again(analytic(Kind::kCone, 2, -0.4), kPi * a, -2 + b, off);
    expect_found_again(analytic(Kind::kSphere, 2, 0), kPi * a, 1.4 * b, off);
    expect_found_again(analytic(Kind::kTorus, 2, 0.7), kPi * a, kPi * b, off);
    // One that meets itself on its axis, where cos v is -.35: its outer sheet, and the inner one.
    expect_found_again(analytic(Kind::kTorus, 0.7, 2), kPi * a, 1.6 * b, off);
    expect_found_again(analytic(Kind::kTorus, 0.7, 2), kPi * a, kPi + b, off);
  }
}

TEST(Nearest, StaysOnTheNappeOfTheSeed) {
  const SurfaceRecord cone = analytic(SurfaceRecord::Kind::kCone, 2, 0.4);
  const double apex = -2 / std::sin(0.4);
  const auto found = nearest_on(cone, {{}, point_of(cone, 1, apex - 1)}, point_of(cone, 1, apex - 0.5));
  ASSERT_TRUE(found);
  EXPECT_LT(distance(*found, point_of(cone, 1, apex - 0.5)), 1e-12);
}

TEST(Nearest, TakesTheDirectionOfTheSeedOnAxes) {
  const SurfaceRecord cylinder = analytic(SurfaceRecord::Kind::kCylinder, 2, 0);
  const auto found = nearest_on(cylinder, {{}, point_of(cylinder, 0.7, 1)}, out_of(cylinder.frame, {0, 0, 1.5}));
  ASSERT_TRUE(found);
  EXPECT_LT(distance(*found, point_of(cylinder, 0.7, 1.5)), 1e-12);
  const SurfaceRecord sphere = analytic(SurfaceRecord::Kind::kSphere, 2, 0);
  const auto pole = nearest_on(sphere, {{}, point_of(sphere, 0, kPi / 2)}, out_of(sphere.frame, {0, 0, 2.1}));
  ASSERT_TRUE(pole);
  EXPECT_LT(distance(*pole, out_of(sphere.frame, {0, 0, 2})), 1e-12);
}

/// A quarter of a circle of radius 1, exactly, and the cylinder above it.
CurveRecord quarter() {
  CurveRecord c;
  c.kind = CurveRecord::Kind::kNurbs;
  c.knots = {2, {0, 0, 0, 1, 1, 1}};
  c.poles = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  c.weights = {1, std::sqrt(0.5), 1};
  return c;
}

SurfaceRecord quarter_cylinder() {
  SurfaceRecord s;
  s.kind = SurfaceRecord::Kind::kNurbs;
  s.u_knots = {2, {0, 0, 0, 1, 1, 1}};
  s.v_knots = {1, {0, 0, 2, 2}};
  const CurveRecord c = quarter();
  for (std::size_t i = 0; i < 3; ++i)
    for (const double z : {0.0, 2.0}) s.poles.push_back(c.poles[i] + Vec3{0, 0, z}), s.weights.push_back(c.weights[i]);
  return s;
}

/// A smooth wavy cubic surface with inner knots.
SurfaceRecord waves() {
  SurfaceRecord s;
  s.kind = SurfaceRecord::Kind::kNurbs;
  s.u_knots = {3, {0, 0, 0, 0, 0.3, 0.5, 1, 1, 1, 1}};
  s.v_knots = {2, {0, 0, 0, 0.4, 0.4, 1, 1, 1}};
  for (std::size_t i = 0; i < s.u_knots.poles(); ++i)
    for (std::size_t j = 0; j < s.v_knots.poles(); ++j) {
      const double x = static_cast<double>(i), y = static_cast<double>(j);
      s.poles.push_back({x, y, 0.3 * std::sin(1.3 * x) * std::cos(0.9 * y)});
      s.weights.push_back(1 + 0.2 * std::sin(x + y));
    }
  return s;
}

TEST(Nurbs, IsAQuarterOfACircle) {
  const CurveRecord c = quarter();
  for (const double t : {0.0, 0.1, 0.5, 0.77, 1.0}) {
    EXPECT_NEAR(length(jet(c, t).p), 1, 1e-15);
    EXPECT_NEAR(dot(jet(c, t).p, jet(c, t).d), 0, 1e-14);
  }
}

TEST(Nurbs, HasTheDerivativesThatDifferencesSay) {
  const SurfaceRecord s = waves();
  const double h = 1e-4;
  for (const double u : {0.05, 0.29, 0.31, 0.7, 0.95})
    for (const double v : {0.1, 0.35, 0.45, 0.9}) {
      const auto at = [&](double du, double dv) { return jet(s, {u + du * h, v + dv * h}).p; };
      const SurfaceJet j = jet(s, {u, v});
      EXPECT_LT(distance(j.u, (at(1, 0) - at(-1, 0)) / (2 * h)), 1e-5);
      EXPECT_LT(distance(j.v, (at(0, 1) - at(0, -1)) / (2 * h)), 1e-5);
      EXPECT_LT(distance(j.uu, (at(1, 0) - 2 * at(0, 0) + at(-1, 0)) / (h * h)), 1e-3);
      EXPECT_LT(distance(j.vv, (at(0, 1) - 2 * at(0, 0) + at(0, -1)) / (h * h)), 1e-3);
      EXPECT_LT(distance(j.uv, (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * h * h)), 1e-3);
    }
}

TEST(Nearest, IsWhereSplinesWereLeft) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(0.05, 0.95);
  const SurfaceRecord s = waves();
  for (int k = 0; k < 300; ++k) {
    const Uv at{any(random), any(random)};
    const SurfaceJet j = jet(s, at);
    const Vec3 p = j.p + 0.1 * (any(random) - 0.5) * normalized(cross(j.u, j.v));
    const auto found = nearest_on(s, {{at.u + 0.1 * (any(random) - 0.5), at.v + 0.1 * (any(random) - 0.5)}, {}}, p);
    ASSERT_TRUE(found);
    EXPECT_LT(distance(*found, j.p), 1e-9);
  }
}

TEST(Nearest, EndsAtTheBorderOfASpline) {
  const SurfaceRecord s = quarter_cylinder();
  const auto found = nearest_on(s, {{0.9, 1.9}, {}}, {-0.5, 1.2, 3});
  ASSERT_TRUE(found);
  EXPECT_LT(distance(*found, {0, 1, 2}), 1e-12);
  const auto on_curve = nearest_on(quarter(), {0.2, {}}, {1.5, -1, 0});
  ASSERT_TRUE(on_curve);
  EXPECT_LT(distance(*on_curve, {1, 0, 0}), 1e-12);
}

TEST(Nearest, IsNeverFartherThanABadSeed) {
  const SurfaceRecord s = waves();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0, 1);
  for (int k = 0; k < 300; ++k) {
    const Uv seed{any(random), any(random)};
    const Vec3 p{5 * any(random), 4 * any(random), 2 * any(random) - 1};
    const auto found = nearest_on(s, {seed, {}}, p);
    ASSERT_TRUE(found);
    EXPECT_LE(distance(*found, p), distance(jet(s, seed).p, p));
  }
}

TEST(Nearest, LiesOnCurves) {
  CurveRecord line;
  line.kind = CurveRecord::Kind::kLine;
  line.frame.origin = {1, 2, 3};
  EXPECT_LT(distance(*nearest_on(line, {}, {7, 8, 9}), {7, 2, 3}), 1e-15);
  CurveRecord circle = line;
  circle.kind = CurveRecord::Kind::kCircle, circle.radius = 2;
  EXPECT_LT(distance(*nearest_on(circle, {}, {1, 7, 5}), {1, 4, 3}), 1e-15);
  CurveRecord ellipse = circle;
  ellipse.kind = CurveRecord::Kind::kEllipse, ellipse.minor = 0.5;
  for (double t = 0; t < 6.2; t += 0.1) {
    const Vec3 on{2 * std::cos(t), 0.5 * std::sin(t), 0};
    const Vec3 normal = normalized(Vec3{0.5 * std::cos(t), 2 * std::sin(t), 0});
    const Vec3 seed{2 * std::cos(t + 0.1), 0.5 * std::sin(t + 0.1), 0};
    const auto found = nearest_on(ellipse, {t + 0.1, line.frame.origin + seed}, line.frame.origin + on + 0.05 * normal);
    ASSERT_TRUE(found);
    EXPECT_LT(distance(*found, line.frame.origin + on), 1e-10) << t;
  }
}

TEST(Nearest, IsUnknownWithoutARecord) {
  EXPECT_FALSE(nearest_on(SurfaceRecord{}, {}, {}));
  EXPECT_FALSE(nearest_on(CurveRecord{}, {}, {}));
}

}  // namespace
}  // namespace octafront::cad
