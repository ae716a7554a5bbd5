#pragma once

// Numbers of about 106 bits as sums of two doubles, for the middle stage of the predicates: much cheaper than exact
// expansions, and enough for almost all that the first filter leaves open. One operation errs by at most 8 u^2 times
// the sum of the magnitudes of its operands (of their product), u = 2^-53 (M. Joldes, J.-M. Muller, V. Popescu 2017).

#include "base/geometry/expansion.h"

namespace octafront::exact {

struct DoubleDouble {
  double hi = 0, lo = 0;

  DoubleDouble() = default;
  DoubleDouble(TwoDoubles t) : hi(t.hi), lo(t.lo) {}
  int sign() const { return hi != 0 ? (hi > 0) - (hi < 0) : (lo > 0) - (lo < 0); }
};

// Requires |a| >= |b| or a = 0.
inline TwoDoubles quick_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// a - b without error.
inline DoubleDouble exact_difference(double a, double b) {
  return two_sum(a, -b);
}

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const TwoDoubles s = two_sum(a.hi, b.hi);
  return quick_two_sum(s.hi, s.lo + (a.lo + b.lo));
}

inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) {
  const TwoDoubles s = two_sum(a.hi, -b.hi);
  return quick_two_sum(s.hi, s.lo + (a.lo - b.lo));
}

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const TwoDoubles p = two_product(a.hi, b.hi);
  return quick_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

}  // namespace octafront::exact
