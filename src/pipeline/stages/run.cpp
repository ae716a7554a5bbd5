#include "pipeline/stages/run.h"

#include <octafront/generate.h>

#include "pipeline/stages/measure.h"

namespace octafront {

Run::Run(const Options& asked, const RunContext& context) : options(asked), context_(context), limit_(context.threads) {
  check_options(options);
}

Report Run::close() {
  for (const StageReport& stage : report.stages) {
    report.wall_seconds += stage.wall_seconds;
    report.cpu_seconds += stage.cpu_seconds;
  }
  report.peak_memory_bytes = peak_memory_bytes();
  return std::move(report);
}

}  // namespace octafront
