#include "base/geometry/triangle_intersection.h"

#include "base/geometry/predicates.h"
#include "base/geometry/rational_oracle.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

using testing::rational;
using testing::RationalPoint;

// Random choices from one seed, so that RapidCheck shrinks a number and not thousands of draws.
class Choice {
 public:
  Choice() : random_(*rc::gen::resize(100, rc::gen::arbitrary<std::uint64_t>())) {}
  int integer(int lo, int hi) { return std::uniform_int_distribution(lo, hi)(random_); }

  // Points on a lattice so small that every degeneracy is common, often all in one plane.
  std::vector<Vec3> points(int n) {
    const int range = 1 << integer(0, 2);
    const bool flat = integer(0, 4) == 0;
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) {
      const int x = integer(-range, range), y = integer(-range, range), z = flat ? x - y : integer(-range, range);
      points.push_back({double(x), double(y), double(z)});
    }
    return points;
  }

 private:
  std::mt19937_64 random_;
};

// Two triangles with `shared` common vertices: ids 0 ... shared - 1.
struct Pair {
  std::vector<Vec3> points;
  Triangle s, t;

  Pair(Choice& choice, int shared) : points(choice.points(6 - shared)), s{0, 1, 2} {
    for (int i = 0; i < 3; ++i) t[i] = static_cast<VertexIndex>(i < shared ? i : 3 + i - shared);
    // Any corner may come first and either side face up.
    for (Triangle* turned : {&s, &t}) {
      std::rotate(turned->begin(), turned->begin() + choice.integer(0, 2), turned->end());
      if (choice.integer(0, 1) == 0) std::swap((*turned)[0], (*turned)[1]);
    }
  }
};

std::array<Vec3, 3> corners(const Pair& p, const Triangle& t) {
  return {p.points[t[0]], p.points[t[1]], p.points[t[2]]};
}

bool degenerate(const std::array<Vec3, 3>& t) {
  return collinear(t[0], t[1], t[2]);
}

bool oracle_conflict(const Pair& p, int shared) {
  const auto s = corners(p, p.s), t = corners(p, p.t);
  const auto common = testing::intersection_with_triangle({rational(s[0]), rational(s[1]), rational(s[2])}, t);
  return std::any_of(common.begin(), common.end(), [&](const RationalPoint& x) {
    if (shared == 0) return true;
    return !testing::on_segment(x, p.points[0], p.points[shared - 1]);
  });
}

// RapidCheck's hundred cases are few for a lattice of degeneracies: each case looks at many pairs.
constexpr int kPairs = 200;

void expect_oracle_agrees(int shared) {
  Choice choice;
  for (int i = 0; i < kPairs; ++i) {
    const Pair p(choice, shared);
    if (degenerate(corners(p, p.s)) || degenerate(corners(p, p.t))) continue;
    const bool conflict = oracle_conflict(p, shared);
    RC_ASSERT(triangles_conflict(p.points, p.s, p.t) == conflict);
    RC_ASSERT(triangles_conflict(p.points, p.t, p.s) == conflict);
    if (shared == 0) RC_ASSERT(triangles_meet(corners(p, p.s), corners(p, p.t)) == conflict);
  }
}

RC_GTEST_PROP(TrianglesConflict, AgreesWithRationalsWhenNothingIsShared, ()) {
  expect_oracle_agrees(0);
}

RC_GTEST_PROP(TrianglesConflict, AgreesWithRationalsAtASharedVertex, ()) {
  expect_oracle_agrees(1);
}

RC_GTEST_PROP(TrianglesConflict, AgreesWithRationalsAtASharedEdge, ()) {
  expect_oracle_agrees(2);
}

TEST(TrianglesConflict, SeesItselfAndDuplicates) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_TRUE(triangles_conflict(points, {0, 1, 2}, {0, 1, 2}));
  EXPECT_TRUE(triangles_conflict(points, {0, 1, 2}, {2, 1, 0}));
  EXPECT_TRUE(triangles_conflict(points, {0, 1, 2}, {3, 4, 5}));
}

TEST(TrianglesConflict, SeparatesByOneUlp) {
  const double above = std::nextafter(1.0, 2.0);
  const std::vector<Vec3> points{{0, 0, 1}, {9, 0, 1}, {0, 9, 1}, {1, 1, above}, {2, 1, 2}, {1, 2, 3}};
  EXPECT_FALSE(triangles_conflict(points, {0, 1, 2}, {3, 4, 5}));
  auto touching = points;
  touching[3].z = 1;
  EXPECT_TRUE(triangles_conflict(touching, {0, 1, 2}, {3, 4, 5}));
}

TEST(TrianglesConflict, TellsATriangleFoldedOntoItsNeighbourFromOneUlpAbove) {
  // All in the plane z = x - y, the second triangle inside the first.
  std::vector<Vec3> points{{0, 0, 0}, {8, 1, 7}, {1, 8, -7}, {2, 3, -1}};
  EXPECT_TRUE(triangles_conflict(points, {0, 1, 2}, {1, 0, 3}));
  points[3].z = std::nextafter(points[3].z, 0);
  EXPECT_FALSE(triangles_conflict(points, {0, 1, 2}, {1, 0, 3}));
}

bool oracle_segment_meets(Vec3 p, Vec3 q, const std::array<Vec3, 3>& t) {
  return !testing::intersection_with_triangle({rational(p), rational(q)}, t).empty();
}

RC_GTEST_PROP(SegmentTriangleHit, AgreesWithRationals, ()) {
  Choice choice;
  for (int i = 0; i < kPairs; ++i) {
    const auto x = choice.points(5);
    const std::array<Vec3, 3> t{x[0], x[1], x[2]};
    if (degenerate(t)) continue;
    const SegmentHit hit = segment_triangle_hit(x[3], x[4], t);
    RC_ASSERT(static_cast<bool>(hit) == oracle_segment_meets(x[3], x[4], t));
    if (hit.kind != SegmentHit::Kind::kPoint) continue;
    const auto common = testing::intersection_with_triangle({rational(x[3]), rational(x[4])}, t);
    for (const RationalPoint& c : common) {
      RC_ASSERT(c == common.front());
      int edges = 0;
      for (int e = 0; e < 3; ++e) edges += testing::on_segment(c, t[(e + 1) % 3], t[(e + 2) % 3]);
      RC_ASSERT(edges == static_cast<int>(hit.part));
      if (hit.part == SegmentHit::Part::kEdge)
        RC_ASSERT(testing::on_segment(c, t[(hit.index + 1) % 3], t[(hit.index + 2) % 3]));
      if (hit.part == SegmentHit::Part::kCorner) RC_ASSERT(c == rational(t[hit.index]));
      RC_ASSERT((c == rational(x[3])) == (hit.end == 0));
      RC_ASSERT((c == rational(x[4])) == (hit.end == 1));
    }
  }
}

}  // namespace
}  // namespace octafront
