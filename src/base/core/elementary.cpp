#include "base/core/elementary.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace octafront::elementary {

namespace {

// ln 2 and pi / 2 in parts: products of the first ones with the whole numbers they meet are exact.
constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33;
constexpr double kHalfPiHigh = 0x1.921fb544p+0, kHalfPiMiddle = 0x1.0b4611a6p-34, kHalfPiLow = 0x1.3198a2e037073p-69;
constexpr double kLargest = 709.79, kLeast = -745.2;

/// The values of f at 0, 1, ...: divisions cost ten times as much as all the rest.
template <int kTerms, class F>
constexpr std::array<double, kTerms + 1> table_of(const F& f) {
  std::array<double, kTerms + 1> values{};
  for (int n = 1; n <= kTerms; ++n) values[n] = f(n);
  return values;
}

/// 1 + x + x^2 / 2! + ... for |x| up to ln 2 / 2.
double exp_near_zero(double x) {
  constexpr int kTerms = 14;
  constexpr auto kParts = table_of<kTerms>([](int n) {
    double factorial = 1;
    for (int i = 2; i <= n; ++i) factorial *= i;
    return 1 / factorial;
  });
  double sum = 0;
  for (int n = kTerms; n > 0; --n) sum = x * (kParts[n] + sum);
  return 1 + sum;
}

/// x - x^3 / 3! + ... for |x| up to pi / 4.
double sin_near_zero(double x) {
  constexpr int kTerms = 9;
  constexpr auto kParts = table_of<kTerms>([](int n) { return 1.0 / ((2 * n) * (2 * n + 1)); });
  const double x2 = x * x;
  double sum = 0;
  for (int n = kTerms; n > 0; --n) sum = -x2 * (1 + sum) * kParts[n];
  return x + x * sum;
}

double cos_near_zero(double x) {
  constexpr int kTerms = 9;
  constexpr auto kParts = table_of<kTerms>([](int n) { return 1.0 / ((2 * n - 1) * (2 * n)); });
  const double x2 = x * x;
  double sum = 0;
  for (int n = kTerms; n > 1; --n) sum = -x2 * (1 + sum) * kParts[n];
  return 1 - 0.5 * x2 * (1 + sum);
}

struct Quarter {
  int turns;  ///< modulo 4
  double rest;
};

Quarter quarter_turns(double x) {
  const double k = std::floor(x / (0.5 * std::numbers::pi) + 0.5);
  const double rest = ((x - k * kHalfPiHigh) - k * kHalfPiMiddle) - k * kHalfPiLow;
  return {static_cast<int>(static_cast<std::int64_t>(k) & 3), rest};
}

/// x - x^3 / 3 + x^5 / 5 ... for |x| up to tan(15 degrees).
double atan_near_zero(double x) {
  constexpr int kTerms = 15;
  constexpr auto kParts = table_of<kTerms>([](int n) { return 1.0 / (2 * n + 1); });
  const double x2 = x * x;
  double sum = 0;
  for (int n = kTerms; n > 0; --n) sum = -x2 * (kParts[n] + sum);
  return x + x * sum;
}

/// Of x in [0, 1].
double atan_up_to_one(double x) {
  constexpr double kTan15 = 0.2679491924311227, kSqrt3 = std::numbers::sqrt3;
  if (x <= kTan15) return atan_near_zero(x);
  return std::numbers::pi / 6 + atan_near_zero((kSqrt3 * x - 1) / (kSqrt3 + x));
}

struct Parts {
  double mantissa;  ///< in [sqrt(1/2), sqrt(2))
  int exponent;
};

Parts parts_of(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < std::numbers::sqrt2 / 2) mantissa *= 2, --exponent;
  return {mantissa, exponent};
}

/// 2 (f + f^3 / 3 + f^5 / 5 ...), f = (x - 1) / (x + 1), for x in [sqrt(1/2), sqrt(2)).
double log_near_one(double x) {
  constexpr int kTerms = 12;
  constexpr auto kParts = table_of<kTerms>([](int n) { return 1.0 / (2 * n + 1); });
  const double f = (x - 1) / (x + 1), f2 = f * f;
  double sum = 0;
  for (int n = kTerms; n > 0; --n) sum = f2 * (kParts[n] + sum);
  return 2 * (f + f * sum);
}

bool has_logarithm(double x) {
  return x > 0 && x <= std::numeric_limits<double>::max();
}

double logarithm_of_others(double x) {
  if (x == 0) return -std::numeric_limits<double>::infinity();
  return x > 0 ? x : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double exp(double x) {
  if (!(x < kLargest)) return x > 0 ? std::numeric_limits<double>::infinity() : x;
  if (x < kLeast) return 0;
  const double k = std::floor(x / std::numbers::ln2 + 0.5);
  return std::ldexp(exp_near_zero((x - k * kLn2High) - k * kLn2Low), static_cast<int>(k));
}

double log(double x) {
  if (!has_logarithm(x)) return logarithm_of_others(x);
  const auto [mantissa, exponent] = parts_of(x);
  return exponent * kLn2High + (exponent * kLn2Low + log_near_one(mantissa));
}

double exp2(double x) {
  constexpr double kFar = 1100;
  const double k = std::floor(std::clamp(x, -kFar, kFar) + 0.5);
  return std::ldexp(exp_near_zero((std::clamp(x, -kFar, kFar) - k) * std::numbers::ln2), static_cast<int>(k));
}

double log2(double x) {
  if (!has_logarithm(x)) return logarithm_of_others(x);
  const auto [mantissa, exponent] = parts_of(x);
  return exponent + log_near_one(mantissa) / std::numbers::ln2;
}

double pow(double x, double exponent) {
  return exp(exponent * log(x));
}

double pow(double x, int exponent) {
  double product = 1;
  for (int i = std::abs(exponent); i > 0; --i) product *= x;
  return exponent < 0 ? 1 / product : product;
}

double cbrt(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  const double a = std::abs(x), y = exp(log(a) / 3);
  return std::copysign(y - (y - a / (y * y)) / 3, x);
}

double sin(double x) {
  const auto [turns, rest] = quarter_turns(x);
  const double value = turns % 2 == 0 ? sin_near_zero(rest) : cos_near_zero(rest);
  return turns < 2 ? value : -value;
}

double cos(double x) {
  const auto [turns, rest] = quarter_turns(x);
  const double value = turns % 2 == 0 ? cos_near_zero(rest) : sin_near_zero(rest);
  return turns == 0 || turns == 3 ? value : -value;
}

double tan(double x) {
  return sin(x) / cos(x);
}

double atan2(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y);
  if (ax == 0 && ay == 0) return 0;
  double angle = ay <= ax ? atan_up_to_one(ay / ax) : 0.5 * std::numbers::pi - atan_up_to_one(ax / ay);
  if (x < 0) angle = std::numbers::pi - angle;
  return y < 0 ? -angle : angle;
}

double acos(double x) {
  return atan2(std::sqrt((1 - x) * (1 + x)), x);
}

double hypot(double x, double y) {
  const double a = std::max(std::abs(x), std::abs(y)), b = std::min(std::abs(x), std::abs(y));
  if (a == 0) return 0;
  const double part = b / a;
  return a * std::sqrt(1 + part * part);
}

}  // namespace octafront::elementary
