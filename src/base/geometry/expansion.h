#pragma once

// Exact arithmetic on sums of doubles. An expansion is a list of nonoverlapping doubles of increasing magnitude whose
// exact sum is the value (Shewchuk 1997). Sizes are bounded at compile time; zeros are dropped.

#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace octafront::exact {

struct TwoDoubles {
  double hi, lo;
};

inline TwoDoubles two_sum(double a, double b) {
  const double s = a + b, bb = s - a, aa = s - bb;
  return {s, (a - aa) + (b - bb)};
}

inline TwoDoubles split(double a) {
  const double c = 134217729.0 * a;  // 2^27 + 1
  const double big = c - a, hi = c - big;
  return {hi, a - hi};
}

inline TwoDoubles two_product(double a, double b) {
  const double p = a * b;
  const TwoDoubles x = split(a), y = split(b);
  return {p, x.lo * y.lo - (((p - x.hi * y.hi) - x.lo * y.hi) - x.hi * y.lo)};
}

// Long expansions, which only insphere has, live on the heap: worker threads may have small stacks.
inline constexpr int kLongestOnStack = 256;

template <int N>
struct Expansion {
  static constexpr bool kOnStack = N <= kLongestOnStack;
  std::conditional_t<kOnStack, std::array<double, N>, std::vector<double>> term;
  int size = 0;

  void push(double t) {
    if (t == 0) return;
    if constexpr (kOnStack)
      term[size] = t;
    else
      term.push_back(t);
    ++size;
  }
  int sign() const { return size == 0 ? 0 : (term[size - 1] > 0) - (term[size - 1] < 0); }
};

inline Expansion<2> difference(double a, double b) {
  Expansion<2> r;
  const TwoDoubles s = two_sum(a, -b);
  r.push(s.lo);
  r.push(s.hi);
  return r;
}

template <int N, int M>
Expansion<N + M> operator+(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<N + M> r;
  int i = 0, j = 0;
  const auto next = [&] {
    if (j >= b.size || (i < a.size && std::abs(a.term[i]) < std::abs(b.term[j]))) return a.term[i++];
    return b.term[j++];
  };
  const int total = a.size + b.size;
  if (total == 0) return r;
  double q = next();
  for (int k = 1; k < total; ++k) {
    const TwoDoubles s = two_sum(q, next());
    q = s.hi;
    r.push(s.lo);
  }
  r.push(q);
  return r;
}

template <int N>
Expansion<N> operator-(Expansion<N> e) {
  for (int i = 0; i < e.size; ++i) e.term[i] = -e.term[i];
  return e;
}

template <int N, int M>
Expansion<N + M> operator-(const Expansion<N>& a, const Expansion<M>& b) {
  return a + (-b);
}

template <int N>
Expansion<2 * N> scale(const Expansion<N>& e, double b) {
  Expansion<2 * N> r;
  if (e.size == 0 || b == 0) return r;
  TwoDoubles p = two_product(e.term[0], b);
  r.push(p.lo);
  double q = p.hi;
  for (int i = 1; i < e.size; ++i) {
    p = two_product(e.term[i], b);
    const TwoDoubles s = two_sum(q, p.lo);
    r.push(s.lo);
    const TwoDoubles t = two_sum(p.hi, s.hi);
    r.push(t.lo);
    q = t.hi;
  }
  r.push(q);
  return r;
}

template <int N, int M>
Expansion<2 * N * M> operator*(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<2 * N * M> r;
  for (int j = 0; j < b.size; ++j) {
    // r + s has at most 2N(j + 1) terms, which fit.
    const auto wide = r + scale(a, b.term[j]);
    r = {};
    for (int i = 0; i < wide.size; ++i) r.push(wide.term[i]);
  }
  return r;
}

}  // namespace octafront::exact
