#include "base/mesh/features.h"

#include "support/named_surfaces.h"

#include <algorithm>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(Features, CubeHasTwelveEdgesAndEightCorners) {
  for (const int n : {1, 3}) {
    const SurfaceMesh cube = testing::cube(n);
    const Features features = detect_features(cube, 40);
    EXPECT_EQ(features.edges.size(), 12u * n);
    EXPECT_EQ(features.corners.size(), 8u);
  }
}

TEST(Features, SmoothSurfaceHasNone) {
  const Features features = detect_features(testing::icosphere(3), 40);
  EXPECT_TRUE(features.edges.empty());
  EXPECT_TRUE(features.corners.empty());
}

TEST(Features, PatchBorderIsAClosedCurveWithoutCorners) {
  SurfaceMesh sphere = testing::icosphere(4);
  for (const auto& [a, b, c] : sphere.triangles)
    sphere.patch.push_back((sphere.points[a] + sphere.points[b] + sphere.points[c]).z > 1.2);
  const Features features = detect_features(sphere, 130);  // the border zigzags along triangle sides
  EXPECT_FALSE(features.edges.empty());
  EXPECT_TRUE(features.corners.empty());
}

TEST(Features, EdgesAreSortedAndEveryEndOfACurveIsACorner) {
  SurfaceMesh cube = testing::cube(4);
  cube.patch[0] = 17;  // a triangle of its own
  const Features features = detect_features(cube, 40);
  EXPECT_TRUE(std::is_sorted(features.edges.begin(), features.edges.end()));
  EXPECT_TRUE(std::is_sorted(features.corners.begin(), features.corners.end()));
  std::vector<int> valence(cube.points.size());
  for (const auto& [a, b] : features.edges) {
    EXPECT_LT(a, b);
    ++valence[a];
    ++valence[b];
  }
  const std::set<VertexIndex> corners(features.corners.begin(), features.corners.end());
  for (VertexIndex v = 0; v < valence.size(); ++v)
    EXPECT_TRUE(valence[v] == 0 || valence[v] == 2 || corners.contains(v)) << v;
}

/// A cube one of whose sides' edge is doubled by a sliver as high as rounding noise, turned by any angle.
SurfaceMesh cube_with_sliver(double height_y, double height_z) {
  SurfaceMesh s = testing::cube();
  // The edge from (0,0,1) to (1,0,1), shared by the sides y = 0 and z = 1, gets a vertex beside its middle.
  const auto find = [&](Vec3 p) {
    return static_cast<VertexIndex>(std::find(s.points.begin(), s.points.end(), p) - s.points.begin());
  };
  const VertexIndex a = find({0, 0, 1}), b = find({1, 0, 1}), m = static_cast<VertexIndex>(s.points.size());
  s.points.push_back({0.5, height_y, 1 - height_z});
  const std::size_t count = s.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    const Triangle face = s.triangles[t];
    for (int i = 0; i < 3; ++i) {
      // The face of side y = 0 runs from a to b; it is divided at m and the sliver a, b, m closes the gap.
      if (face[i] != a || face[(i + 1) % 3] != b) continue;
      s.triangles[t] = {a, m, face[(i + 2) % 3]};
      s.triangles.push_back({m, b, face[(i + 2) % 3]});
      s.triangles.push_back({a, b, m});
      s.patch.insert(s.patch.end(), 2, s.patch[t]);
    }
  }
  return s;
}

TEST(Features, RimsOfPlatesAsThinAsNoiseHaveEdgesOnBothSides) {
  for (const int squares : {1, 4}) {
    SurfaceMesh plate = testing::box(1, 1, 1e-6, squares);
    plate.patch.clear();
    const Features found = detect_features(plate, 40);
    EXPECT_EQ(found.edges.size(), 8u * squares + 4u * squares);
    EXPECT_EQ(found.corners.size(), 8u);
  }
}

TEST(Features, SliverAtAnEdgeDoesNotDoubleIt) {
  for (const auto& [y, z] : {std::pair{1e-7, 1e-7}, std::pair{-1e-7, 1e-7}, std::pair{0., 1e-7}, std::pair{1e-7, 0.}}) {
    SurfaceMesh s = cube_with_sliver(y, z);
    s.patch.clear();
    const Features features = detect_features(s, 40);
    EXPECT_TRUE(features.edges.size() == 12 || features.edges.size() == 13) << y << ' ' << z;
    EXPECT_EQ(features.corners.size(), 8u) << y << ' ' << z;
  }
}

TEST(Features, ScaleAndShiftChangeNothing) {
  const SurfaceMesh cube = testing::cube(3);
  const Features expected = detect_features(cube, 40);
  for (const double scale : {1e-6, 1e6}) {
    const Features features = detect_features(testing::transformed(cube, scale, Vec3{3, -5, 7} * scale), 40);
    EXPECT_EQ(features.edges, expected.edges);
    EXPECT_EQ(features.corners, expected.corners);
  }
}

}  // namespace
}  // namespace octafront
