#pragma once

#include <octafront/report.h>
#include <octafront/run_context.h>

#include "core/stage_timer.h"

namespace octafront {

/// Runs one stage: times it, gives it a place in the report, tells the caller about it.
template <class F>
auto run_stage(Report& report, const RunContext& context, const char* name, F&& stage) {
  context.check();
  context.report(name, -1);
  StageReport& entry = report.stages.emplace_back();
  entry.name = name;
  const StageTimer timer(entry);
  return stage(entry);
}

/// Sums over the stages, and the peak of memory: to be called at the end.
void close_report(Report& report);

}  // namespace octafront
