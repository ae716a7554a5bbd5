#include "plan_run.h"

#include <octafront/error.h>

#include <array>
#include <utility>

#include <fmt/core.h>
#ifndef _WIN32
#include <poll.h>
#endif

namespace octafront::cli {

PlanRun::PlanRun(Plan plan, const Folders& folders) : plan_(std::move(plan)), folders_(folders) {
  start_line();
}

void PlanRun::start_line() {
  const ChildSetting setting{folders_.home(), folders_.all(), {"OCTAFRONT_PROGRESS=lines"}};
  output_.clear(), errors_.clear(), said_.clear();
  child_ = std::make_unique<ChildProcess>(plan_.lines[results_.size()], setting);
}

void PlanRun::wait([[maybe_unused]] int milliseconds) const {
#ifndef _WIN32
  std::array<pollfd, 2> both{{{child_->output(), POLLIN, 0}, {child_->errors(), POLLIN, 0}}};
  ::poll(both.data(), both.size(), milliseconds);
#endif
}

bool PlanRun::goes_on() {
  if (!child_) return false;
  std::string errors;
  const bool has_output = child_->read_output(output_), has_errors = child_->read_errors(errors);
  hear(errors);
  hold_limits();
  if (has_output || has_errors) return true;
  const int status = child_->wait();
  child_.reset();
  if (is_cancelled_) return false;
  results_.push_back(result(status));
  // A file that cannot be read at all is not looked at twice.
  if (results_.size() == plan_.lines.size() || status != 0) return false;
  start_line();
  return true;
}

/// By the clock; who does not end when asked is ended.
void PlanRun::hold_limits() {
  constexpr std::chrono::seconds kGrace{3};
  const auto now = Clock::now();
  if (plan_.seconds && std::chrono::duration<double>(now - start_).count() > *plan_.seconds) is_too_long_ = true;
  if (!is_cancelled_ && !is_too_long_) return;
  if (asked_to_end_ == Clock::time_point()) asked_to_end_ = now, child_->interrupt();
  if (now - asked_to_end_ > kGrace) child_->kill();
}

/// Lines of progress are for who asks; the rest is kept.
void PlanRun::hear(const std::string& text) {
  constexpr std::size_t kMostSaid = 1 << 16;
  errors_ += text;
  for (std::size_t end = 0; (end = errors_.find('\n')) != std::string::npos; errors_.erase(0, end + 1)) {
    const std::string line = errors_.substr(0, end);
    if (line.starts_with('\x1f')) {
      const std::size_t tab = line.find('\t');
      progress_ = Progress{line.substr(1, tab - 1), tab == std::string::npos ? -1 : std::atof(line.c_str() + tab + 1)};
    } else if (said_.size() < kMostSaid) {
      said_ += line + "\n";
    }
  }
}

std::optional<Progress> PlanRun::progress() {
  return std::exchange(progress_, std::nullopt);
}

RunResult PlanRun::result(int status) const {
  RunResult result{status, Json::parse(output_, nullptr, false), said_ + errors_};
  if (result.report.is_discarded()) result.report = nullptr;
  if (!is_too_long_) return result;
  result.status = kLimitReached;
  if (!result.report.is_object()) result.report = Json::object();
  result.report["error"] = {
      {"kind", "limit"},
      {"code", "seconds"},
      {"message", fmt::format("the {:g} seconds that it may take are over; no result was written", *plan_.seconds)}};
  return result;
}

}  // namespace octafront::cli
