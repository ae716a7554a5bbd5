#include "fill/front/meeting.h"

#include <octafront/tet_mesh.h>

#include "base/geometry/predicates.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using TetCorners = std::array<NamedPoint, 4>;
using NamedCorners = std::array<NamedPoint, 3>;

const TetCorners kUnit{{{0, {0, 0, 0}}, {1, {1, 0, 0}}, {2, {0, 1, 0}}, {3, {0, 0, 1}}}};

TEST(Meeting, ATetrahedronsOwnFacesAreShared) {
  for (const auto& f : kTetFaces) {
    EXPECT_FALSE(meets_beyond_shared_simplex(kUnit, {kUnit[f[0]], kUnit[f[1]], kUnit[f[2]]}));
    EXPECT_FALSE(meets_beyond_shared_simplex(kUnit, {kUnit[f[0]], kUnit[f[2]], kUnit[f[1]]}));
  }
}

TEST(Meeting, ATriangleInsideMeets) {
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{{7, {0.1, 0.1, 0.1}}, {8, {0.2, 0.1, 0.1}}, {9, {0.1, 0.2, 0.1}}}}));
}

TEST(Meeting, ATriangleAroundMeets) {
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{{7, {-9, -9, 0.2}}, {8, {9, -9, 0.2}}, {9, {0, 9, 0.2}}}}));
}

TEST(Meeting, TouchingWithoutSharingMeets) {
  // A corner on a face, a corner at a corner of another id, an edge along an edge, a coplanar overlap.
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{{7, {0.2, 0.2, 0}}, {8, {0, 0, -1}}, {9, {1, 0, -1}}}}));
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{{7, {0, 0, 0}}, {8, {-1, 0, 0}}, {9, {0, -1, 0}}}}));
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{{7, {0.25, 0, 0}}, {8, {0.5, 0, 0}}, {9, {0.5, -1, 0}}}}));
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{{7, {-1, -1, 0}}, {8, {3, -1, 0}}, {9, {-1, 3, 0}}}}));
}

TEST(Meeting, CoplanarNeighboursOfABaseDoNotMeet) {
  // All around the base's corner in the base's plane, sharing a corner or an edge: decided by orient2d alone.
  EXPECT_FALSE(meets_beyond_shared_simplex(kUnit, {{kUnit[0], kUnit[1], {9, {1, -1, 0}}}}));
  EXPECT_FALSE(meets_beyond_shared_simplex(kUnit, {{kUnit[0], {8, {-1, 0, 0}}, {9, {0, -1, 0}}}}));
  EXPECT_FALSE(meets_beyond_shared_simplex(kUnit, {{kUnit[1], {8, {2, 0, 0}}, {9, {1, 1, 0}}}}));
  // The same fan turned into the base overlaps it.
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{kUnit[0], {8, {0.5, 0, 0}}, {9, {0, -1, 0}}}}));
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{kUnit[0], {8, {2, 1, 0}}, {9, {1, 2, 0}}}}));
}

TEST(Meeting, SharedEdgeOpensLikeABook) {
  EXPECT_FALSE(meets_beyond_shared_simplex(kUnit, {{kUnit[0], kUnit[3], {9, {-1, -1, 0.5}}}}));
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{kUnit[0], kUnit[3], {9, {1, 1, 0.5}}}}));
  EXPECT_TRUE(meets_beyond_shared_simplex(kUnit, {{kUnit[0], kUnit[3], {9, {1, 0, 0.5}}}}));
}

/// Some point of a fine barycentric grid of the triangle lies in the tetrahedron, away from the shared simplex.
bool sampled_meeting(const TetCorners& t, const NamedCorners& f) {
  constexpr int kSteps = 12;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j) {
      const int weight[3] = {i, j, kSteps - i - j};
      bool only_shared = true;
      for (int k = 0; k < 3; ++k)
        if (weight[k] > 0)
          only_shared =
              only_shared && std::any_of(t.begin(), t.end(), [&](const NamedPoint& p) { return p.id == f[k].id; });
      if (only_shared) continue;
      Vec3 p;  // kSteps times the point: integers, so exact
      for (int k = 0; k < 3; ++k) p += f[k].at * weight[k];
      bool inside = true;
      for (const auto& c : kTetFaces)
        inside = inside && orient3d(t[c[0]].at * kSteps, t[c[1]].at * kSteps, t[c[2]].at * kSteps, p) <= 0;
      if (inside) return true;
    }
  return false;
}

