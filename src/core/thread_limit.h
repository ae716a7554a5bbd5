#pragma once

#include <optional>

#include <tbb/global_control.h>

namespace octafront {

/// While it lives, no more than `threads` threads work at a time, callers included; 0: as many as the machine has. This
/// is the one place that limits threads: the pipeline holds one from its entry on. A stage that is called alone works
/// with the limit that its caller holds, or with all threads that TBB gives it.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads) {
    if (threads > 0) control_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }

 private:
  std::optional<tbb::global_control> control_;
};

}  // namespace octafront
