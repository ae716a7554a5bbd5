#pragma once

#include <cstdint>

namespace octafront {

/// Numbers as whole multiples of 2^-29: their sums depend on no order, so what is decided by one is the same however
/// its parts are kept and by whomever they are added up. Holds the sum of 2^30 numbers below 16.
using Fixed = std::int64_t;

inline constexpr double kFixedUnit = 0x1p-29;

/// Rounded towards zero.
inline Fixed to_fixed(double x) {
  return static_cast<Fixed>(x / kFixedUnit);
}
inline double from_fixed(Fixed x) {
  return static_cast<double>(x) * kFixedUnit;
}

}  // namespace octafront
