#pragma once

#include <octafront/ranks.h>

#include <functional>

namespace octafront {

/// Runs rank(ranks) `count` times at a time, each on a thread of its own with a Ranks that speaks to the others: as MPI
/// would with processes. For tests of what must not depend on ranks. A rank that ends while others wait for it makes
/// them throw a RankFailure. Throws what the first rank, by number, threw.
void run_virtual_ranks(int count, const std::function<void(Ranks&)>& rank);

}  // namespace octafront
