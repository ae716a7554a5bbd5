#pragma once

// Arrays that several threads make: nothing is zeroed, copied or numbered by one of them.

#include "base/core/parallel.h"
#include "base/core/system_memory.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace octafront {

/// Numbers that one thread looks at in a row.
inline constexpr std::size_t kNumbersAtOnce = 4096;

/// A copy that several threads make.
template <class All>
RawVector<typename All::value_type> parallel_copy(const All& from) {
  RawVector<typename All::value_type> copy(from.size());
  parallel_ranges(from.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
    std::copy(from.begin() + static_cast<std::ptrdiff_t>(begin), from.begin() + static_cast<std::ptrdiff_t>(end),
              copy.begin() + static_cast<std::ptrdiff_t>(begin));
  });
  return copy;
}

/// A vector gets longer, n >= size(), its new items zero. One thread alone would spend most of the time on taking their
/// pages from the system.
template <class Item>
void parallel_resize(std::vector<Item>& all, std::size_t n) {
  all.reserve(n);
  take_pages(all.data() + all.size(), (n - all.size()) * sizeof(Item));
  all.resize(n);
}

/// n items of one value, written by several threads.
template <class Item>
RawVector<Item> parallel_filled(std::size_t n, const Item& value) {
  RawVector<Item> all(n);
  parallel_ranges(n, Split::kAdaptive, [&, value](std::size_t begin, std::size_t end) {
    std::fill(all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end), value);
  });
  return all;
}

/// The sum of term(i) for i < n, added one after the other, as rounding asks: only the terms are found by several
/// threads.
template <class Term>
double sum_in_order(std::size_t n, const Term& term) {
  double sum = 0;
  if (thread_count() == 1 || n <= kNumbersAtOnce) {
    for (std::size_t i = 0; i < n; ++i) sum += term(i);
    return sum;
  }
  RawVector<double> terms(n);
  parallel_for(n, [&](std::size_t i) { terms[i] = term(i); });
  for (const double t : terms) sum += t;
  return sum;
}

/// The greatest of `none` and of(i) for i < n.
template <class Number, class Of>
Number parallel_max(std::size_t n, Number none, const Of& of) {
  std::vector<Number> of_block((n + kNumbersAtOnce - 1) / kNumbersAtOnce, none);
  parallel_for(of_block.size(), [&](std::size_t b) {
    Number most = none;
    for (std::size_t i = b * kNumbersAtOnce; i < std::min(n, (b + 1) * kNumbersAtOnce); ++i)
      most = std::max(most, of(i));
    of_block[b] = most;
  });
  for (const Number& number : of_block) none = std::max(none, number);
  return none;
}

/// Numbers what there is of [0, n): count(begin, end) says how many things a range has, number(begin, end, first) gives
/// them the numbers from `first` on and returns the next one. Returns how many there are in all.
template <class Count, class Number>
std::size_t number_in_blocks(std::size_t n, const Count& count, const Number& number) {
  if (thread_count() == 1 || n <= kNumbersAtOnce) return number(std::size_t{0}, n, std::size_t{0});
  std::vector<std::size_t> first((n + kNumbersAtOnce - 1) / kNumbersAtOnce);
  const auto for_each_block = [&](const auto& visit) {
    parallel_for(first.size(),
                 [&](std::size_t b) { visit(b * kNumbersAtOnce, std::min(n, (b + 1) * kNumbersAtOnce), first[b]); });
  };
  for_each_block([&](std::size_t begin, std::size_t end, std::size_t& sum) { sum = count(begin, end); });
  std::size_t all = 0;
  for (std::size_t& of_block : first) all += std::exchange(of_block, all);
  for_each_block(number);
  return all;
}

}  // namespace octafront
