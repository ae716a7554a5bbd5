#include "sizing/field/octree.h"

#include "base/core/validate.h"
#include "sizing/field/inside_fraction.h"
#include "sizing/field/octree_corners.h"
#include "support/named_surfaces.h"

#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

OctreeKey random_key(std::mt19937& random, int level) {
  std::uniform_int_distribution<std::uint32_t> unit(0, OctreeKey::kSide - 1);
  return OctreeKey::containing(unit(random), unit(random), unit(random), level);
}

/// A tree divided along a curve through the cube.
Octree example_tree(int depth) {
  DividedCells cells;
  for (int i = 0; i < 40; ++i) {
    const double t = i / 40.0;
    const RootCube unit_cube{{0, 0, 0}, 1};
    cells.divide(unit_cube.cell({t, t * t, 0.3 + 0.2 * t}).ancestor(depth));
  }
  cells.close();
  return cells.tree();
}

TEST(OctreeKey, ParentUndoesChild) {
  std::mt19937 random(1);
  for (int level = 0; level < OctreeKey::kMaxLevel; ++level) {
    for (int n = 0; n < 50; ++n) {
      const OctreeKey key = random_key(random, level);
      ASSERT_TRUE(key.is_valid());
      ASSERT_EQ(key.level(), level);
      for (int i = 0; i < 8; ++i) {
        const OctreeKey child = key.child(i);
        ASSERT_EQ(child.parent(), key);
        ASSERT_EQ(child.child_number(), i);
        ASSERT_TRUE(key.contains(child));
        ASSERT_FALSE(child.contains(key));
        ASSERT_EQ(child < key, i < 4);
      }
    }
  }
}

TEST(OctreeKey, CornerAndLevelNameTheCell) {
  std::mt19937 random(2);
  for (int n = 0; n < 1000; ++n) {
    const OctreeKey key = random_key(random, n % (OctreeKey::kMaxLevel + 1));
    const auto c = key.corner();
    EXPECT_EQ(OctreeKey::containing(c[0], c[1], c[2], key.level()), key);
    for (const auto x : c) EXPECT_EQ(x % key.side(), 0u);
  }
}

TEST(OctreeKey, ChildrenTileTheirParentInTheOrderOfTheCurve) {
  const OctreeKey key = OctreeKey::root().child(3).child(5);
  std::uint64_t next = key.range_min();
  for (int i = 0; i < 8; ++i) {
    EXPECT_GE(key.child(i).range_min(), next);
    next = key.child(i).range_max() + 1;
  }
  EXPECT_EQ(key.child(7).range_max(), key.range_max());
}

TEST(OctreeKey, NeighbourhoodIsMutual) {
  std::mt19937 random(3);
  for (int n = 0; n < 1000; ++n) {
    const OctreeKey key = random_key(random, 1 + n % OctreeKey::kMaxLevel);
    for (int d = 0; d < 27; ++d) {
      const int x = d % 3 - 1, y = d / 3 % 3 - 1, z = d / 9 - 1;
      const OctreeKey other = key.neighbour(x, y, z);
      bool is_inside = true;
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t step = std::array{x, y, z}[axis], side = key.side(), at = key.corner()[axis] + step * side;
        is_inside = is_inside && at >= 0 && at < OctreeKey::kSide;
        if (other.is_valid()) {
          ASSERT_EQ(other.corner()[axis], at);
        }
      }
      ASSERT_EQ(other.is_valid(), is_inside);
      if (other.is_valid()) {
        ASSERT_EQ(other.level(), key.level());
        ASSERT_EQ(other.neighbour(-x, -y, -z), key);
      }
    }
  }
  EXPECT_FALSE(OctreeKey::root().neighbour(1, 0, 0).is_valid());
  EXPECT_EQ(OctreeKey::root().neighbour(0, 0, 0), OctreeKey::root());
}

TEST(Octree, LeavesCoverTheCubeOnce) {
  const Octree tree = example_tree(8);
  double volume = 0;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    volume += std::pow(0.125, tree.leaf(i).level());
    if (i > 0) {
      ASSERT_LT(tree.leaf(i - 1).range_max(), tree.leaf(i).range_min());
    }
  }
  EXPECT_DOUBLE_EQ(volume, 1);
}

TEST(Octree, FindsTheLeafAroundAnyCell) {
  std::mt19937 random(4);
  for (const int depth : {0, 1, 4, 9}) {
    const Octree tree = example_tree(depth);
    for (int n = 0; n < 5000; ++n) {
      const OctreeKey key = random_key(random, OctreeKey::kMaxLevel);
      ASSERT_TRUE(tree.leaf(tree.find(key)).contains(key));
    }
    for (std::size_t i = 0; i < tree.size(); ++i) ASSERT_EQ(tree.find(tree.leaf(i)), i);
  }
}

