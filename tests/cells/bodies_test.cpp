#include <octafront/complex.h>

#include "geometry/self_intersection.h"
#include "support/complexes.h"
#include "support/named_surfaces.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

std::vector<Body> bodies_of(const testing::KnownParts& known) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < known.parts.size(); ++i) bodies.push_back({known.names[i], known.parts[i]});
  return bodies;
}

void expect_joined(const Complex& complex, const testing::KnownParts& known, double tolerance) {
  EXPECT_EQ(complex.surface.region_names, known.names);
  ASSERT_EQ(complex.volumes.size(), known.volumes.size());
  for (std::size_t r = 0; r < known.volumes.size(); ++r) {
    EXPECT_NEAR(complex.volumes[r], known.volumes[r], tolerance);
    EXPECT_NEAR(testing::region_volumes(complex.surface)[r], known.volumes[r], tolerance);
  }
  EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
}

double interface_area(const SurfaceMesh& s) {
  double area = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.sides[t][0] == kNone || s.sides[t][1] == kNone) continue;
    const auto [a, b, c] = s.triangles[t];
    area += length(cross(s.points[b] - s.points[a], s.points[c] - s.points[a])) / 2;
  }
  return area;
}

TEST(JoinBodies, KnownParts) {
  for (const testing::KnownParts& known : testing::known_parts()) {
    SCOPED_TRACE(known.name);
    expect_joined(join_bodies(bodies_of(known)), known, 1e-9);
  }
}

TEST(JoinBodies, ABoltSharesItsHoleWithThePlate) {
  const testing::KnownParts known = testing::bolt_in_hole(32, false);
  const Complex complex = join_bodies(bodies_of(known));
  const double side = 2 * 0.5 * std::sin(std::acos(-1) / 32);
  EXPECT_NEAR(interface_area(complex.surface), 32 * side * 0.375, 1e-9);
}

TEST(JoinBodies, TheLaterOneHasItsWay) {
  const SurfaceMesh a = testing::cube(1), b = testing::transformed(testing::cube(1), 1, {.5, 0, 0});
  EXPECT_NEAR(join_bodies({{"a", a}, {"b", b}}).volumes[0], 0.5, 1e-12);
  EXPECT_NEAR(join_bodies({{"b", b}, {"a", a}}).volumes[0], 0.5, 1e-12);
  const Complex inside = join_bodies({{"a", a}, {"in", testing::transformed(testing::cube(1), 0.5, {.25, .25, .25})}});
  EXPECT_NEAR(inside.volumes[0], 0.875, 1e-12);
  EXPECT_NEAR(inside.volumes[1], 0.125, 1e-12);
}

TEST(JoinBodies, ABodyThatIsCoveredIsRefusedByName) {
  try {
    join_bodies({{"small", testing::transformed(testing::cube(1), 0.5, {.25, .25, .25})}, {"large", testing::cube(1)}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("small"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("large"), std::string::npos);
  }
}

TEST(JoinBodies, AnOpenBodyIsRefusedByName) {
  SurfaceMesh open = testing::cube(1);
  open.triangles.pop_back();
  open.patch.clear();
  try {
    join_bodies({{"first", testing::cube(1)}, {"second", open}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 8), "second: ");
  }
}

TEST(JoinBodies, SeedsFillAndEmpty) {
  // A hollow body; what is in it belongs to nobody until a point says so.
  const SurfaceMesh hollow = testing::joined(
      testing::cube(2), testing::reversed(testing::transformed(testing::cube(1), 0.5, {.25, .25, .25})));
  ComplexOptions options;
  options.regions = {{"core", {.5, .5, .5}}};
  const Complex complex = join_bodies({{"shell", hollow}}, options);
  EXPECT_EQ(complex.surface.region_names, (std::vector<std::string>{"shell", "core"}));
  EXPECT_NEAR(complex.volumes[1], 0.125, 1e-12);
}

}  // namespace
}  // namespace octafront
