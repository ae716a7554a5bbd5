#pragma once

#include <optional>

#include <tbb/global_control.h>

namespace octafront {

/// While it lives, no more than `threads` threads work at a time, callers included; 0: as many as the machine has.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads) {
    if (threads > 0) control_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }

 private:
  std::optional<tbb::global_control> control_;
};

}  // namespace octafront
