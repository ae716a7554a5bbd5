#pragma once

// Integers of fixed width, for the many inputs whose coordinates lie on a lattice: integers, single-precision floats,
// multiples of a unit. Their predicates are exact in a few dozen integer operations.

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

/// A two's complement integer of N 64-bit limbs, lowest first. Exact while it stays within 64 N - 1 bits.
template <std::size_t N>
class WideInteger {
 public:
  WideInteger() = default;
  WideInteger(Int128 x) {
    limb_[0] = static_cast<std::uint64_t>(x);
    for (std::size_t i = 1; i < N; ++i) limb_[i] = static_cast<std::uint64_t>(i == 1 ? x >> 64 : x >> 127);
  }

  /// Adds a * b.
  template <std::size_t A, std::size_t B>
  void add_product(const WideInteger<A>& a, const WideInteger<B>& b) {
    static_assert(A + B <= N);
    const auto x = a.magnitude();
    const auto y = b.magnitude();
    std::array<std::uint64_t, N> product{};
    for (std::size_t i = 0; i < A; ++i) {
      UInt128 carry = 0;
      for (std::size_t j = 0; j < B; ++j) {
        carry += static_cast<UInt128>(x[i]) * y[j] + product[i + j];
        product[i + j] = static_cast<std::uint64_t>(carry);
        carry >>= 64;
      }
      product[i + B] = static_cast<std::uint64_t>(carry);
    }
    // Subtraction adds the complement and one.
    const std::uint64_t flip = a.is_negative() != b.is_negative() ? ~std::uint64_t{0} : 0;
    UInt128 carry = flip & 1;
    for (std::size_t i = 0; i < N; ++i) {
      carry += static_cast<UInt128>(limb_[i]) + (product[i] ^ flip);
      limb_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
  }

  int sign() const {
    if (is_negative()) return -1;
    std::uint64_t any = 0;
    for (const std::uint64_t l : limb_) any |= l;
    return any != 0;
  }
  bool is_negative() const { return limb_[N - 1] >> 63 != 0; }
  std::array<std::uint64_t, N> magnitude() const {
    std::array<std::uint64_t, N> m{};
    const std::uint64_t flip = is_negative() ? ~std::uint64_t{0} : 0;
    UInt128 carry = flip & 1;
    for (std::size_t i = 0; i < N; ++i) {
      carry += limb_[i] ^ flip;
      m[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return m;
  }

 private:
  std::array<std::uint64_t, N> limb_{};
};

/// The doubles times one power of two, as integers below 2^kBits in magnitude; nullopt if they are not all on such a
/// lattice. The sign of a polynomial that is homogeneous in them is kept.
template <int kBits, std::size_t N>
std::optional<std::array<std::int64_t, N>> on_lattice(const std::array<double, N>& values) {
  static_assert(kBits <= 62);
  double largest = 0;
  for (const double v : values) largest = std::fmax(largest, std::abs(v));
  constexpr int kBias = 1023, kInfinite = 2 * kBias + 1;
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52);  // biased
  const int scale_exponent = kBits - 1 - (exponent - kBias) + kBias;
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
