#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace octafront::exact {

/// Little-endian limbs of an integer; short ones live inside the object.
class Limbs {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::uint64_t* data() { return size_ > kShort ? long_.data() : short_.data(); }
  const std::uint64_t* data() const { return size_ > kShort ? long_.data() : short_.data(); }
  std::uint64_t operator[](std::size_t i) const { return data()[i]; }
  std::uint64_t back() const { return data()[size_ - 1]; }
  /// `n` limbs, all zero.
  void assign_zero(std::size_t n);
  /// Keeps the limbs [first, last).
  void keep(std::size_t first, std::size_t last);

 private:
  static constexpr std::size_t kShort = 14;
  std::size_t size_ = 0;
  std::array<std::uint64_t, kShort> short_;
  std::vector<std::uint64_t> long_;
};

/// An exact number m * 2^(64 e) with an integer m of any length: sums, differences and products of doubles never round.
/// The exponent counts whole limbs, so that adding aligns without shifting bits.
class BigFloat {
 public:
  BigFloat() = default;
  /// Exactly `x`, which must be finite.
  explicit BigFloat(double x);

  int sign() const { return limb_.empty() ? 0 : negative_ ? -1 : 1; }
  /// Words of 64 bits of its integer.
  std::size_t words() const { return limb_.size(); }
  bool is_zero() const { return limb_.empty(); }
  BigFloat operator-() const;
  friend BigFloat operator+(const BigFloat& a, const BigFloat& b) { return sum(a, b, b.negative_); }
  friend BigFloat operator-(const BigFloat& a, const BigFloat& b) { return sum(a, b, !b.negative_); }
  friend BigFloat operator*(const BigFloat& a, const BigFloat& b);
  /// numerator / denominator as a double, with a relative error below 2^-50. Requires denominator != 0.
  friend double quotient(const BigFloat& numerator, const BigFloat& denominator);

 private:
  static int compare_magnitude(const BigFloat& a, const BigFloat& b);
  static BigFloat sum(const BigFloat& a, const BigFloat& b, bool b_negative);
  void trim();
  /// The number as mantissa * 2^exponent with mantissa in [2^63, 2^64), truncated.
  void leading_bits(std::uint64_t& mantissa, std::int64_t& exponent) const;

  Limbs limb_;  ///< little endian; neither end is zero
  std::int32_t exponent_ = 0;
  bool negative_ = false;
};

}  // namespace octafront::exact
