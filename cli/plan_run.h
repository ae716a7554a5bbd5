#pragma once

#include "child_process.h"
#include "mcp_tools.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace octafront::cli {

/// How far a run has come.
struct Progress {
  std::string stage;
  double fraction = -1;  ///< negative: not known
};

/// The lines of a plan, run one after the other, each by a process of its own; who has it asks again and again how it
/// goes. Destroyed before its end it ends what runs.
class PlanRun {
 public:
  /// Throws OutputError if no process can be made.
  PlanRun(Plan plan, const Folders& folders);

  /// Does what there is to do without waiting: reads, begins the next line, holds the limit of time. False once all has
  /// ended. Throws OutputError as above.
  bool goes_on();
  /// Waits until there may be something to do, some milliseconds at most.
  void wait(int milliseconds) const;
  /// Pipes that have something to read when there is something to do.
  std::pair<int, int> pipes() const { return {child_->output(), child_->errors()}; }
  /// What was told last, once.
  std::optional<Progress> progress();

  /// Asks it to end; who does not is ended.
  void cancel() { is_cancelled_ = true; }
  bool is_cancelled() const { return is_cancelled_; }

  const std::vector<RunResult>& results() const { return results_; }
  /// That of the last line: of those that draw a picture.
  const std::string& output() const { return output_; }

 private:
  void start_line();
  void hear(const std::string& text);
  void hold_limits();
  RunResult result(int status) const;

  using Clock = std::chrono::steady_clock;
  Plan plan_;
  const Folders folders_;
  std::vector<RunResult> results_;
  std::unique_ptr<ChildProcess> child_;
  std::string output_, errors_, said_;  ///< `errors_`: what of them is no whole line yet
  std::optional<Progress> progress_;
  Clock::time_point start_ = Clock::now(), asked_to_end_;
  bool is_cancelled_ = false, is_too_long_ = false;
};

}  // namespace octafront::cli
