#include "recovery/big_float.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace octafront::recovery {

namespace {

__extension__ using Wide = unsigned __int128;

}  // namespace

BigFloat::BigFloat(double x) {
  if (x == 0) return;
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(x), &exponent);
  exponent -= 53;
  const auto bits = static_cast<std::uint64_t>(std::ldexp(mantissa, 53));
  exponent_ = exponent >= 0 ? exponent / 64 : -((63 - exponent) / 64);
  const Wide shifted = static_cast<Wide>(bits) << (exponent - 64 * exponent_);
  limb_ = {static_cast<std::uint64_t>(shifted), static_cast<std::uint64_t>(shifted >> 64)};
  negative_ = x < 0;
  trim();
}

void BigFloat::trim() {
  while (!limb_.empty() && limb_.back() == 0) limb_.pop_back();
  std::size_t zeros = 0;
  while (zeros < limb_.size() && limb_[zeros] == 0) ++zeros;
  limb_.erase(limb_.begin(), limb_.begin() + static_cast<std::ptrdiff_t>(zeros));
  exponent_ += static_cast<std::int32_t>(zeros);
}

BigFloat BigFloat::operator-() const {
  BigFloat r = *this;
  r.negative_ = !negative_;
  return r;
}

BigFloat BigFloat::sum(const BigFloat& a, const BigFloat& b, bool b_negative) {
  if (b.is_zero()) return a;
  if (a.is_zero()) {
    BigFloat r = b;
    r.negative_ = b_negative;
    return r;
  }
  const std::int32_t low = std::min(a.exponent_, b.exponent_);
  const auto top = [](const BigFloat& x) { return x.exponent_ + static_cast<std::int32_t>(x.limb_.size()); };
  const auto size = static_cast<std::size_t>(std::max(top(a), top(b)) - low) + 1;
  const auto limb = [low](const BigFloat& x, std::size_t i) -> std::uint64_t {
    const auto k = static_cast<std::int64_t>(i) + low - x.exponent_;
    return k >= 0 && k < static_cast<std::int64_t>(x.limb_.size()) ? x.limb_[static_cast<std::size_t>(k)] : 0;
  };
  BigFloat r;
  r.exponent_ = low;
  r.limb_.resize(size);
  if (a.negative_ == b_negative) {
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const Wide s = static_cast<Wide>(limb(a, i)) + limb(b, i) + carry;
      r.limb_[i] = static_cast<std::uint64_t>(s);
      carry = static_cast<std::uint64_t>(s >> 64);
    }
    r.negative_ = a.negative_;
  } else {
    int order = 0;
    for (std::size_t i = size; i-- > 0 && order == 0;) {
      const std::uint64_t x = limb(a, i), y = limb(b, i);
      order = (x > y) - (x < y);
    }
    if (order == 0) return {};
    const BigFloat& large = order > 0 ? a : b;
    const BigFloat& small = order > 0 ? b : a;
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint64_t x = limb(large, i), y = limb(small, i);
      r.limb_[i] = x - y - borrow;
      borrow = x < y || (x == y && borrow) ? 1 : 0;
    }
    r.negative_ = order > 0 ? a.negative_ : b_negative;
  }
  r.trim();
  return r;
}

BigFloat operator*(const BigFloat& a, const BigFloat& b) {
  BigFloat r;
  if (a.is_zero() || b.is_zero()) return r;
  r.limb_.assign(a.limb_.size() + b.limb_.size(), 0);
  for (std::size_t i = 0; i < a.limb_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.limb_.size(); ++j) {
      const Wide s = static_cast<Wide>(a.limb_[i]) * b.limb_[j] + r.limb_[i + j] + carry;
      r.limb_[i + j] = static_cast<std::uint64_t>(s);
      carry = static_cast<std::uint64_t>(s >> 64);
    }
    r.limb_[i + b.limb_.size()] = carry;
  }
  r.exponent_ = a.exponent_ + b.exponent_;
  r.negative_ = a.negative_ != b.negative_;
  r.trim();
  return r;
}

void BigFloat::leading_bits(std::uint64_t& mantissa, std::int64_t& exponent) const {
  const std::size_t n = limb_.size();
  const int zeros = std::countl_zero(limb_[n - 1]);
  mantissa = limb_[n - 1] << zeros;
  if (zeros > 0 && n > 1) mantissa |= limb_[n - 2] >> (64 - zeros);
  exponent = 64 * (static_cast<std::int64_t>(exponent_) + static_cast<std::int64_t>(n) - 1) - zeros;
}

double quotient(const BigFloat& numerator, const BigFloat& denominator) {
  if (numerator.is_zero()) return 0;
  std::uint64_t n = 0, d = 0;
  std::int64_t en = 0, ed = 0;
  numerator.leading_bits(n, en);
  denominator.leading_bits(d, ed);
  const auto exponent = static_cast<int>(std::clamp<std::int64_t>(en - ed, -5000, 5000));
  const auto q = static_cast<double>(std::ldexp(static_cast<long double>(n) / static_cast<long double>(d), exponent));
  return numerator.negative_ != denominator.negative_ ? -q : q;
}

}  // namespace octafront::recovery
