#pragma once

// Integers of any length, in the plainest way: the oracle of the predicates. Doubles enter as multiples of
// 2^-kFraction.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace octafront::testing {

class BigInteger {
 public:
  BigInteger() = default;
  BigInteger(int value) : BigInteger(static_cast<double>(value), 0) {}
  /// value * 2^fraction, which must be an integer.
  BigInteger(double value, int fraction) {
    int exponent = 0;
    const double mantissa = std::frexp(std::abs(value), &exponent);
    auto bits = static_cast<std::uint64_t>(std::ldexp(mantissa, 53));
    int shift = exponent - 53 + fraction;
    for (; shift < 0; ++shift, bits >>= 1)
      if (bits & 1) throw std::range_error("not a multiple of the unit");
    digits_.assign(static_cast<std::size_t>(shift / 32), 0);
    const int rest = shift % 32;
    const std::uint64_t low = bits << rest, high = rest == 0 ? 0 : bits >> (64 - rest);
    for (const std::uint64_t word : {low, high})
      for (const std::uint64_t half : {word & kMask, word >> 32}) digits_.push_back(static_cast<std::uint32_t>(half));
    negative_ = value < 0;
    trim();
  }

  int sign() const { return digits_.empty() ? 0 : negative_ ? -1 : 1; }

  friend BigInteger operator*(const BigInteger& a, const BigInteger& b) {
    BigInteger r;
    r.digits_.assign(a.digits_.size() + b.digits_.size() + 1, 0);
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j <= b.digits_.size(); ++j) {
        const std::uint64_t digit = j < b.digits_.size() ? b.digits_[j] : 0;
        carry += a.digits_[i] * digit + r.digits_[i + j];
        r.digits_[i + j] = static_cast<std::uint32_t>(carry & kMask);
        carry >>= 32;
      }
    }
    r.negative_ = a.negative_ != b.negative_;
    r.trim();
    return r;
  }
  friend BigInteger operator-(BigInteger a) {
    a.negative_ = !a.negative_;
    return a;
  }
  friend BigInteger operator+(const BigInteger& a, const BigInteger& b) {
    if (a.negative_ == b.negative_) return combined(a, b, 1);
    return less(a, b) ? combined(b, a, -1) : combined(a, b, -1);
  }
  friend BigInteger operator-(const BigInteger& a, const BigInteger& b) { return a + (-b); }

 private:
  static constexpr std::uint64_t kMask = 0xffffffffu;

  static bool less(const BigInteger& a, const BigInteger& b) {
    if (a.digits_.size() != b.digits_.size()) return a.digits_.size() < b.digits_.size();
    return std::lexicographical_compare(a.digits_.rbegin(), a.digits_.rend(), b.digits_.rbegin(), b.digits_.rend());
  }
  // |a| + factor * |b| with the sign of a; not negative.
  static BigInteger combined(BigInteger a, const BigInteger& b, int factor) {
    a.digits_.resize(std::max(a.digits_.size(), b.digits_.size()) + 1, 0);
    std::int64_t carry = 0;
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      const std::int64_t digit = i < b.digits_.size() ? b.digits_[i] : 0;
      carry += a.digits_[i] + factor * digit;
      a.digits_[i] = static_cast<std::uint32_t>(carry & static_cast<std::int64_t>(kMask));
      carry >>= 32;
    }
    a.trim();
    return a;
  }
  void trim() {
    while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
  }

  std::vector<std::uint32_t> digits_;  // lowest first
  bool negative_ = false;
};

}  // namespace octafront::testing
