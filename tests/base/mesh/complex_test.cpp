#include "base/mesh/complex.h"

#include <octafront/error.h>
#include <octafront/validity.h>

#include "base/mesh/curve_names.h"
#include "support/labelled_walls.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Two tetrahedra on the two sides of one triangle.
SurfaceMesh two_tets() {
  SurfaceMesh s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}, {0, 1, 4}, {1, 2, 4}, {0, 4, 2}};
  for (Triangle& t : s.triangles) std::swap(t[1], t[2]);
  s.triangles[0] = {0, 1, 2};
  // Region 0 above, region 1 below: the common triangle faces up.
  s.sides = {{0, 1}, {kNone, 0}, {kNone, 0}, {kNone, 0}, {kNone, 1}, {kNone, 1}, {kNone, 1}};
  for (std::size_t t = 1; t < s.triangles.size(); ++t) {
    // Outward: away from the middle of the body.
    const auto [a, b, c] = s.triangles[t];
    const Vec3 n = cross(s.points[b] - s.points[a], s.points[c] - s.points[a]);
    const Vec3 middle{0.2, 0.2, t < 4 ? 0.2 : -0.2};
    if (dot(n, s.points[a] - middle) < 0) std::swap(s.triangles[t][1], s.triangles[t][2]);
  }
  return s;
}

TetMesh mesh_of_two_tets() {
  TetMesh m;
  m.points = two_tets().points;
  m.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  return m;
}

TetMesh bound(const SurfaceMesh& complex) {
  TetMesh m = mesh_of_two_tets();
  SurfaceMesh turned = complex;
  face_lower_regions_behind(turned);
  list_faces(turned, m);
  m.region = regions_within(turned, m);
  return m;
}

TEST(ComplexFaces, HullAndRegionsAreClosed) {
  const SurfaceMesh cells = testing::box_walls({testing::even_planes(3), testing::even_planes(3), {0, 0.3, 1}},
                                               [](Vec3 c) { return c.z < 0.3 ? 0u : 1u; });
  EXPECT_EQ(region_count(cells), 2u);
  EXPECT_NEAR(enclosed_volume(cells), 1, 1e-15);
  EXPECT_NEAR(enclosed_volume(hull_of(cells)), 1, 1e-15);
  EXPECT_NEAR(enclosed_volume(boundary_of_region(cells, 0)), 0.3, 1e-15);
  EXPECT_NEAR(enclosed_volume(boundary_of_region(cells, 1)), 0.7, 1e-15);
  EXPECT_NEAR(testing::volume_of_region(cells, 1), 0.7, 1e-15);
}

TEST(ComplexFaces, AMeshGetsItsRegionsFromTheSidesOfItsFaces) {
  const TetMesh m = bound(two_tets());
  EXPECT_EQ(m.region, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(m.boundary.size(), 6u);
  EXPECT_EQ(m.interfaces.size(), 1u);
  EXPECT_EQ(first_defect(m, two_tets()), std::nullopt);
}

TEST(ComplexFaces, SmallRegionsKeepTheDigitsOfTheirVolumes) {
  const Vec3 far{1e6, -2e6, 3e6};
  SurfaceMesh two = testing::transformed(testing::cube(), 1e6, {});
  two.sides.assign(two.triangles.size(), {kNone, 0});
  const SurfaceMesh small = testing::transformed(testing::cube(), 0.25, far);
  const auto first = static_cast<VertexIndex>(two.points.size());
  two.points.insert(two.points.end(), small.points.begin(), small.points.end());
  for (const auto& [a, b, c] : small.triangles) {
    two.triangles.push_back({first + a, first + b, first + c});
    two.sides.push_back({kNone, 1});
  }
  const std::vector<double> volumes = volumes_of_regions(two);
  ASSERT_EQ(volumes.size(), 2u);
  EXPECT_NEAR(volumes[0], 1e18, 1e3);
  EXPECT_NEAR(volumes[1], 1.0 / 64, 1e-15);
  EXPECT_NEAR(volumes_of_regions(testing::cube())[0], 1, 1e-15) << "without sides there is one region";
}

TEST(ComplexFaces, RegionsThatLeakAreFound) {
  SurfaceMesh open = two_tets();
  open.triangles.erase(open.triangles.begin());
  open.sides.erase(open.sides.begin());
  EXPECT_THROW(bound(open), MeshingError);
}

TEST(ComplexFaces, AMeshThatIsNotTheComplexIsFound) {
  const SurfaceMesh complex = two_tets();
  TetMesh other = bound(complex);
  std::swap(other.region[0], other.region[1]);
  EXPECT_NE(first_defect(other, complex), std::nullopt);
  other = bound(complex);
  other.interfaces.clear();
  EXPECT_NE(first_defect(other, complex), std::nullopt);
  SurfaceMesh finer = complex;
  finer.points[4].z = -2;
  EXPECT_NE(first_defect(bound(complex), finer), std::nullopt);
}

TEST(ComplexFaces, CurvesAreCalledByTheirPatches) {
  const std::vector<std::string> names{"a", "b", "a|b", ""};
  const auto name = [&](std::vector<std::uint32_t> patches) { return curve_name(patches, names); };
  EXPECT_EQ(name({0, 1}), "a|b");
  EXPECT_EQ(name({0, 2}), "a + a|b");
  EXPECT_EQ(name({1}), "b end");
  EXPECT_EQ(name({0, 3}), "");
}

}  // namespace
}  // namespace octafront
