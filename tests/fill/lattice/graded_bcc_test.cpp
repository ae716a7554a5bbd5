#include "fill/lattice/graded_bcc.h"

#include <octafront/quality.h>

#include "base/geometry/predicates.h"

#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Sites = std::array<LatticeSite, 4>;

Octree random_tree(unsigned seed, int cells, int deepest) {
  std::mt19937 random(seed);
  DividedCells divided;
  for (int level = 0; level < 2; ++level)
    for (std::uint32_t z = 0; z < 1u << level; ++z)
      for (std::uint32_t y = 0; y < 1u << level; ++y)
        for (std::uint32_t x = 0; x < 1u << level; ++x) {
          const std::uint32_t s = OctreeKey::kSide >> level;
          divided.divide(OctreeKey::containing(x * s, y * s, z * s, level));
        }
  std::uniform_int_distribution<std::uint32_t> unit(0, OctreeKey::kSide - 1);
  std::uniform_int_distribution<int> level(1, deepest);
  for (int i = 0; i < cells; ++i)
    divided.divide(OctreeKey::containing(unit(random), unit(random), unit(random), level(random)));
  divided.close();
  return divided.tree();
}

std::vector<Sites> tets_of(const Octree& tree) {
  std::vector<Sites> tets;
  for_each_lattice_tet(tree, [&](const Sites& t) { tets.push_back(t); });
  return tets;
}

std::array<Vec3, 4> corners(const RootCube& root, const Sites& t) {
  return {position(root, t[0]), position(root, t[1]), position(root, t[2]), position(root, t[3])};
}

TEST(GradedBcc, UniformLatticeHasOneShape) {
  const Octree tree = random_tree(1, 0, 1);
  ASSERT_EQ(tree.size(), 64u);
  const RootCube root{{0, 0, 0}, 1};
  const std::vector<Sites> tets = tets_of(tree);
  EXPECT_EQ(tets.size(), 3u * 3 * 16 * 4);  // 3 axes, 3 inner planes, 16 faces, 4 edges
  for (const Sites& t : tets) {
    const auto [a, b, c, d] = corners(root, t);
    EXPECT_NEAR(radius_ratio(a, b, c, d), 0.9486832980505138, 1e-12);  // 3 / sqrt(10)
  }
}

// Positive, conforming, filling all but the half-cells at the wall of the root.
TEST(GradedBcc, IsAConformingMeshOnAnyBalancedTree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Octree tree = random_tree(seed, 30, 6);
    const RootCube root{{0, 0, 0}, 1};
    std::map<std::array<LatticeSite, 3>, int> faces;
    double volume = 0;
    for (const Sites& t : tets_of(tree)) {
      const auto [a, b, c, d] = corners(root, t);
      ASSERT_EQ(orient3d(a, b, c, d), 1);
      EXPECT_GT(radius_ratio(a, b, c, d), 0.5);
      volume += dot(cross(b - a, c - a), d - a) / 6;
      for (int i = 0; i < 4; ++i) {
        std::array<LatticeSite, 3> key{t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4]};
        std::sort(key.begin(), key.end());
        EXPECT_LE(++faces[key], 2);
      }
    }
    double open_volume = 0;  // pyramids from the centre of each leaf to its faces on the wall
    for (const OctreeKey leaf : tree.leaves())
      for (int axis = 0; axis < 3; ++axis)
        for (const std::uint32_t x : {leaf.corner()[axis], OctreeKey::kSide - leaf.corner()[axis] - leaf.side()})
          if (x == 0) open_volume += std::pow(root.side_of(leaf), 3) / 6;
    EXPECT_NEAR(volume + open_volume, 1, 1e-9);
    // A face that belongs to one tet bounds one of those pyramids: it holds a centre and two corners on the wall.
    for (const auto& [key, count] : faces) {
      if (count == 2) continue;
      int on_wall = 0;
      for (const LatticeSite s : key) {
        const auto c = unpack_site(s);
        on_wall += std::any_of(c.begin(), c.end(), [](std::uint32_t x) { return x == 0 || x == OctreeKey::kSide; });
      }
      EXPECT_GE(on_wall, 2);
    }
  }
}

}  // namespace
}  // namespace octafront
