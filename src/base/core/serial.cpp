// Stands in for parallel.cpp where a build has no threads (OCTAFRONT_THREADS=OFF): a page, a machine without TBB.
#include "base/core/parallel.h"
#include "base/core/thread_limit.h"

namespace octafront {

void parallel_ranges(std::size_t n, Split, FunctionRef<void(std::size_t begin, std::size_t end)> body) {
  if (n > 0) body(0, n);
}

bool has_threads() {
  return false;
}

std::size_t thread_count() {
  return 1;
}

void parallel_invoke(FunctionRef<void()> a, FunctionRef<void()> b) {
  a();
  b();
}

struct ThreadSlots::Impl {
  void (*drop)(void*);
  void* slot = nullptr;
};

ThreadSlots::ThreadSlots(void (*drop)(void*)) : impl_(new Impl{drop}) {}

ThreadSlots::~ThreadSlots() {
  for_each(impl_->drop);
  delete impl_;
}

void* ThreadSlots::local(FunctionRef<void*()> make) {
  if (impl_->slot == nullptr) impl_->slot = make();
  return impl_->slot;
}

void ThreadSlots::for_each(FunctionRef<void(void*)> visit) {
  if (impl_->slot != nullptr) visit(impl_->slot);
}

struct ThreadLimit::Control {};

ThreadLimit::ThreadLimit(int) {}

ThreadLimit::~ThreadLimit() {
  delete control_;
}

}  // namespace octafront
