#pragma once

#include <cstdint>

namespace octafront {

/// The lowest 21 bits of x, two zeros before each.
constexpr std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// The inverse: every third bit of x, from the lowest on.
constexpr std::uint32_t gather_bits(std::uint64_t x) {
  x &= 0x1249249249249249;
  x = (x ^ x >> 2) & 0x10c30c30c30c30c3;
  x = (x ^ x >> 4) & 0x100f00f00f00f00f;
  x = (x ^ x >> 8) & 0x1f0000ff0000ff;
  x = (x ^ x >> 16) & 0x1f00000000ffff;
  return static_cast<std::uint32_t>((x ^ x >> 32) & 0x1fffff);
}

/// The place of a cell on the Morton (Z-order) curve: bit 0 from x, bit 1 from y, bit 2 from z and so on. 21 bits each.
constexpr std::uint64_t morton_code(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

}  // namespace octafront
