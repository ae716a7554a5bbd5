#pragma once

// Work on several threads. TBB does it, behind this wall: only parallel.cpp knows. Bodies cross it once for a range of
// indices, so an index costs what it costs in a loop. What a body throws ends the work and comes out of the call.
// Bodies run in any order: whoever adds up does so afterwards, in order of the indices.

#include "base/core/function_ref.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

namespace octafront {

enum class Split {
  kAdaptive,  ///< into as many ranges as keep all threads busy
  kSingly,    ///< each index is a task of its own: for few, long, uneven ones
};

/// Calls body(begin, end) for ranges that together are [0, n).
void parallel_ranges(std::size_t n, Split split, FunctionRef<void(std::size_t begin, std::size_t end)> body);

/// Calls body(i) for 0 <= i < n.
template <class Body>
void parallel_for(std::size_t n, const Body& body, Split split = Split::kAdaptive) {
  parallel_ranges(n, split, [&body](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// How many threads may work at a time, the caller included.
std::size_t thread_count();

/// Does the tasks of all calls in its own way, to measure them; work then believes in `threads`.
struct ParallelHook {
  std::size_t threads;
  void (*run)(std::size_t tasks, FunctionRef<void(std::size_t)> task);
};

/// Null: nobody does. Set before any work begins.
void set_parallel_hook(const ParallelHook* hook);

/// Both, at the same time where there is a thread for it.
void parallel_invoke(FunctionRef<void()> a, FunctionRef<void()> b);

/// The least i < n for which test(i) is true, or n. All i below it have been tested, some behind it too.
template <class Test>
std::size_t parallel_find(std::size_t n, const Test& test) {
  std::atomic<std::size_t> first{n};
  parallel_ranges(n, Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && i < first.load(std::memory_order_relaxed); ++i) {
      if (!test(i)) continue;
      std::size_t known = first.load();
      while (i < known && !first.compare_exchange_weak(known, i)) {
      }
      return;
    }
  });
  return first;
}

/// The sum of part(begin, end), of any type with +=, over ranges that together are [0, n). The ranges and the order in
/// which they are added up depend on n alone.
template <class Part>
auto parallel_sum(std::size_t n, const Part& part) {
  constexpr std::size_t kRange = 8192;
  std::vector<decltype(part(n, n))> parts((n + kRange - 1) / kRange);
  parallel_for(parts.size(), [&](std::size_t i) { parts[i] = part(i * kRange, std::min(n, (i + 1) * kRange)); });
  decltype(part(n, n)) sum{};
  for (const auto& p : parts) sum += p;
  return sum;
}

/// What collect(begin, end, out) appends to a vector for ranges that together are [0, n), in their order.
template <class Item, class Collect>
std::vector<Item> parallel_collect(std::size_t n, std::size_t range, const Collect& collect) {
  std::vector<std::vector<Item>> parts((n + range - 1) / range);
  parallel_for(
      parts.size(),
      [&](std::size_t i) {
        collect(i * range, std::min(n, (i + 1) * range), parts[i]);
        // Room that nothing came to fill would stay until all parts are there.
        if (parts[i].capacity() > 2 * parts[i].size()) parts[i].shrink_to_fit();
      },
      Split::kSingly);
  std::size_t size = 0;
  for (const auto& part : parts) size += part.size();
  std::vector<Item> all;
  all.reserve(size);
  for (auto& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    std::vector<Item>().swap(part);
  }
  return all;
}

/// Calls number(i, k) for the k-th i < n for which test(i) is true, and returns how many there are. test(i) is called
/// twice.
template <class Test, class Number>
std::size_t parallel_number(std::size_t n, const Test& test, const Number& number) {
  constexpr std::size_t kRange = 16384;
  std::vector<std::size_t> first((n + kRange - 1) / kRange + 1, 0);
  const auto for_each_range = [&](const auto& visit) {
    parallel_for(first.size() - 1, [&](std::size_t r) {
      for (std::size_t i = r * kRange; i < std::min(n, (r + 1) * kRange); ++i)
        if (test(i)) visit(r, i);
    });
  };
  for_each_range([&](std::size_t r, std::size_t) { ++first[r + 1]; });
  for (std::size_t r = 1; r < first.size(); ++r) first[r] += first[r - 1];
  const std::size_t all = first.back();
  for_each_range([&](std::size_t r, std::size_t i) { number(i, first[r]++); });
  return all;
}

/// std::sort by several threads. REQUIRES a total order: nothing else makes the result the same on any number of them.
template <class Item, class Less = std::less<Item>>
void parallel_sort(std::vector<Item>& items, const Less& less = {}) {
  constexpr std::size_t kRun = 16384;
  const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(std::min(i, items.size())); };
  const std::size_t threads = thread_count();
  std::size_t run = threads == 1 ? items.size() : std::max(kRun, items.size() / (2 * threads) + 1);
  if (run == 0) return;
  parallel_for((items.size() + run - 1) / run, [&](std::size_t r) { std::sort(at(r * run), at((r + 1) * run), less); },
               Split::kSingly);
  for (; run < items.size(); run *= 2)
    parallel_for(
        (items.size() + 2 * run - 1) / (2 * run),
        [&](std::size_t r) { std::inplace_merge(at(2 * r * run), at((2 * r + 1) * run), at((2 * r + 2) * run), less); },
        Split::kSingly);
}

/// A pointer for each thread that asks.
class ThreadSlots {
 public:
  explicit ThreadSlots(void (*drop)(void*));
  ~ThreadSlots();
  ThreadSlots(const ThreadSlots&) = delete;
  ThreadSlots& operator=(const ThreadSlots&) = delete;

  /// The calling thread's; `make` gives it at the first call.
  void* local(FunctionRef<void*()> make);
  void for_each(FunctionRef<void(void*)> visit);

 private:
  struct Impl;
  Impl* impl_;
};

/// A T for each thread that asks: scratch space, or results whose order does not matter.
template <class T>
class PerThread {
 public:
  PerThread() : slots_([](void* t) { delete static_cast<T*>(t); }) {}

  T& local() {
    return local([] { return T(); });
  }
  /// `make` returns the T at the thread's first call.
  template <class Make>
  T& local(const Make& make) {
    return *static_cast<T*>(slots_.local([&make]() -> void* { return new T(make()); }));
  }
  /// Visits those that were made, in no certain order.
  template <class Visit>
  void for_each(const Visit& visit) {
    slots_.for_each([&visit](void* t) { visit(*static_cast<T*>(t)); });
  }

 private:
  ThreadSlots slots_;
};

}  // namespace octafront
