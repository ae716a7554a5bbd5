#include "pipeline/stages/run.h"

#include <octafront/generate.h>

#include "pipeline/stages/measure.h"

#include <exception>

namespace octafront {

StageUse::StageUse(const RunContext& context, StageReport& report)
    : ranks_(context.ranks != nullptr && context.ranks->size() > 1 ? context.ranks : nullptr), report_(report) {
  if (ranks_ != nullptr) before_ = ranks_->use;
}

StageUse::~StageUse() {
  const bool is_unwinding = std::uncaught_exceptions() > exceptions_;
  if (ranks_ == nullptr || is_unwinding) return;
  report_.count("peak memory bytes so far", static_cast<double>(peak_memory_bytes()));
  if (ranks_->use.messages == before_.messages) return;
  const RankUse& now = ranks_->use;
  report_.count("rounds of talk", static_cast<double>(now.messages - before_.messages));
  report_.count("bytes sent", static_cast<double>(now.bytes_sent - before_.bytes_sent));
  report_.count("bytes taken", static_cast<double>(now.bytes_taken - before_.bytes_taken));
  report_.count("talking seconds", now.seconds_talking - before_.seconds_talking);
  report_.count("shared seconds", now.seconds_shared - before_.seconds_shared);
}

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
