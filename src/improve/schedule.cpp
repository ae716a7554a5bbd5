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

/// Scores below which elements are worked on, first on the plain mesh, then after smoothing.
constexpr float kFlipThreshold = 0.5f;
constexpr float kOptimizeThreshold = 0.5f;

void run_schedule(Schedule& run, const ImproveOptions& options) {
  using Level = ImproveOptions::Level;
  if (options.level == Level::kPaper) {
    run.laplacian(options.sweeps, options.relaxation, MoveRule::kWorstRises);
    return;
  }
  const int rounds = options.level == Level::kFast ? 1 : options.level == Level::kDefault ? 3 : 8;
  run.flips(kFlipThreshold);
  run.laplacian(2, options.relaxation, MoveRule::kMeanRises);
  run.flips(kFlipThreshold);
  for (int round = 0; round < rounds; ++round) {
    run.optimize(kOptimizeThreshold);
    run.flips(kFlipThreshold);
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
