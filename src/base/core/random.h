#pragma once

#include <cstdint>

namespace octafront {

/// Random numbers from a fixed seed, the same on every machine: the linear congruential generator MMIX (D. E. Knuth).
/// Its low bits are poor; only the upper ones are used.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// From 0 to n - 1. REQUIRES: 0 < n < 2^31.
  std::uint32_t below(std::uint64_t n) { return static_cast<std::uint32_t>((next() >> 33) % n); }
  /// In [0, 1).
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }

 private:
  std::uint64_t next() { return state_ = state_ * 6364136223846793005u + 1442695040888963407u; }

  std::uint64_t state_;
};

/// The bits of x thoroughly mixed (the finaliser of SplitMix64): a random number for each number.
constexpr std::uint64_t mixed_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace octafront
