#pragma once

namespace octafront {

/// False in a build without threads (OCTAFRONT_THREADS=OFF), where serial.cpp stands in for TBB and the caller does
/// all.
bool has_threads();

/// While it lives, no more than `threads` threads work at a time, callers included; 0: as many as the machine has. This
/// is the one place that limits threads: the pipeline holds one from its entry on. A stage that is called alone works
/// with the limit that its caller holds, or with all threads that TBB gives it.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  Control* control_ = nullptr;
};

}  // namespace octafront
