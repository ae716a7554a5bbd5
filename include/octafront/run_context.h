#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace octafront {

class Ranks;

/// What a run shares with its caller: how far it is, whether it should stop, how many threads it may use,
/// and with which other processes it shares the work.
/// Copies refer to the same cancel flag. The result of a run never depends on it.
struct RunContext {
  /// Called from the thread that runs the stage, at most some hundred times a stage.
  /// `fraction` in [0, 1], or negative where it is unknown.
  std::function<void(std::string_view stage, double fraction)> progress;
  /// Set to true from any thread or a signal handler to end the run with Cancelled. May be null.
  const std::atomic<bool>* cancel = nullptr;
  /// Upper bound on threads; 0: as many as the machine has.
  int threads = 0;
  /// The other processes that make the same mesh (octafront/ranks.h); null: this one is alone. They must outlive the
  /// run, and all of them call the same functions with the same arguments.
  Ranks* ranks = nullptr;

  bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
  /// Throws Cancelled if asked to stop. Stages call it at least every few milliseconds of work.
  void check() const;
  void report(std::string_view stage, double fraction) const {
    if (progress) progress(stage, fraction);
  }
};

}  // namespace octafront
