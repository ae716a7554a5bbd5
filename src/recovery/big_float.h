#pragma once

#include <cstdint>
#include <vector>

namespace octafront::recovery {

/// An exact number m * 2^(64 e) with an integer m of any length: sums, differences and products of doubles never round.
/// The exponent counts whole limbs, so that adding aligns without shifting bits.
class BigFloat {
 public:
  BigFloat() = default;
  /// Exactly `x`, which must be finite.
  explicit BigFloat(double x);

  int sign() const { return limb_.empty() ? 0 : negative_ ? -1 : 1; }
  bool is_zero() const { return limb_.empty(); }
  BigFloat operator-() const;
  friend BigFloat operator+(const BigFloat& a, const BigFloat& b) { return sum(a, b, b.negative_); }
  friend BigFloat operator-(const BigFloat& a, const BigFloat& b) { return sum(a, b, !b.negative_); }
  friend BigFloat operator*(const BigFloat& a, const BigFloat& b);
  /// numerator / denominator as a double, with a relative error below 2^-50. Requires denominator != 0.
  friend double quotient(const BigFloat& numerator, const BigFloat& denominator);

 private:
  using Limbs = std::vector<std::uint64_t>;
  static BigFloat sum(const BigFloat& a, const BigFloat& b, bool b_negative);
  void trim();
  /// The number as mantissa * 2^exponent with mantissa in [2^63, 2^64), truncated.
  void leading_bits(std::uint64_t& mantissa, std::int64_t& exponent) const;

  Limbs limb_;  ///< little endian; neither end is zero
  std::int32_t exponent_ = 0;
  bool negative_ = false;
};

}  // namespace octafront::recovery
