#include "base/geometry/tet_overlap.h"

#include <octafront/tet_mesh.h>

#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"

#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Random = std::mt19937;

double number(Random& random, double lo, double hi) {
  return lo + (hi - lo) * static_cast<double>(random()) / static_cast<double>(Random::max());
}
Vec3 point(Random& random, double lo, double hi) {
  const double x = number(random, lo, hi), y = number(random, lo, hi);
  return {x, y, number(random, lo, hi)};
}

TetCorners positive(TetCorners x) {
  if (orient3d(x[0], x[1], x[2], x[3]) < 0) std::swap(x[0], x[1]);
  return x;
}

TetCorners random_tet(Random& random, double lo, double hi) {
  return positive({point(random, lo, hi), point(random, lo, hi), point(random, lo, hi), point(random, lo, hi)});
}

/// The six tets of a cube around its diagonal, moved as a whole, every inner face shared.
std::vector<TetCorners> cube(Vec3 lo, double edge) {
  const std::array<Vec3, 3> axes{{{edge, 0, 0}, {0, edge, 0}, {0, 0, edge}}};
  const Vec3 hi = lo + axes[0] + axes[1] + axes[2];
  std::vector<TetCorners> all;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (i != k) all.push_back(positive({lo, lo + axes[i], lo + axes[i] + axes[k], hi}));
  return all;
}

TEST(TetOverlap, RegularTetAndItsMirrorImageShareAnOctahedron) {
  const TetPlanes a(positive({{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}}));
  const TetPlanes b(positive({{{-1, -1, -1}, {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}}}));
  EXPECT_NEAR(shared_volume(a, b.corners()), 0.5, 1e-15);
  const TetOverlap both = shared_moments(a, b.corners());
  EXPECT_NEAR(both.share, 0.5, 1e-15);
  EXPECT_LT(length(both.moment + 0.5 * a.corners()[0]), 1e-15);
}

TEST(TetOverlap, OneInsideTheOther) {
  const TetPlanes large(positive({{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}}}));
  const TetPlanes small(positive({{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}}}));
  EXPECT_EQ(shared_volume(small, large.corners()), 1);
  EXPECT_NEAR(shared_volume(large, small.corners()), 1e-3, 1e-18);
  EXPECT_EQ(shared_volume(large, large.corners()), 1);
}

/// Neighbours share faces, edges and corners, on planes that no floating point number lies on: not the least volume.
TEST(TetOverlap, NeighboursShareNothing) {
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    const std::vector<TetCorners> tets = cube(point(random, 0, 1), number(random, 0.1, 3));
    for (std::size_t i = 0; i < tets.size(); ++i)
      for (std::size_t k = 0; k < tets.size(); ++k)
        EXPECT_EQ(shared_volume(TetPlanes(tets[i]), tets[k]), i == k ? 1 : 0);
  }
}

TEST(TetOverlap, PartsAddUpToTheWhole) {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    const TetPlanes tet(random_tet(random, 0.25, 0.75));
    double sum = 0;
    Vec3 moment;
    for (const TetCorners& other : cube({0, 0, 0}, 1)) {
      const TetOverlap part = shared_moments(tet, other);
      EXPECT_NEAR(part.share, shared_volume(tet, other), 1e-14);
      EXPECT_GE(part.share, 0);
      sum += part.share, moment += part.moment;
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_LT(length(moment - (tet.centre() - tet.corners()[0])), 1e-14);
  }
}

TEST(TetOverlap, BothSidesSeeTheSameVolumeAndMiddle) {
  Random random(3);
  int meeting = 0;
  for (int round = 0; round < 2000; ++round) {
    const TetPlanes a(random_tet(random, 0, 1)), b(random_tet(random, 0, 1));
    const TetOverlap ab = shared_moments(a, b.corners()), ba = shared_moments(b, a.corners());
    const double volume = ab.share * a.volume();
    EXPECT_NEAR(volume, ba.share * b.volume(), 1e-15);
    if (volume < 1e-6) continue;
    ++meeting;
    const Vec3 middle = a.corners()[0] + ab.moment / ab.share, other = b.corners()[0] + ba.moment / ba.share;
    EXPECT_LT(length(middle - other), 1e-8);
    EXPECT_TRUE(a.holds(middle) && b.holds(middle));
  }
  EXPECT_GT(meeting, 500);
}

/// Flat as elements hardly ever are, and far from the origin: shares still add up.
TEST(TetOverlap, SliversAddUpToo) {
  Random random(4);
  for (int round = 0; round < 100; ++round) {
    TetCorners flat = random_tet(random, 0.25, 0.75);
    for (Vec3& p : flat) p.z = 0.5 + 1e-9 * (p.z - 0.5);
    for (Vec3& p : flat) p += Vec3{1000, 1000, 0};
    const TetPlanes tet(positive(flat));
    double sum = 0;
    for (const TetCorners& other : cube({1000, 1000, 0}, 1)) sum += shared_volume(tet, other);
    EXPECT_NEAR(sum, 1, 1e-10);
  }
}

TEST(TetOverlap, HeightsHaveExactSigns) {
  Random random(5);
  for (int round = 0; round < 1000; ++round) {
    const TetCorners x = random_tet(random, 0, 1);
    const TetPlanes tet(x);
    // On face 0 as near as rounding allows.
    const double s = number(random, 0, 1), t = number(random, 0, 1 - s);
    const Vec3 p = x[1] + s * (x[2] - x[1]) + t * (x[3] - x[1]);
    const double height = tet.height(0, p);
    EXPECT_EQ((height > 0) - (height < 0), orient3d(x[1], x[2], x[3], p));
  }
}

}  // namespace
}  // namespace octafront
