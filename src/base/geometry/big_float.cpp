#include "base/geometry/big_float.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace octafront::exact {

namespace {

__extension__ using Wide = unsigned __int128;

}  // namespace

void Limbs::assign_zero(std::size_t n) {
  size_ = n;
  if (n > kShort) {
    long_.assign(n, 0);
  } else {
    std::fill_n(short_.begin(), n, 0);
  }
}

void Limbs::keep(std::size_t first, std::size_t last) {
  const std::size_t n = last - first;
  if (n == size_) return;
  const std::uint64_t* const from = data() + first;
  if (size_ > kShort && n > kShort) {
    std::copy(from, from + n, long_.begin());
  } else {
    std::copy(from, from + n, short_.begin());
  }
  size_ = n;
}

BigFloat::BigFloat(double x) {
  if (x == 0) return;
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(x), &exponent);
  exponent -= 53;
  const auto bits = static_cast<std::uint64_t>(std::ldexp(mantissa, 53));
  exponent_ = exponent >= 0 ? exponent / 64 : -((63 - exponent) / 64);
  const Wide shifted = static_cast<Wide>(bits) << (exponent - 64 * exponent_);
  limb_.assign_zero(2);
  limb_.data()[0] = static_cast<std::uint64_t>(shifted);
  limb_.data()[1] = static_cast<std::uint64_t>(shifted >> 64);
  negative_ = x < 0;
  trim();
}

void BigFloat::trim() {
  const std::uint64_t* const limb = limb_.data();
  std::size_t first = 0, last = limb_.size();
  while (last > 0 && limb[last - 1] == 0) --last;
  while (first < last && limb[first] == 0) ++first;
  limb_.keep(first, last);
  exponent_ += static_cast<std::int32_t>(first);
}

BigFloat BigFloat::operator-() const {
  BigFloat r = *this;
  r.negative_ = !negative_;
  return r;
}

int BigFloat::compare_magnitude(const BigFloat& a, const BigFloat& b) {
  const auto top = [](const BigFloat& x) { return x.exponent_ + static_cast<std::int32_t>(x.limb_.size()); };
  if (top(a) != top(b)) return top(a) > top(b) ? 1 : -1;
  const std::size_t n = std::max(a.limb_.size(), b.limb_.size());
  for (std::size_t i = 1; i <= n; ++i) {
    const std::uint64_t x = i <= a.limb_.size() ? a.limb_[a.limb_.size() - i] : 0;
    const std::uint64_t y = i <= b.limb_.size() ? b.limb_[b.limb_.size() - i] : 0;
    if (x != y) return x > y ? 1 : -1;
  }
  return 0;
}

BigFloat BigFloat::sum(const BigFloat& a, const BigFloat& b, bool b_negative) {
  if (b.is_zero()) return a;
  if (a.is_zero()) {
    BigFloat r = b;
    r.negative_ = b_negative;
    return r;
  }
  const std::int32_t low = std::min(a.exponent_, b.exponent_);
  const auto shift_a = static_cast<std::size_t>(a.exponent_ - low),
             shift_b = static_cast<std::size_t>(b.exponent_ - low);
  const std::size_t size = std::max(shift_a + a.limb_.size(), shift_b + b.limb_.size()) + 1;
  BigFloat r;
  r.exponent_ = low;
  r.limb_.assign_zero(size);
  std::uint64_t* const out = r.limb_.data();
  const BigFloat* large = &a;
  const BigFloat* small = &b;
  if (a.negative_ != b_negative) {
    const int order = compare_magnitude(a, b);
    if (order == 0) return {};
    if (order < 0) std::swap(large, small);
    r.negative_ = order > 0 ? a.negative_ : b_negative;
  } else {
    r.negative_ = a.negative_;
  }
  std::copy_n(large->limb_.data(), large->limb_.size(), out + (large->exponent_ - low));
  std::uint64_t* const at = out + (small->exponent_ - low);
  const std::uint64_t* const s = small->limb_.data();
  const std::size_t n = small->limb_.size();
  if (a.negative_ == b_negative) {
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < n || carry != 0; ++i) {
      const Wide sum = static_cast<Wide>(at[i]) + (i < n ? s[i] : 0) + carry;
      at[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
  } else {
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < n || borrow != 0; ++i) {
      const std::uint64_t x = at[i], y = i < n ? s[i] : 0;
      at[i] = x - y - borrow;
      borrow = x < y || (x == y && borrow) ? 1 : 0;
    }
  }
  r.trim();
  return r;
}

BigFloat operator*(const BigFloat& a, const BigFloat& b) {
  BigFloat r;
  if (a.is_zero() || b.is_zero()) return r;
  const std::size_t n = a.limb_.size(), m = b.limb_.size();
  r.limb_.assign_zero(n + m);
  const std::uint64_t* const x = a.limb_.data();
  const std::uint64_t* const y = b.limb_.data();
  std::uint64_t* const out = r.limb_.data();
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < m; ++j) {
      const Wide s = static_cast<Wide>(x[i]) * y[j] + out[i + j] + carry;
      out[i + j] = static_cast<std::uint64_t>(s);
      carry = static_cast<std::uint64_t>(s >> 64);
    }
    out[i + m] = carry;
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

namespace {

/// n / d as mantissa * 2^exponent, to the nearest of 64 bits, ties to even; both have their highest bit set. By whole
/// numbers: what long double has differs from machine to machine.
std::uint64_t nearest_quotient(std::uint64_t n, std::uint64_t d, int& exponent) {
  exponent = n >= d ? -63 : -64;
  const Wide scaled = static_cast<Wide>(n) << -exponent;
  auto q = static_cast<std::uint64_t>(scaled / d);
  const auto rest = static_cast<std::uint64_t>(scaled % d);
  const bool is_up = rest > d - rest || (rest == d - rest && q % 2 == 1);
  if (!is_up) return q;
  if (++q != 0) return q;
  ++exponent;
  return std::uint64_t{1} << 63;
}

}  // namespace

double quotient(const BigFloat& numerator, const BigFloat& denominator) {
  if (numerator.is_zero()) return 0;
  std::uint64_t n = 0, d = 0;
  std::int64_t en = 0, ed = 0;
  numerator.leading_bits(n, en);
  denominator.leading_bits(d, ed);
  const auto exponent = static_cast<int>(std::clamp<std::int64_t>(en - ed, -5000, 5000));
  int of_quotient = 0;
  const auto mantissa = static_cast<double>(nearest_quotient(n, d, of_quotient));
  const double q = std::ldexp(mantissa, exponent + of_quotient);
  return numerator.negative_ != denominator.negative_ ? -q : q;
}

}  // namespace octafront::exact
