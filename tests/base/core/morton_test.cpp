#include "base/core/morton.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

std::uint64_t interleaved_bit_by_bit(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  std::uint64_t code = 0;
  for (int bit = 0; bit < 21; ++bit)
    code |= (x >> bit & 1) << 3 * bit | (y >> bit & 1) << (3 * bit + 1) | (z >> bit & 1) << (3 * bit + 2);
  return code;
}

TEST(Morton, CodeInterleavesTheBits) {
  testing::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t x = random.bits() & 0x1fffff, y = random.bits() & 0x1fffff, z = random.bits() & 0x1fffff;
    const std::uint64_t code = morton_code(x, y, z);
    ASSERT_EQ(code, interleaved_bit_by_bit(x, y, z));
    ASSERT_EQ(gather_bits(code), x);
    ASSERT_EQ(gather_bits(code >> 1), y);
    ASSERT_EQ(gather_bits(code >> 2), z);
  }
}

}  // namespace
}  // namespace octafront
