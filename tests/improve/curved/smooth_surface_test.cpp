#include "improve/curved/smooth_surface.h"

#include "base/mesh/known_surface.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

namespace octafront::curved {
namespace {

using octafront::testing::box;
using octafront::testing::icosphere;
using octafront::testing::torus;

/// The farthest of the smooth points of the triangles' centres and of their edges' middles, before and after.
struct Errors {
  double flat = 0, smooth = 0;
};

Errors errors(const SurfaceMesh& surface, const std::function<double(Vec3)>& distance_of) {
  const KnownSurface known(surface, 40);
  SmoothSurface smooth(known.mesh(), known.edges(), known.tree(), known.features());
  std::vector<Foot> feet;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Vec3 p = surface.points[a], q = surface.points[b], r = surface.points[c];
    feet.push_back({(p + q + r) / 3, t});
    feet.push_back({0.5 * (p + q), t});
  }
  smooth.prepare(feet, {});
  Errors found;
  for (const Foot& foot : feet) {
    found.flat = std::max(found.flat, distance_of(foot.at));
    found.smooth = std::max(found.smooth, distance_of(smooth.surface_point(foot)));
  }
  return found;
}

double from_ball(Vec3 p) {
  return std::abs(length(p) - 1);
}
double from_torus(Vec3 p) {
  return std::abs(std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.35);
}

SurfaceMesh cylinder(VertexIndex n, double height) {
  SurfaceMesh s;
  for (const double z : {0.0, height})
    for (VertexIndex i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n;
      s.points.push_back({std::cos(a), std::sin(a), z});
    }
  s.points.push_back({0, 0, 0});
  s.points.push_back({0, 0, height});
  for (VertexIndex i = 0; i < n; ++i) {
    const VertexIndex j = (i + 1) % n;
    s.triangles.insert(s.triangles.end(), {{i, j, n + j}, {i, n + j, n + i}, {j, i, 2 * n}, {n + i, n + j, 2 * n + 1}});
  }
  return s;
}

TEST(SmoothSurface, DistanceToABallFallsWithTheFourthPower) {
  const Errors coarse = errors(icosphere(3), from_ball), fine = errors(icosphere(4), from_ball);
  EXPECT_LT(fine.smooth, fine.flat / 300);
  EXPECT_GT(coarse.smooth / fine.smooth, 12);
  EXPECT_NEAR(coarse.flat / fine.flat, 4, 0.5);
}

TEST(SmoothSurface, DistanceToATorusFallsWithTheFourthPower) {
  const Errors coarse = errors(torus(64, 24), from_torus), fine = errors(torus(128, 48), from_torus);
  EXPECT_LT(fine.smooth, fine.flat / 100);
  EXPECT_GT(coarse.smooth / fine.smooth, 10);
}

TEST(SmoothSurface, StripsFromRimToRimAreACylinder) {
  const double far = 20;  // long strips: all vertices on two circles
  const auto from_side = [&](Vec3 p) {
    return std::min({std::abs(std::hypot(p.x, p.y) - 1), std::abs(p.z), std::abs(p.z - far)});
  };
  const Errors found = errors(cylinder(32, far), from_side);
  EXPECT_LT(found.smooth, found.flat / 50);
}

TEST(SmoothSurface, FlatFacesStayFlat) {
  const SurfaceMesh surface = box(1, 2, 3, 4);
  const auto from_sides = [](Vec3 p) {
    return std::min(
        {std::abs(p.x), std::abs(p.x - 1), std::abs(p.y), std::abs(p.y - 2), std::abs(p.z), std::abs(p.z - 3)});
  };
  EXPECT_LT(errors(surface, from_sides).smooth, 1e-14);
}

TEST(SmoothSurface, NoiseIsNotTakenForShape) {
  // Heights that alternate like a chessboard: no polynomial goes through them, and the flat triangles stay.
  SurfaceMesh surface = box(10, 10, 10, 10);
  for (Vec3& p : surface.points) {
    const bool inside = p.x > 0.5 && p.x < 9.5 && p.y > 0.5 && p.y < 9.5 && p.z == 10;
    if (inside) p.z += (static_cast<int>(std::lround(p.x + p.y)) % 2 == 0 ? 0.1 : -0.1);
  }
  const KnownSurface known(surface, 40);
  SmoothSurface smooth(known.mesh(), known.edges(), known.tree(), known.features());
  for (const Vec3 p : {Vec3{4.7, 4.9, 10}, Vec3{5.3, 5.1, 10}, Vec3{4.5, 5.5, 10}}) {
    const auto foot = smooth.surface_foot(p, {0, 0, 1}, 1);
    ASSERT_TRUE(foot);
    smooth.prepare({{*foot}}, {});
    EXPECT_LT(distance(smooth.surface_point(*foot), foot->at), 1e-14);
  }
}

TEST(SmoothSurface, RimsAreCircles) {
  const KnownSurface known(cylinder(32, 2), 40);
  SmoothSurface smooth(known.mesh(), known.edges(), known.tree(), known.features());
  double flat = 0, curved = 0;
  for (const Edge& edge : known.features().edges) {
    const Vec3 middle = 0.5 * (known.mesh().points[edge[0]] + known.mesh().points[edge[1]]);
    const auto foot = smooth.curve_foot(middle, 0.1);
    ASSERT_TRUE(foot);
    EXPECT_FALSE(smooth.is_corner(*foot, 1e-9));
    smooth.prepare({}, {{*foot}});
    const Vec3 on = smooth.curve_point(*foot);
    flat = std::max(flat, std::abs(std::hypot(middle.x, middle.y) - 1));
    curved = std::max(curved, std::abs(std::hypot(on.x, on.y) - 1) + std::abs(on.z - middle.z));
  }
  EXPECT_LT(curved, flat / 100);
}

TEST(SmoothSurface, FeetAreOnTheSideThatIsMeant) {
  const KnownSurface known(box(1, 1, 0.01), 40);  // a sheet: the nearest triangle may be that of the other side
  const SmoothSurface smooth(known.mesh(), known.edges(), known.tree(), known.features());
  const Vec3 p{0.5, 0.4, 0.002};
  EXPECT_NEAR(smooth.surface_foot(p, {0, 0, 1}, 0.1)->at.z, 0.01, 1e-15);
  EXPECT_NEAR(smooth.surface_foot(p, {0, 0, -1}, 0.1)->at.z, 0, 1e-15);
  EXPECT_FALSE(smooth.surface_foot(p, {1, 0, 0}, 0.1));
}

TEST(SmoothSurface, CornersAreToldFromPointsOfCurves) {
  const KnownSurface known(box(1, 1, 1, 4), 40);
  const SmoothSurface smooth(known.mesh(), known.edges(), known.tree(), known.features());
  EXPECT_TRUE(smooth.is_corner(*smooth.curve_foot({0, 0, 0}, 0.1), 1e-9));
  EXPECT_FALSE(smooth.is_corner(*smooth.curve_foot({0.5, 0, 0}, 0.1), 1e-9));
}

}  // namespace
}  // namespace octafront::curved
