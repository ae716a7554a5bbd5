#include "base/core/parallel.h"

#include "base/core/thread_limit.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer) && !defined(__SANITIZE_THREAD__)
#define __SANITIZE_THREAD__
#endif
#endif
#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace octafront {

namespace {

/// Tells the thread sanitizer what comes before what: it cannot see into TBB, a library that is compiled without it.
/// (What TBB does for itself: tests/support/tsan.txt.)
class Ordering {
 public:
  Ordering() { released(&begin_); }
  ~Ordering() { acquired(&end_); }
  Ordering(const Ordering&) = delete;
  Ordering& operator=(const Ordering&) = delete;

  template <class Work>
  void within(const Work& work) {
    acquired(&begin_);
    work();
    released(&end_);
  }

 private:
#ifdef __SANITIZE_THREAD__
  static void acquired(char* what) {
    __tsan_acquire(what);
  }
  static void released(char* what) {
    __tsan_release(what);
  }
#else
  static void acquired(const char*) {}
  static void released(const char*) {}
#endif
  char begin_ = 0, end_ = 0;
};

/// TBB may divide a range down to single indices; so many parts show whether they are even.
constexpr std::size_t kPartsOfHook = 256;

const ParallelHook* the_hook = nullptr;

void hooked_ranges(std::size_t n, Split split, FunctionRef<void(std::size_t begin, std::size_t end)> body) {
  const std::size_t parts = split == Split::kSingly ? n : std::min(n, kPartsOfHook);
  if (parts > 0) the_hook->run(parts, [&](std::size_t k) { body(n * k / parts, n * (k + 1) / parts); });
}

}  // namespace

void parallel_ranges(std::size_t n, Split split, FunctionRef<void(std::size_t begin, std::size_t end)> body) {
  if (the_hook != nullptr) return hooked_ranges(n, split, body);
  using Range = tbb::blocked_range<std::size_t>;
  Ordering ordering;
  const auto run = [&](const Range& range) { ordering.within([&] { body(range.begin(), range.end()); }); };
  if (split == Split::kSingly)
    tbb::parallel_for(Range(0, n), run, tbb::simple_partitioner{});
  else
    tbb::parallel_for(Range(0, n), run);
}

void set_parallel_hook(const ParallelHook* hook) {
  the_hook = hook;
}

bool has_threads() {
  return true;
}

std::size_t thread_count() {
  if (the_hook != nullptr) return the_hook->threads;
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

void parallel_invoke(FunctionRef<void()> a, FunctionRef<void()> b) {
  if (the_hook != nullptr) return the_hook->run(2, [&](std::size_t k) { k == 0 ? a() : b(); });
  Ordering ordering;
  tbb::parallel_invoke([&] { ordering.within(a); }, [&] { ordering.within(b); });
}

struct ThreadSlots::Impl {
  void (*drop)(void*);
  tbb::enumerable_thread_specific<void*> slots{nullptr};
};

ThreadSlots::ThreadSlots(void (*drop)(void*)) : impl_(new Impl{drop}) {}

ThreadSlots::~ThreadSlots() {
  for_each(impl_->drop);
  delete impl_;
}

void* ThreadSlots::local(FunctionRef<void*()> make) {
  void*& slot = impl_->slots.local();
  if (slot == nullptr) slot = make();
  return slot;
}

void ThreadSlots::for_each(FunctionRef<void(void*)> visit) {
  for (void* slot : impl_->slots)
    if (slot != nullptr) visit(slot);
}

struct ThreadLimit::Control {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0)
    control_ = new Control{
        tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads))};
}

ThreadLimit::~ThreadLimit() {
  delete control_;
}

}  // namespace octafront
