#pragma once

// Sums whose rounding errors do not grow with the number of terms: A. Neumaier, Rundungsfehleranalyse einiger Verfahren
// zur Summation endlicher Summen, 1974.

#include "base/geometry/expansion.h"

#include <cstddef>
#include <vector>

namespace octafront::adapt {

struct CarefulSum {
  double sum = 0, rest = 0;

  void add(double term) {
    const exact::TwoDoubles s = exact::two_sum(sum, term);
    sum = s.hi, rest += s.lo;
  }
  CarefulSum& operator+=(const CarefulSum& more) {
    add(more.sum);
    rest += more.rest;
    return *this;
  }
  double value() const { return sum + rest; }
};

/// Of several things at a time, as parallel_sum() adds them up.
struct CarefulSums {
  std::vector<CarefulSum> all;

  CarefulSums() = default;
  explicit CarefulSums(std::size_t n) : all(n) {}
  CarefulSum& operator[](std::size_t i) { return all[i]; }
  CarefulSums& operator+=(const CarefulSums& more) {
    if (all.empty()) all.resize(more.all.size());
    for (std::size_t i = 0; i < more.all.size(); ++i) all[i] += more.all[i];
    return *this;
  }
};

}  // namespace octafront::adapt
