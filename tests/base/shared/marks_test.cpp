#include "base/shared/marks.h"

#include "base/core/random.h"
#include "base/shared/virtual_ranks.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// What each of so many ranks marks.
std::vector<std::vector<std::uint8_t>> random_marks(std::size_t ranks, std::size_t count, std::uint32_t one_in) {
  Random random(ranks * 1000 + count + one_in);
  std::vector<std::vector<std::uint8_t>> marks(ranks, std::vector<std::uint8_t>(count, 0));
  for (auto& of_rank : marks)
    for (std::uint8_t& mark : of_rank) mark = random.below(one_in) == 0;
  return marks;
}

TEST(Marks, AreThoseOfAnyAndOfSeveral) {
  for (const std::size_t ranks : {1u, 2u, 3u, 8u})
    for (const std::size_t count : {0u, 1u, 7u, 1000u})
      for (const std::uint32_t one_in : {1u, 2u, 200u}) {
        const auto marks = random_marks(ranks, count, one_in);
        std::vector<std::uint8_t> any(count, 0), several(count, 0);
        for (const auto& of_rank : marks)
          for (std::size_t i = 0; i < count; ++i) {
            several[i] |= any[i] & of_rank[i];
            any[i] |= of_rank[i];
          }
        run_virtual_ranks(static_cast<int>(ranks), [&](Ranks& here) {
          const Comm comm(&here);
          std::vector<std::uint8_t> mine = marks[static_cast<std::size_t>(here.rank())];
          EXPECT_EQ(marked_by_several(comm, mine, "marks"), several);
          join_marks(comm, mine, "marks");
          EXPECT_EQ(mine, any);
        });
      }
}

}  // namespace
}  // namespace octafront
