#pragma once

#include <octafront/report.h>
#include <octafront/run_context.h>

#include <string>

namespace octafront {

/// What a stage works with beside its data: whom to tell how far it is, when to stop, where to write down what it did.
/// Refers to both, which must outlive it; made for a call: `fill_volume(surface, sizes, options, {context, report})`.
class Stage {
 public:
  Stage(const RunContext& context, StageReport& report) : context_(context), report_(report) {}

  /// Throws Cancelled if the run was asked to stop.
  void check() const { context_.check(); }
  /// `fraction` of this stage in [0, 1], or negative where it is unknown.
  void progress(double fraction) const { context_.report(report_.name, fraction); }
  void count(std::string key, double value) const;
  /// A sentence for the user.
  void note(std::string sentence) const;
  /// The same with a code and values for programs.
  void note(Finding finding) const;

  const RunContext& context() const { return context_; }
  StageReport& report() const { return report_; }

 private:
  const RunContext& context_;
  StageReport& report_;
};

}  // namespace octafront
