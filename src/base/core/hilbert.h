#pragma once

#include "base/core/morton.h"

#include <array>
#include <cstdint>

namespace octafront {

/// The place of a cell on the Hilbert curve, whose consecutive cells share a face: 21 bits for each axis (J. Skilling,
/// Programming the Hilbert curve, 2004).
constexpr std::uint64_t hilbert_code(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t kHighest = 1u << 20;
  for (std::uint32_t bit = kHighest; bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& of_axis : x) {
      const std::uint32_t swapped = (of_axis & bit) != 0 ? 0 : (x[0] ^ of_axis) & below;
      if ((of_axis & bit) != 0) x[0] ^= below;
      x[0] ^= swapped;
      of_axis ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t turned = 0;
  for (std::uint32_t bit = kHighest; bit > 1; bit >>= 1)
    if ((x[2] & bit) != 0) turned ^= bit - 1;
  return morton_code(x[2] ^ turned, x[1] ^ turned, x[0] ^ turned);
}

}  // namespace octafront
