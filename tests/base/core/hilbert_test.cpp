#include "base/core/hilbert.h"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(Hilbert, GoesFromEachCellToANeighbour) {
  constexpr std::uint32_t kCells = 16, kSide = (1u << 21) / kCells;
  std::vector<std::pair<std::uint64_t, std::array<std::uint32_t, 3>>> cells;
  for (std::uint32_t x = 0; x < kCells; ++x)
    for (std::uint32_t y = 0; y < kCells; ++y)
      for (std::uint32_t z = 0; z < kCells; ++z)
        cells.push_back({hilbert_code({x * kSide, y * kSide, z * kSide}), {x, y, z}});
  std::sort(cells.begin(), cells.end());
  for (std::size_t i = 1; i < cells.size(); ++i) {
    EXPECT_NE(cells[i].first, cells[i - 1].first);
    int distance = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      distance += std::abs(static_cast<int>(cells[i].second[axis]) - static_cast<int>(cells[i - 1].second[axis]));
    EXPECT_EQ(distance, 1) << i;
  }
}

}  // namespace
}  // namespace octafront
