#pragma once

// Integers of 128 and 256 bits, for the many inputs whose coordinates lie on a lattice: integers, single-precision
// floats, multiples of a unit. Their predicates are exact in a few dozen integer operations.

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace octafront::exact {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 UInt128;

constexpr int sign(Int128 x) {
  return (x > 0) - (x < 0);
}

/// A sum of products of 128-bit integers, exact while it stays within 255 bits.
class Int256 {
 public:
  void add_product(Int128 a, Int128 b) {
    const bool negative = (a < 0) != (b < 0);
    const UInt128 x = a < 0 ? -static_cast<UInt128>(a) : static_cast<UInt128>(a);
    const UInt128 y = b < 0 ? -static_cast<UInt128>(b) : static_cast<UInt128>(b);
    const std::uint64_t x0 = static_cast<std::uint64_t>(x), x1 = static_cast<std::uint64_t>(x >> 64);
    const std::uint64_t y0 = static_cast<std::uint64_t>(y), y1 = static_cast<std::uint64_t>(y >> 64);
    const UInt128 p00 = static_cast<UInt128>(x0) * y0, p01 = static_cast<UInt128>(x0) * y1;
    const UInt128 p10 = static_cast<UInt128>(x1) * y0, p11 = static_cast<UInt128>(x1) * y1;
    const UInt128 middle = (p00 >> 64) + static_cast<std::uint64_t>(p01) + static_cast<std::uint64_t>(p10);
    const UInt128 low = (middle << 64) | static_cast<std::uint64_t>(p00);
    const UInt128 high = p11 + (p01 >> 64) + (p10 >> 64) + (middle >> 64);
    if (negative) {
      high_ -= high + (low_ < low);
      low_ -= low;
    } else {
      low_ += low;
      high_ += high + (low_ < low);
    }
  }

  int sign() const {
    if (static_cast<Int128>(high_) < 0) return -1;
    return (high_ | low_) != 0;
  }

 private:
  UInt128 low_ = 0, high_ = 0;
};

/// The doubles times one power of two, as integers below 2^kLatticeBits in magnitude; nullopt if they are not all on
/// such a lattice. The sign of a polynomial that is homogeneous in them is kept.
inline constexpr int kLatticeBits = 41;

template <std::size_t N>
std::optional<std::array<std::int64_t, N>> on_lattice(const std::array<double, N>& values) {
  double largest = 0;
  for (const double v : values) largest = std::fmax(largest, std::abs(v));
  constexpr int kBias = 1023;
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52);  // biased
  const int scale_exponent = kLatticeBits - 1 - (exponent - kBias) + kBias;
  constexpr int kInfinite = 2 * kBias + 1;
  if (exponent == 0 || exponent == kInfinite || scale_exponent <= 0 || scale_exponent >= kInfinite) return std::nullopt;
  const double scale = std::bit_cast<double>(static_cast<std::uint64_t>(scale_exponent) << 52);
  std::array<std::int64_t, N> integers;
  bool exact = true;
  for (std::size_t i = 0; i < N; ++i) {
    const double scaled = values[i] * scale;
    integers[i] = static_cast<std::int64_t>(scaled);
    exact = exact && static_cast<double>(integers[i]) == scaled;
  }
  if (!exact) return std::nullopt;
  return integers;
}

}  // namespace octafront::exact
