// What of the input is said to force poor elements.

#include <octafront/complex.h>
#include <octafront/generate.h>

#include "pipeline/stages/requirements.h"
#include "support/faceted.h"
#include "support/named_surfaces.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

std::array<Vec3, 4> element_at(Vec3 p, double size) {
  return {p, p + Vec3{size, 0, 0}, p + Vec3{0, size, 0}, p + Vec3{0, 0, size}};
}

bool names_what(const std::optional<NarrowPlace>& place, const std::string& words) {
  return place && place->words.find(words) != std::string::npos;
}

TEST(NarrowPlace, AWedge) {
  // A roof over the plane y, z: its ridge is at the origin.
  constexpr double kAngle = 0.05;
  SurfaceMesh wedge;
  wedge.points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, std::tan(kAngle)}, {1, 1, std::tan(kAngle)}};
  wedge.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}, {0, 2, 4}, {1, 5, 3}, {2, 3, 5}, {2, 5, 4}};
  const auto place = narrow_place_at(wedge, element_at({.02, .4, .001}, .1), false);
  EXPECT_TRUE(names_what(place, "walls of the input meet at 2.9 degrees"));
  EXPECT_NEAR(place->degrees, kAngle * 180 / std::acos(-1), 1e-6);
  EXPECT_FALSE(narrow_place_at(testing::cube(1), element_at({.01, .4, .01}, .1), false));
}

TEST(NarrowPlace, AGapThroughABodyAndNoneBetweenBodies) {
  const SurfaceMesh plate = testing::box(1, 1, .01);
  EXPECT_TRUE(
      names_what(narrow_place_at(plate, element_at({.4, .4, 0}, .1), false), "walls of the input are 0.01 apart"));
  EXPECT_TRUE(
      names_what(narrow_place_at(plate, element_at({.25, .25, 0}, .05), false), "walls of the input are 0.01 apart"))
      << "far from all corners";
  const SurfaceMesh apart = testing::joined(testing::cube(1), testing::transformed(testing::cube(1), 1, {1.01, 0, 0}));
  EXPECT_FALSE(narrow_place_at(apart, element_at({.85, .4, .4}, .1), false));
}

TEST(NarrowPlace, KeptTrianglesOfAContactByName) {
  const Complex complex =
      join_bodies({{"ring", testing::faceted_ring(48, 5, 10, 4)}, {"pin", testing::faceted_pin(36, 5, 0, 4)}});
  const auto place = narrow_place_at(complex.surface, element_at({4.9, 0, 2}, 1), true);
  EXPECT_TRUE(names_what(place, "a triangle that was kept has an angle of"));
  EXPECT_TRUE(names_what(place, "the contact of \"ring\" and \"pin\""));
}

TEST(NarrowPlace, IsSaidOfTheLeastElement) {
  Options options;
  options.size.size = .5;
  // A hole of a hundredth of the size.
  const Result made = generate(testing::faceted_ring(4, .005, 1, .3), options);
  std::string notes;
  for (const StageReport& stage : made.report.stages)
    for (const std::string& note : stage.notes) notes += note + '\n';
  EXPECT_NE(notes.find("between sheets or curves nearer than a tenth of their size"), std::string::npos) << notes;
  ASSERT_LT(made.report.quality.dihedral_min, 10);
  EXPECT_NE(notes.find("an edge of the input is 0.0071 long there"), std::string::npos) << notes;
}

}  // namespace
}  // namespace octafront
