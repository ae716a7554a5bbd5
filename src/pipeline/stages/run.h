#pragma once

#include <octafront/options.h>
#include <octafront/report.h>
#include <octafront/run_context.h>

#include "base/core/stage.h"
#include "base/core/stage_timer.h"
#include "base/core/thread_limit.h"
#include "base/shared/comm.h"

#include <exception>
#include <utility>

namespace octafront {

/// Enters into the report what the ranks have said to each other until its end, if there are several.
class StageUse {
 public:
  StageUse(const RunContext& context, StageReport& report);
  ~StageUse();
  StageUse(const StageUse&) = delete;
  StageUse& operator=(const StageUse&) = delete;

 private:
  const Ranks* ranks_;  ///< null: alone
  StageReport& report_;
  RankUse before_;
  int exceptions_ = std::uncaught_exceptions();
};

/// One run of the pipeline: what was asked for, whom to tell, and what gets written down. Holds the limit on threads
/// as long as it lives.
class Run {
 public:
  /// Both must outlive the run. Throws OptionError as check_options does.
  Run(const Options& asked, const RunContext& context);

  const Options& options;
  Report report;

  /// Runs one stage, work(const Stage&): times it, gives it a place in the report, tells the caller about it.
  template <class Work>
  auto stage(const char* name, Work&& work) {
    StageReport& entry = report.stages.emplace_back();
    entry.name = name;
    const StageTimer timer(entry);
    const StageUse use(context_, entry);
    return comm().attempt(name, Comm::Telling::kNamesRank, [&] {
      context_.check();
      context_.report(name, -1);
      return std::forward<Work>(work)(Stage(context_, entry));
    });
  }

  Comm comm() const { return Comm(context_.ranks); }
  const RunContext& context() const { return context_; }
  /// The report, with the sums over its stages and the peak of memory: the end of the run.
  Report close();

 private:
  const RunContext& context_;
  ThreadLimit limit_;
};

}  // namespace octafront
