#include <octafront/error.h>

#include "core/stage_timer.h"
#include "improve/improve.h"
#include "improve/passes.h"

#include <chrono>

#include <fmt/format.h>

namespace octafront {
namespace {

using namespace improve;

/// Runs passes and notes what each one did.
class Schedule {
 public:
  Schedule(EditMesh& mesh, const RunContext& context, StageReport& report)
      : mesh_(mesh), context_(context), report_(report), started_(process_cpu_seconds()) {}

  void laplacian(int sweeps, double relaxation, MoveRule rule) {
    note("laplacian moves", laplacian_sweeps(mesh_, sweeps, relaxation, rule, context_));
  }
  void smooth_mean(int sweeps) { note("moves for the mean", improve::smooth_mean(mesh_, sweeps, context_)); }
  void flips(float threshold) { note("reconnections", reconnect(mesh_, threshold, context_)); }
  void optimize(float threshold) { note("optimised vertices", optimize_vertices(mesh_, threshold, context_)); }

 private:
  void note(const char* what, const PassResult& result) {
    const double now = process_cpu_seconds();
    report_.count(fmt::format("pass {}: {}", ++passes_, what), static_cast<double>(result.done));
    report_.count(fmt::format("pass {}: tried", passes_), static_cast<double>(result.tried));
    report_.count(fmt::format("pass {}: us per element", passes_),
                  1e6 * (now - started_) / static_cast<double>(mesh_.live_tets()));
    started_ = process_cpu_seconds();
    context_.report("improve", -1);
  }

  EditMesh& mesh_;
  const RunContext& context_;
  StageReport& report_;
  double started_;
  int passes_ = 0;
};

/// Scores below which elements are worked on. The reference elements of shape.h have .45; .6 is about 30 degrees.
constexpr float kWanted = 0.6f, kWantedBest = 0.65f;
/// Reconnection below this serves the mean.
constexpr float kGood = 0.8f;

void run_fast(Schedule& run, const ImproveOptions& options) {
  run.laplacian(2, options.relaxation, MoveRule::kMeanRises);
  run.flips(kWanted);
  run.optimize(kWanted);
  run.flips(kWanted);
}

void run_default(Schedule& run, const ImproveOptions& options) {
  run.laplacian(2, options.relaxation, MoveRule::kMeanRises);
  run.flips(kWanted);
  run.smooth_mean(2);
  run.flips(kWanted);
  for (int round = 0; round < 3; ++round) {
    run.optimize(kWanted);
    run.flips(kWanted);
  }
}

void run_best(Schedule& run, const ImproveOptions& options) {
  run.laplacian(2, options.relaxation, MoveRule::kMeanRises);
  run.flips(kWantedBest);
  for (int round = 0; round < 4; ++round) {
    run.smooth_mean(2);
    run.flips(kGood);
  }
  run.smooth_mean(2);
  for (int round = 0; round < 5; ++round) {
    run.optimize(kWantedBest);
    run.flips(kWantedBest);
  }
}

void run_schedule(Schedule& run, const ImproveOptions& options) {
  switch (options.level) {
    case ImproveOptions::Level::kNone:
      return;
    case ImproveOptions::Level::kPaper:
      return run.laplacian(options.sweeps, options.relaxation, MoveRule::kWorstRises);
    case ImproveOptions::Level::kFast:
      return run_fast(run, options);
    case ImproveOptions::Level::kDefault:
      return run_default(run, options);
    case ImproveOptions::Level::kBest:
      return run_best(run, options);
  }
}

void check_options(const ImproveOptions& options) {
  if (!(options.relaxation > 0 && options.relaxation <= 1))
    throw OptionError(fmt::format("the relaxation factor must lie in (0, 1], not {}", options.relaxation));
  if (options.sweeps < 0)
    throw OptionError(fmt::format("the number of sweeps must not be negative: {}", options.sweeps));
}

}  // namespace

void improve_mesh(TetMesh& mesh, const SizeField&, const ImproveOptions& options, const RunContext& context,
                  StageReport& report) {
  check_options(options);
  if (options.level == ImproveOptions::Level::kNone || mesh.tets.empty()) return;
  EditMesh edit(TetMesh{mesh});
  Schedule run(edit, context, report);
  run_schedule(run, options);
  mesh = edit.release();
}

}  // namespace octafront
