#pragma once

// Work on several threads. TBB does it, behind this wall: only parallel.cpp knows. Bodies cross it once for a range of
// indices, so an index costs what it costs in a loop. What a body throws ends the work and comes out of the call.
// Bodies run in any order: whoever adds up does so afterwards, in order of the indices.

#include "core/function_ref.h"

#include <cstddef>

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

/// Both, at the same time where there is a thread for it.
void parallel_invoke(FunctionRef<void()> a, FunctionRef<void()> b);

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
