#include "base/geometry/blocks.h"

#include "base/core/random.h"
#include "base/core/thread_limit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Denser towards a corner, as sizes that grade make them.
std::vector<Vec3> graded_points(std::size_t count) {
  Random random(7);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) {
    const auto graded = [&] { return std::pow(random.unit(), 3); };
    p = {3 * graded() - 1, 2 * graded(), graded() + 5};
  }
  return points;
}

Box3 box_of(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points) box.add(p);
  return box;
}

std::vector<std::size_t> sizes_of(const Cells& cells) {
  std::vector<std::size_t> sizes(cells.count, 0);
  for (const std::uint32_t c : cells.of) ++sizes.at(c);
  return sizes;
}

/// Per cell the box of its points.
std::vector<Box3> boxes_of(const std::vector<Vec3>& points, const Cells& cells) {
  std::vector<Box3> boxes(cells.count);
  for (std::size_t i = 0; i < points.size(); ++i) boxes[cells.of[i]].add(points[i]);
  return boxes;
}

TEST(Cells, HoldEachPointOnceAndNoMoreThanAllowed) {
  const std::vector<Vec3> points = graded_points(20000);
  for (int stage = 0; stage < kCellStages; ++stage) {
    const Cells cells = cells_of(points, cube_of_stage(box_of(points), stage), 500);
    ASSERT_EQ(cells.of.size(), points.size());
    const std::vector<std::size_t> sizes = sizes_of(cells);
    EXPECT_LE(*std::ranges::max_element(sizes), 500u);
    EXPECT_GE(*std::ranges::min_element(sizes), 1u);
    EXPECT_LT(cells.count, 4 * points.size() / 500);
  }
}

TEST(Cells, LieApartInSpaceAndInTheOrderOfTheCurve) {
  const std::vector<Vec3> points = graded_points(5000);
  const Cube cube = cube_of_stage(box_of(points), 1);
  const Cells cells = cells_of(points, cube, 100);
  const std::vector<Box3> boxes = boxes_of(points, cells);
  for (std::size_t a = 0; a < boxes.size(); ++a)
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis)
        apart = apart || boxes[a].hi[axis] < boxes[b].lo[axis] || boxes[b].hi[axis] < boxes[a].lo[axis];
      ASSERT_TRUE(apart) << a << " and " << b;
    }
  std::vector<std::uint64_t> last(cells.count, 0);
  for (std::size_t i = 0; i < points.size(); ++i)
    last[cells.of[i]] = std::max(last[cells.of[i]], curve_code(points[i], cube));
  EXPECT_TRUE(std::ranges::is_sorted(last));
}

TEST(Cells, DependOnNoOrderOfThePoints) {
  const std::vector<Vec3> points = graded_points(20000);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random random(3);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  std::vector<Vec3> shuffled;
  for (const std::size_t i : order) shuffled.push_back(points[i]);
  const Cube cube = cube_of_stage(box_of(points), 2);
  const Cells cells = cells_of(points, cube, 300), again = cells_of(shuffled, cube, 300);
  EXPECT_EQ(cells.count, again.count);
  for (std::size_t k = 0; k < order.size(); ++k) ASSERT_EQ(again.of[k], cells.of[order[k]]);
}

TEST(Cells, AreTheSameForAnyNumberOfThreads) {
  const std::vector<Vec3> points = graded_points(40000);
  const Cube cube = cube_of_stage(box_of(points), 3);
  std::vector<std::vector<std::uint32_t>> of;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    of.push_back(cells_of(points, cube, 256).of);
  }
  EXPECT_EQ(of[0], of[1]);
  EXPECT_EQ(of[0], of[2]);
}

TEST(Cells, HoldPointsThatCoincideHoweverManyThereAre) {
  std::vector<Vec3> points(100, Vec3{0.3, 0.3, 0.3});
  points.push_back({0, 0, 0});
  points.push_back({1, 1, 1});
  const Cells cells = cells_of(points, cube_of_stage(box_of(points), 0), 10);
  std::vector<std::size_t> sizes = sizes_of(cells);
  EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 100, 1}));
  const std::vector<Vec3> one(50, Vec3{2, 2, 2});
  EXPECT_EQ(cells_of(one, cube_of_stage(box_of(one), 0), 10).count, 1u);
  EXPECT_EQ(cells_of({}, cube_of_stage({}, 0), 10).count, 0u);
}

TEST(Cells, OfTwoStagesShareNoPlane) {
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  for (int one = 0; one < kCellStages; ++one)
    for (int other = 0; other < one; ++other) {
      const Cube a = cube_of_stage(box, one), b = cube_of_stage(box, other);
      double least = 1;
      for (int i = 0; i <= 64; ++i)
        for (int k = 0; k <= 64; ++k)
          least = std::min(least, std::abs(a.lo.x + a.side * i / 64 - (b.lo.x + b.side * k / 64)));
      const double smaller = std::min(a.side, b.side) / 64;
      EXPECT_GT(least, 0.19 * smaller) << one << " and " << other;
    }
}

TEST(Cells, CubesHoldTheBox) {
  const Box3 box{{-3, 2, 0}, {5, 3, 7}};
  for (int stage = 0; stage < kCellStages; ++stage) {
    const Cube cube = cube_of_stage(box, stage);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(cube.lo[axis], box.lo[axis]);
      EXPECT_GE(cube.lo[axis] + cube.side, box.hi[axis]);
    }
  }
}

TEST(RunInCells, GivesEachItemToItsCellOnceAndWhatIsLeftInOrder) {
  const std::vector<Vec3> points = graded_points(8000);
  // Items: pairs of points that follow each other, in one cell or not.
  std::vector<std::uint32_t> items(points.size() - 1);
  std::iota(items.begin(), items.end(), 0u);
  std::vector<int> visits(items.size(), 0);
  for (int stage = 0; stage < kCellStages; ++stage) {
    const Cells cells = cells_of(points, cube_of_stage(box_of(points), stage), 2000);
    const auto owner = [&](std::uint32_t i) { return cells.holding(std::array{i, i + 1}); };
    const std::vector<std::uint32_t> left = run_in_cells(
        std::span<const std::uint32_t>(items), cells.count, owner,
        [&](std::uint32_t cell, std::span<const std::uint32_t> of_cell, std::vector<std::uint32_t>& later) {
          EXPECT_TRUE(std::ranges::is_sorted(of_cell));
          for (const std::uint32_t i : of_cell) {
            EXPECT_EQ(owner(i), cell);
            if (i % 5 == 0)
              later.push_back(i);
            else
              ++visits[i];
          }
        });
    const auto held = std::ranges::find_if(left, [&](std::uint32_t i) { return owner(i) != kNoOwner; });
    EXPECT_TRUE(std::all_of(held, left.end(), [&](std::uint32_t i) { return i % 5 == 0; }));
    EXPECT_TRUE(
        std::is_sorted(held, left.end(), [&](std::uint32_t a, std::uint32_t b) { return owner(a) < owner(b); }));
    EXPECT_LT(left.size(), items.size());
    items = left;
    std::ranges::sort(items);
  }
  for (const std::uint32_t i : items) EXPECT_EQ(visits[i]++, 0);
  EXPECT_TRUE(std::ranges::all_of(visits, [](int n) { return n == 1; }));
}

}  // namespace
}  // namespace octafront