TEST(Octree, SaysWhereItsLeavesDoNotTileTheRoot) {
  const Octree good = example_tree(4);
  EXPECT_FALSE(good.first_inconsistency());
  std::vector<OctreeKey> hole(good.leaves().begin(), good.leaves().end()), overlap = hole, cut = hole;
  hole.erase(hole.begin() + 5);
  overlap[5] = overlap[5].parent();
  cut.pop_back();
  for (const auto& leaves : {hole, overlap, cut}) {
    if (kValidate) {
      EXPECT_THROW(Octree{leaves}, std::logic_error);
    } else {
      EXPECT_TRUE(Octree(leaves).first_inconsistency());
    }
  }
}

TEST(Octree, ClosingBalancesAndKeepsWhatWasDivided) {
  const Octree tree = example_tree(10);
  EXPECT_TRUE(tree.is_balanced());
  EXPECT_EQ(tree.depth(), 11);
  DividedCells again = divided_cells(tree);
  again.close();
  EXPECT_TRUE(std::ranges::equal(again.tree().leaves(), tree.leaves()));
}

TEST(Octree, UnbalancedTreesAreSeen) {
  DividedCells cells;
  cells.divide(OctreeKey::root());
  cells.divide(OctreeKey::root().child(0));
  cells.divide(OctreeKey::root().child(0).child(7));
  EXPECT_FALSE(cells.tree().is_balanced());
  cells.close();
  EXPECT_TRUE(cells.tree().is_balanced());
}

TEST(OctreeCorners, HangingCornersAreTheMeanOfTheirShares) {
  const Octree tree = example_tree(7);
  const OctreeCorners corners = octree_corners(tree);
  std::size_t hanging = 0;
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    if (!corners.hangs(c)) continue;
    ++hanging;
    double weight = 0;
    Vec3 p;
    for (const auto& s : corners.shares_of(c)) {
      ASSERT_FALSE(corners.hangs(s.corner));
      const auto& u = corners.position[s.corner];
      weight += s.weight;
      p += s.weight * Vec3{double(u[0]), double(u[1]), double(u[2])};
    }
    const auto& u = corners.position[c];
    EXPECT_DOUBLE_EQ(weight, 1);
    EXPECT_EQ(p, (Vec3{double(u[0]), double(u[1]), double(u[2])}));
  }
  EXPECT_GT(hanging, 100u);
}

TEST(InsideFraction, SumsToTheEnclosedVolume) {
  for (const SurfaceMesh& surface : {testing::icosphere(3), testing::torus(40, 20), testing::hollow_sphere(3),
                                     testing::transformed(testing::cube(2), 0.7, {5, 6, 7})}) {
    const RootCube root = RootCube::around(bounding_box(surface.points), 0.1);
    DividedCells cells;
    for (const Vec3 p : surface.points) cells.divide(root.cell(p).ancestor(4));
    cells.close();
    const Octree tree = cells.tree();
    const auto fraction = inside_fractions(root, tree, surface_pieces(root, tree, surface));
    double volume = 0;
    for (std::size_t l = 0; l < tree.size(); ++l) volume += fraction[l] * std::pow(root.side_of(tree.leaf(l)), 3);
    EXPECT_NEAR(volume / enclosed_volume(surface), 1, 0.02);
  }
}

TEST(InsideFraction, KnowsInsideFromOutside) {
  const SurfaceMesh surface = testing::hollow_sphere(4);
  const RootCube root = RootCube::around(bounding_box(surface.points), 0.1);
  DividedCells cells;
  for (const Vec3 p : surface.points) cells.divide(root.cell(p).ancestor(5));
  cells.close();
  const Octree tree = cells.tree();
  const auto fraction = inside_fractions(root, tree, surface_pieces(root, tree, surface));
  for (std::size_t l = 0; l < tree.size(); ++l) {
    const double r = length(root.center_of(tree.leaf(l))), reach = root.side_of(tree.leaf(l));
    if (r > 0.5 + reach && r < 0.98 - reach) {
      EXPECT_EQ(fraction[l], 1) << r;
    }
    if (r > 1 + reach || r < 0.48 - reach) {
      EXPECT_EQ(fraction[l], 0) << r;
    }
  }
}

}  // namespace
}  // namespace octafront
