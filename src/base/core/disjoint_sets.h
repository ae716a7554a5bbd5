#pragma once

#include "base/core/shared_value.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace octafront {

/// The numbers 0 ... n - 1 in sets that grow together pair by pair (union-find). The least member stands for its set,
/// whatever the order of the joins.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }
  /// The same, by several threads at a time: what they have joined in the end does not depend on their turns.
  void join_shared(std::uint32_t i, std::uint32_t j) {
    for (;;) {
      i = find_shared(i);
      j = find_shared(j);
      if (i == j) return;
      if (i < j) std::swap(i, j);
      if (SharedValue(parent_[i]).exchange_if(i, j)) return;
    }
  }
  /// While others find and join, too.
  std::uint32_t find_shared(std::uint32_t i) {
    for (;;) {
      const std::uint32_t above = SharedValue(parent_[i]).load();
      if (above == i) return i;
      const std::uint32_t next = SharedValue(parent_[above]).load();
      if (next != above) SharedValue(parent_[i]).store(next);  // a member of the set, nearer to the least
      i = next;
    }
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace octafront
