#include "fill/recovery/exact_points.h"

#include <gtest/gtest.h>

namespace octafront::recovery {
namespace {

// A cavity is given up by this: what lies where others cross is longer than they are.
TEST(ExactPoints, CoordinatesAreLongerAtCrossings) {
  ExactPoints points;
  const VertexIndex a = points.add({0.1, 0, 0}), b = points.add({1, 0.7, 0.3}), c = points.add({0, 0.9, 0});
  const VertexIndex d = points.add({0.3, 0.2, 1}), e = points.add({0.3, 0.5, -1});
  EXPECT_EQ(points.words(a), 1u);
  const VertexIndex half = points.add_between(a, b, 0.5);
  EXPECT_LE(points.words(half), 2u);
  EXPECT_GT(points.words(points.add_crossing(d, e, a, b, c)), points.words(half));
}

}  // namespace
}  // namespace octafront::recovery
