#include "lattice/core.h"

#include <octafront/quality.h>

#include "geometry/predicates.h"
#include "geometry/triangle_tree.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

namespace octafront {
namespace {

struct Case {
  const char* name;
  SurfaceMesh surface;
  SizeField sizes;
};

std::vector<Case> cases() {
  const auto graded = SizeField::from_function(
      [](Vec3 p) {
        return 0.05 + 0.2 * length(p - Vec3{1, 0, 0});
      },
      0.05, 0.5);
  return {{"sphere", testing::icosphere(3), SizeField::uniform(0.1)},
          {"hollow sphere", testing::hollow_sphere(3), SizeField::uniform(0.08)},
          {"torus", testing::torus(48, 24), SizeField::uniform(0.06)},
          {"graded sphere", testing::icosphere(3), graded}};
}

std::array<VertexIndex, 3> sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

TEST(LatticeCore, IsPositiveAndConforming) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const LatticeCore core = build_lattice_core(c.surface, c.sizes, {});
    ASSERT_GT(core.tets.size(), 500u);
    std::map<std::array<VertexIndex, 3>, int> faces;
    for (const Tet& t : core.tets) {
      ASSERT_EQ(orient3d(core.points[t[0]], core.points[t[1]], core.points[t[2]], core.points[t[3]]), 1);
      for (const auto& [i, j, k] : kTetFaces) ++faces[sorted({t[i], t[j], t[k]})];
    }
    std::size_t single = 0;
    for (const auto& [face, count] : faces) {
      EXPECT_LE(count, 2);
      single += count == 1;
    }
    EXPECT_EQ(single, core.skin.size());
    for (const Triangle& t : core.skin) EXPECT_EQ(faces[sorted(t)], 1);
  }
}

TEST(LatticeCore, SkinBoundsTheVolumeOfItsTets) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const LatticeCore core = build_lattice_core(c.surface, c.sizes, {});
    double volume = 0;
    for (const Tet& t : core.tets) {
      const Vec3 a = core.points[t[0]];
      volume += dot(cross(core.points[t[1]] - a, core.points[t[2]] - a), core.points[t[3]] - a) / 6;
    }
    SurfaceMesh skin;
    skin.points = core.points;
    skin.triangles = core.skin;
    EXPECT_NEAR(-enclosed_volume(skin) / volume, 1, 1e-9);
  }
}

TEST(LatticeCore, KeepsItsDistanceInside) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const TriangleTree tree(c.surface);
    const LatticeCore core = build_lattice_core(c.surface, c.sizes, {});
    for (const Vec3& p : core.points) {
      EXPECT_TRUE(tree.contains(p));
      EXPECT_GE(std::sqrt(tree.nearest(p).squared_distance), 0.8 * c.sizes.at(p) * (1 - 1e-12));
    }
  }
}

TEST(LatticeCore, UniformSizesGiveTheBestShapeOnly) {
  const LatticeCore core = build_lattice_core(testing::icosphere(3), SizeField::uniform(0.1), {});
  double sum = 0;
  for (const Tet& t : core.tets) {
    EXPECT_NEAR(radius_ratio(core.points[t[0]], core.points[t[1]], core.points[t[2]], core.points[t[3]]), 0.94868,
                1e-4);
    for (const auto& [i, j] : kTetEdges) sum += distance(core.points[t[i]], core.points[t[j]]);
  }
  EXPECT_NEAR(sum / (6.0 * static_cast<double>(core.tets.size())), 0.1, 0.005);
}

TEST(LatticeCore, IsEmptyWhereThereIsNoRoom) {
  EXPECT_TRUE(build_lattice_core(testing::icosphere(2), SizeField::uniform(1.5), {}).tets.empty());
}

}  // namespace
}  // namespace octafront
