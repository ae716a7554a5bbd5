#pragma once

// What the C++20 library lacks in libc++ 13, which Debian's emscripten comes with: algorithms on ranges, std::bit_cast,
// std::to_chars of doubles. Included before all else when building for WebAssembly (cmake/OctafrontTargets.cmake);
// nothing where libc++ is newer.
#include <version>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <functional>
#include <iterator>
#include <type_traits>

namespace std {

template <class To, class From>
requires(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> && is_trivially_copyable_v<From>) constexpr To
    bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

/// Those digits that read back as the same number, 17 at most.
inline to_chars_result to_chars(char* first, char* last, double value, chars_format, int digits) {
  char text[32];
  const int length = snprintf(text, sizeof text, "%.*g", digits, value);
  if (length >= last - first) return {last, errc::value_too_large};
  return {copy(text, text + length, first), errc()};
}
inline to_chars_result to_chars(char* first, char* last, double value) {
  for (int digits = 15; digits < 17; ++digits) {
    const to_chars_result tried = to_chars(first, last, value, chars_format::general, digits);
    if (tried.ec != errc()) return tried;
    *tried.ptr = 0;
    if (strtod(first, nullptr) == value) return tried;
  }
  return to_chars(first, last, value, chars_format::general, 17);
}

namespace ranges {

struct octafront_identity {
  template <class T>
  constexpr T&& operator()(T&& t) const noexcept {
    return static_cast<T&&>(t);
  }
};
struct octafront_less {
  template <class A, class B>
  constexpr bool operator()(const A& a, const B& b) const {
    return a < b;
  }
};

/// Compares what the projection says of two items.
template <class Compare, class Projection>
auto octafront_compared(Compare& compare, Projection& of) {
  return [&compare, &of](const auto& a, const auto& b) { return invoke(compare, invoke(of, a), invoke(of, b)); };
}

#define OCTAFRONT_TEST(name)                                                                          \
  template <class Range, class Test, class Projection = octafront_identity>                           \
  constexpr auto name(Range&& range, Test test, Projection of = {}) {                                 \
    return std::name(begin(range), end(range),                                                        \
                     [&](auto&& item) { return static_cast<bool>(invoke(test, invoke(of, item))); }); \
  }
OCTAFRONT_TEST(any_of)
OCTAFRONT_TEST(all_of)
OCTAFRONT_TEST(none_of)
OCTAFRONT_TEST(count_if)
OCTAFRONT_TEST(find_if)
#undef OCTAFRONT_TEST

#define OCTAFRONT_ORDER(name)                                                                   \
  template <class Range, class Compare = octafront_less, class Projection = octafront_identity> \
  constexpr auto name(Range&& range, Compare compare = {}, Projection of = {}) {                \
    return std::name(begin(range), end(range), octafront_compared(compare, of));                \
  }
OCTAFRONT_ORDER(sort)
OCTAFRONT_ORDER(stable_sort)
OCTAFRONT_ORDER(min_element)
OCTAFRONT_ORDER(max_element)
#undef OCTAFRONT_ORDER

template <class Range, class T, class Projection = octafront_identity>
constexpr auto find(Range&& range, const T& value, Projection of = {}) {
  return std::find_if(begin(range), end(range), [&](const auto& item) { return invoke(of, item) == value; });
}
template <class Range, class T>
constexpr auto count(Range&& range, const T& value) {
  return std::count(begin(range), end(range), value);
}
template <class Range, class T>
constexpr void fill(Range&& range, const T& value) {
  std::fill(begin(range), end(range), value);
}
template <class Range, class T>
constexpr void replace(Range&& range, const T& old, const T& now) {
  std::replace(begin(range), end(range), old, now);
}
template <class It, class T, class Compare = octafront_less, class Projection = octafront_identity>
constexpr It lower_bound(It first, It last, const T& value, Compare compare = {}, Projection of = {}) {
  return std::partition_point(first, last, [&](const auto& item) { return invoke(compare, invoke(of, item), value); });
}
template <class Range, class T, class Compare = octafront_less, class Projection = octafront_identity>
constexpr auto lower_bound(Range&& range, const T& value, Compare compare = {}, Projection of = {}) {
  return ranges::lower_bound(begin(range), end(range), value, compare, of);
}
template <class Range, class T, class Compare = octafront_less, class Projection = octafront_identity>
constexpr auto upper_bound(Range&& range, const T& value, Compare compare = {}, Projection of = {}) {
  return std::partition_point(begin(range), end(range),
                              [&](const auto& item) { return !invoke(compare, value, invoke(of, item)); });
}
template <class Range, class T>
constexpr bool binary_search(Range&& range, const T& value) {
  return std::binary_search(begin(range), end(range), value);
}
template <class It>
struct octafront_subrange {
  It first, last;
  constexpr It begin() const { return first; }
  constexpr It end() const { return last; }
  constexpr bool empty() const { return first == last; }
  constexpr auto size() const { return static_cast<size_t>(last - first); }
};
template <class Range, class T, class Compare = octafront_less, class Projection = octafront_identity>
constexpr auto equal_range(Range&& range, const T& value, Compare compare = {}, Projection of = {}) {
  return octafront_subrange<decltype(begin(range))>{ranges::lower_bound(range, value, compare, of),
                                                    ranges::upper_bound(range, value, compare, of)};
}
template <class A, class B, class Out>
constexpr Out set_intersection(A&& a, B&& b, Out out) {
  return std::set_intersection(begin(a), end(a), begin(b), end(b), out);
}
template <class A, class B>
constexpr bool includes(A&& a, B&& b) {
  return std::includes(begin(a), end(a), begin(b), end(b));
}
template <class A, class B>
constexpr bool equal(A&& a, B&& b) {
  return std::equal(begin(a), end(a), begin(b), end(b));
}
template <class Range, class Out>
constexpr Out copy(Range&& range, Out out) {
  return std::copy(begin(range), end(range), out);
}
template <class Range, class Out, class Change>
constexpr Out transform(Range&& range, Out out, Change change) {
  return std::transform(begin(range), end(range), out, [&](auto&& item) -> decltype(auto) { return invoke(change, item); });
}
template <class Range, class Visit>
constexpr void for_each(Range&& range, Visit&& visit) {
  for (auto&& item : range) invoke(visit, item);
}
template <class Range, class Compare>
constexpr void push_heap(Range&& range, Compare compare) {
  std::push_heap(begin(range), end(range), compare);
}
template <class Range, class Compare>
constexpr void pop_heap(Range&& range, Compare compare) {
  std::pop_heap(begin(range), end(range), compare);
}
template <class Range>
constexpr bool is_sorted(Range&& range) {
  return std::is_sorted(begin(range), end(range));
}
template <class Range>
constexpr auto min(Range&& range) {
  return *std::min_element(begin(range), end(range));
}
template <class Range>
constexpr auto max(Range&& range) {
  return *std::max_element(begin(range), end(range));
}
/// Pairs of iterators, and of items.
template <class Range>
constexpr auto minmax_element(Range&& range) {
  return std::minmax_element(begin(range), end(range));
}
template <class Range, class Compare = octafront_less, class Projection = octafront_identity>
constexpr auto minmax(Range&& range, Compare compare = {}, Projection of = {}) {
  const auto ends = std::minmax_element(begin(range), end(range), octafront_compared(compare, of));
  return pair(*ends.first, *ends.second);
}
template <class Range, class Test>
constexpr auto partition_point(Range&& range, Test test) {
  return std::partition_point(begin(range), end(range), test);
}
template <class Range, class Test>
auto stable_partition(Range&& range, Test test) {
  return std::stable_partition(begin(range), end(range), test);
}
template <class Range, class Test>
constexpr auto adjacent_find(Range&& range, Test test) {
  return std::adjacent_find(begin(range), end(range), test);
}
struct octafront_found {
  bool found;
};
template <class Range>
constexpr octafront_found next_permutation(Range&& range) {
  return {std::next_permutation(begin(range), end(range))};
}

}  // namespace ranges
}  // namespace std

#endif
