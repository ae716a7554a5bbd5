#include "fill/lattice/core.h"

#include <octafront/quality.h>

#include "base/geometry/predicates.h"
#include "base/geometry/triangle_box.h"
#include "base/geometry/triangle_intersection.h"
#include "base/geometry/triangle_tree.h"
#include "fill/lattice/clear_sites.h"
#include "fill/lattice/lattice_octree.h"
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
    std::vector<double> cell(core.points.size(), 1e300);  // side of the smallest cell around a vertex
    for (const Tet& t : core.tets) {
      double side = 0;
      for (const auto& [i, j] : kTetEdges) side = std::max(side, distance(core.points[t[i]], core.points[t[j]]));
      for (const VertexIndex v : t) cell[v] = std::min(cell[v], side);
    }
    for (std::size_t v = 0; v < core.points.size(); ++v) {
      EXPECT_TRUE(tree.contains(core.points[v]));
      // Where sizes vary, leaves beyond the core may be smaller.
      const double least = kCoreClearance * cell[v] * (c.sizes.min_size() < c.sizes.max_size() ? 0.5 : 1);
      EXPECT_GE(std::sqrt(tree.nearest(core.points[v]).squared_distance), least * (1 - 1e-5));
    }
  }
}

// Slots and holes narrower than a cell pass between corners that keep their distance.
TEST(LatticeCore, DoesNotTouchTheSurface) {
  for (const Vec3 extent : {Vec3{0.8, 0.8, 0.01}, Vec3{0.01, 0.01, 0.8}, Vec3{0.3, 0.01, 0.3}}) {
    for (int shift = 0; shift < 6; ++shift) {
      SCOPED_TRACE(shift);
      SurfaceMesh slot = testing::reversed(testing::cube(2));
      const Box3 box = bounding_box(slot.points);
      const Vec3 by = Vec3{0.017, 0.013, 0.011} * shift;
      for (Vec3& p : slot.points) {
        const Vec3 q = p - box.center();
        p = box.center() + Vec3{q.x * extent.x, q.y * extent.y, q.z * extent.z} + by;
      }
      const SurfaceMesh surface = testing::joined(testing::cube(4), slot);
      const LatticeCore core = build_lattice_core(surface, SizeField::uniform(0.09), {});
      ASSERT_GT(core.tets.size(), 1000u);
      const TriangleTree tree(surface);
      for (const Tet& t : core.tets)
        for (const auto& [i, j, k] : kTetFaces) {
          const TriangleCorners face{core.points[t[i]], core.points[t[j]], core.points[t[k]]};
          bool meets = false;
          tree.for_each_overlapping(box_of(face),
                                    [&](std::uint32_t s) { meets = meets || triangles_meet(face, tree.corners(s)); });
          EXPECT_FALSE(meets);
        }
    }
  }
}

TEST(LatticeCore, HasElementsOfTheBestShapeOnly) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const LatticeCore core = build_lattice_core(c.surface, c.sizes, {});
    for (const Tet& t : core.tets)
      EXPECT_NEAR(radius_ratio(core.points[t[0]], core.points[t[1]], core.points[t[2]], core.points[t[3]]), 0.94868,
                  1e-4);
  }
}

TEST(LatticeCore, MeetsTheWantedSize) {
  const LatticeCore core = build_lattice_core(testing::icosphere(3), SizeField::uniform(0.1), {});
  double sum = 0;
  for (const Tet& t : core.tets)
    for (const auto& [i, j] : kTetEdges) sum += distance(core.points[t[i]], core.points[t[j]]);
  EXPECT_NEAR(sum / (6.0 * static_cast<double>(core.tets.size())), 0.1, 0.005);
}

// The boxes about its triangles are the whole cube around it.
TEST(LatticeOctree, OfANeedleAskewIsFineAtTheNeedleOnly) {
  SurfaceMesh needle;
  needle.points = {{0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0}, {1, 1, 1}};
  needle.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const TriangleTree tree(needle.points, needle.triangles);
  const LatticeOctree lattice = build_lattice_octree(needle, tree, SizeField::uniform(0.01), {});
  EXPECT_LT(lattice.tree.size(), 1e5);
  const auto is_fine = [&](Vec3 p) {
    const Vec3 at = (p - lattice.root.corner_of(OctreeKey::root())) * (OctreeKey::kSide / lattice.root.side);
    const auto leaf = lattice.tree.leaf(lattice.tree.find(OctreeKey::containing(
        static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y), static_cast<std::uint32_t>(at.z))));
    return lattice.root.side_of(leaf) < 0.02;
  };
  for (double x = 0.005; x < 1; x += 0.005) EXPECT_TRUE(is_fine({x, x, x}));
}

TEST(LatticeCore, IsEmptyWhereThereIsNoRoom) {
  EXPECT_TRUE(build_lattice_core(testing::icosphere(2), SizeField::uniform(1.5), {}).tets.empty());
}

}  // namespace
}  // namespace octafront
