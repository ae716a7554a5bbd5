#include "fill/classic/fill_classic.h"

#include <octafront/error.h>
#include <octafront/quality.h>
#include <octafront/validity.h>

#include "fill/classic/classic_front.h"
#include "fill/classic/surface_sizes.h"
#include "support/named_surfaces.h"
#include "support/nasty_surfaces.h"

#include <algorithm>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(SurfaceSizes, AreTheEdgeLengthsOfTheNearestPlace) {
  SurfaceMesh two = testing::joined(testing::icosphere(2), testing::transformed(testing::icosphere(2), 0.1, {3, 0, 0}));
  const SizeField sizes = sizes_from_surface(two);
  const double coarse = sizes.at({-1, 0, 0}), fine = sizes.at({3.1, 0, 0});
  EXPECT_NEAR(fine / coarse, 0.1, 0.02);
  EXPECT_DOUBLE_EQ(sizes.at({-5, 0, 0}), sizes.at({-1, 0, 0}));
  EXPECT_LE(sizes.min_size(), fine);
  EXPECT_GE(sizes.max_size(), coarse);
}

TEST(ClassicFront, FindsFacesByTheirBoxes) {
  const SurfaceMesh sphere = testing::icosphere(2);
  ClassicFront front(bounding_box(sphere.points));
  for (const Vec3 p : sphere.points) front.add_vertex(p);
  for (const Triangle& t : sphere.triangles) front.add_face(t);
  front.remove_face(5);
  const Box3 box{{0.1, 0.1, 0.1}, {0.6, 0.7, 0.9}};
  std::vector<ClassicFront::Face> found, expected;
  front.faces_near(box, found);
  for (ClassicFront::Face f = 0; f < sphere.triangles.size(); ++f) {
    Box3 b;
    for (const VertexIndex v : sphere.triangles[f]) b.add(sphere.points[v]);
    if (f != 5 && b.overlaps(box)) expected.push_back(f);
  }
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);
}

/// Both break the contract: a face has three corners, which are vertices.
TEST(ClassicFront, SaysWhichFaceIsWrong) {
  const auto complaint = [](const std::vector<Triangle>& faces) -> std::string {
    ClassicFront front({{0, 0, 0}, {1, 1, 1}});
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}) front.add_vertex(p);
    try {
      for (const Triangle& t : faces) front.add_face(t);
      front.remove_face(0);
      return front.first_inconsistency().value_or("");
    } catch (const std::logic_error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint({{0, 1, 2}, {0, 2, 1}}), "");
  EXPECT_EQ(complaint({{0, 1, 2}, {0, 2, 2}}), "face 1 has a corner twice");
}

TEST(FillClassic, FillsExactlyTheSurface) {
  for (const SurfaceMesh& s :
       {testing::cube(4), testing::icosphere(2), testing::torus(24, 12), testing::hollow_sphere(2),
        testing::joined(testing::cube(3), testing::transformed(testing::icosphere(2), 0.4, {2, 0, 0}))}) {
    StageReport report;
    const TetMesh mesh = fill_volume_classic(s, {}, {{}, report});
    EXPECT_EQ(first_defect(mesh, s), std::nullopt);
    const QualitySummary q = summarize_quality(mesh);
    EXPECT_GT(q.beta_mean, 0.7);
    EXPECT_LT(static_cast<double>(q.beta_classes[0]) / static_cast<double>(q.elements), 0.02);
  }
}

TEST(FillClassic, ClosesByRecoveryWhatNoOtherRungDoes) {
  for (const SurfaceMesh& s : {testing::twisted_prism(3, 50, 1, 4), testing::chazelle_polyhedron(3, 0.05)}) {
    StageReport report;
    EXPECT_EQ(first_defect(fill_volume_classic(s, {}, {{}, report}), s), std::nullopt);
    EXPECT_TRUE(std::ranges::count(report.counters, std::pair<std::string, double>("closed by recovery", 1)));
  }
}

TEST(FillClassic, IsTheSameEachTime) {
  StageReport one, two;
  const SurfaceMesh s = testing::torus(24, 12);
  EXPECT_EQ(fill_volume_classic(s, {}, {{}, one}), fill_volume_classic(s, {}, {{}, two}));
}

TEST(FillClassic, RefusesASelfIntersectingSurface) {
  const SurfaceMesh s =
      testing::joined(testing::icosphere(2), testing::transformed(testing::icosphere(2), 1, {0.5, 0, 0}));
  StageReport report;
  EXPECT_THROW(fill_volume_classic(s, {}, {{}, report}), MeshingError);
}

TEST(FillClassic, RefusesNothing) {
  StageReport report;
  EXPECT_THROW(fill_volume_classic({}, {}, {{}, report}), InputError);
}

}  // namespace
}  // namespace octafront
