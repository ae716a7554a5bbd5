#pragma once

// Work on several threads. TBB does it, behind this wall: only parallel.cpp knows. Bodies cross it once for a range of
// indices, so an index costs what it costs in a loop. What a body throws ends the work and comes out of the call.
// Bodies run in any order: whoever adds up does so afterwards, in order of the indices.

#include "base/core/function_ref.h"
#include "base/core/raw_vector.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>
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

/// Parts one behind the other; none are left.
template <class All>
All joined(std::vector<std::vector<typename All::value_type>>& parts) {
  using Item = typename All::value_type;
  std::vector<std::size_t> first;
  first.reserve(parts.size() + 1);
  std::size_t size = 0;
  for (const auto& part : parts) first.push_back(size), size += part.size();
  All all;
  if constexpr (std::is_same_v<All, RawVector<Item>>) {
    if (size == 0) return all;
    all.resize(size);
    parallel_for(parts.size(), [&](std::size_t i) {
      std::copy(parts[i].begin(), parts[i].end(), all.begin() + static_cast<std::ptrdiff_t>(first[i]));
      std::vector<Item>().swap(parts[i]);
    });
  } else {
    all.reserve(size);
    for (auto& part : parts) {
      all.insert(all.end(), part.begin(), part.end());
      std::vector<Item>().swap(part);
    }
  }
  return all;
}

/// What collect(begin, end, out) appends to a vector for ranges that together are [0, n), in their order. A RawVector
/// is filled by several threads, too.
template <class Item, class All = std::vector<Item>, class Collect>
All parallel_collect(std::size_t n, std::size_t range, const Collect& collect) {
  std::vector<std::vector<Item>> parts((n + range - 1) / range);
  if (parts.empty()) return {};
  parallel_for(
      parts.size(),
      [&](std::size_t i) {
        collect(i * range, std::min(n, (i + 1) * range), parts[i]);
        // Room that nothing came to fill would stay until all parts are there.
        if (parts[i].capacity() > 2 * parts[i].size()) parts[i].shrink_to_fit();
      },
      Split::kSingly);
  return joined<All>(parts);
}

/// The numbers below n that the test is true for, ascending.
template <class Test>
std::vector<std::uint32_t> parallel_select(std::size_t n, const Test& test, std::size_t range = 16384) {
  return parallel_collect<std::uint32_t>(n, range,
                                         [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
                                           for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
                                             if (test(i)) found.push_back(i);
                                         });
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

/// std::sort by several threads: items that lie between some of them are put side by side, and each such stretch is
/// sorted apart. REQUIRES a total order: nothing else makes the result the same on any number of threads.
template <class Items, class Less = std::less<typename Items::value_type>>
void parallel_sort(Items& items, const Less& less = {}) {
  using Item = typename Items::value_type;
  constexpr std::size_t kAlone = 4096, kStretch = 2048, kMostStretches = 256, kSamples = 8;
  const std::size_t n = items.size();
  if (thread_count() == 1 || n <= kAlone) return std::sort(items.begin(), items.end(), less);
  const std::size_t stretches = std::min(n / kStretch, kMostStretches), chunks = stretches;
  std::vector<Item> samples, ends;
  for (std::size_t i = 0; i < kSamples * stretches; ++i) samples.push_back(items[n * i / (kSamples * stretches)]);
  std::sort(samples.begin(), samples.end(), less);
  for (std::size_t s = 1; s < stretches; ++s) ends.push_back(samples[kSamples * s]);

  RawVector<std::uint8_t> stretch_of(n);
  std::vector<std::vector<std::size_t>> next(chunks, std::vector<std::size_t>(stretches, 0));
  const auto for_each = [&](const auto& visit) {
    parallel_for(
        chunks,
        [&](std::size_t c) {
          for (std::size_t i = n * c / chunks; i < n * (c + 1) / chunks; ++i) visit(i, next[c]);
        },
        Split::kSingly);
  };
  for_each([&](std::size_t i, std::vector<std::size_t>& count) {
    const auto end = std::upper_bound(ends.begin(), ends.end(), items[i], less);
    ++count[stretch_of[i] = static_cast<std::uint8_t>(end - ends.begin())];
  });
  std::vector<std::size_t> first(stretches + 1, n);
  std::size_t sum = 0;
  for (std::size_t s = 0; s < stretches; ++s) {
    first[s] = sum;
    for (auto& of_chunk : next) sum += std::exchange(of_chunk[s], sum);
  }
  RawVector<Item> sorted(n);
  for_each([&](std::size_t i, std::vector<std::size_t>& to) { sorted[to[stretch_of[i]]++] = std::move(items[i]); });
  parallel_for(
      stretches,
      [&](std::size_t s) {
        const auto at = [&](auto& all, std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
        std::sort(at(sorted, first[s]), at(sorted, first[s + 1]), less);
        std::move(at(sorted, first[s]), at(sorted, first[s + 1]), at(items, first[s]));
      },
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
