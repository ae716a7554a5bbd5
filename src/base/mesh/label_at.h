#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace octafront {

/// The number that region, patch or curve n has where it comes from, by its list of labels. Those without one count on
/// behind the largest; without any list from 1.
inline std::int64_t label_at(const std::vector<std::int64_t>& labels, std::size_t n) {
  if (n < labels.size()) return labels[n];
  const std::int64_t last = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end());
  return last + 1 + static_cast<std::int64_t>(n - labels.size());
}

}  // namespace octafront