TEST(Meeting, AgreesWithSamplingOnASmallLattice) {
  std::mt19937 random(20260214);
  std::uniform_int_distribution<int> coordinate(0, 3);
  const auto point = [&] {
    const double x = coordinate(random), y = coordinate(random);
    return Vec3{x, y, static_cast<double>(coordinate(random))};
  };
  int meetings = 0, separate = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    TetCorners t;
    NamedCorners f;
    // Equal points get equal ids: seven corners share what they share.
    const auto named = [](Vec3 p) { return NamedPoint{static_cast<std::uint32_t>(p.x + 4 * p.y + 16 * p.z), p}; };
    for (auto& c : t) c = named(point());
    for (auto& c : f) c = named(point());
    if (orient3d(t[0].at, t[1].at, t[2].at, t[3].at) <= 0 || collinear(f[0].at, f[1].at, f[2].at)) continue;
    const bool meets = meets_beyond_shared_simplex(t, f);
    ++(meets ? meetings : separate);
    if (sampled_meeting(t, f)) {
      EXPECT_TRUE(meets) << "trial " << trial;
    }
    std::rotate(f.begin(), f.begin() + 1, f.end());
    EXPECT_EQ(meets, meets_beyond_shared_simplex({t[1], t[2], t[0], t[3]}, f)) << "trial " << trial;
    std::swap(f[0], f[1]);
    EXPECT_EQ(meets, meets_beyond_shared_simplex({t[1], t[0], t[3], t[2]}, f)) << "trial " << trial;
  }
  EXPECT_GT(meetings, 500);
  EXPECT_GT(separate, 500);
}

// The unit tetrahedron is the positive octant around its corner: the triangle meets it where a point of the side
// opposite has no negative coordinate.
TEST(Meeting, OfConesAroundOneSharedCornerIsSeenFromTheCorner) {
  std::mt19937 random(20261123);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&] {
    const double x = coordinate(random), y = coordinate(random);
    return Vec3{x, y, coordinate(random)};
  };
  int meetings = 0, separate = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 p = point(), q = point();
    double least = 0, most = 1;  // of the part of the way from p to q
    for (int axis = 0; axis < 3; ++axis) {
      const double root = p[axis] / (p[axis] - q[axis]);
      if (p[axis] < 0) least = std::max(least, q[axis] < 0 ? 2 : root);
      if (p[axis] >= 0 && q[axis] < 0) most = std::min(most, root);
    }
    const bool meets = least <= most;
    ++(meets ? meetings : separate);
    for (const auto& order : {std::array{0, 1, 2, 3}, {1, 2, 0, 3}, {1, 0, 3, 2}, {1, 2, 3, 0}}) {
      // The last order is odd: the tetrahedron is turned by its other corners.
      TetCorners t{kUnit[order[0]], kUnit[order[1]], kUnit[order[2]], kUnit[order[3]]};
      if (orient3d(t[0].at, t[1].at, t[2].at, t[3].at) < 0) std::swap(t[0], t[1]);
      NamedCorners f{{kUnit[0], {8, p}, {9, q}}};
      for (int turn = 0; turn < 3; ++turn) {
        ASSERT_EQ(meets_beyond_shared_simplex(t, f), meets) << "trial " << trial;
        std::rotate(f.begin(), f.begin() + 1, f.end());
      }
      std::swap(f[1], f[2]);
      ASSERT_EQ(meets_beyond_shared_simplex(t, f), meets) << "trial " << trial;
    }
  }
  EXPECT_GT(meetings, 3000);
  EXPECT_GT(separate, 3000);
}

}  // namespace
}  // namespace octafront
