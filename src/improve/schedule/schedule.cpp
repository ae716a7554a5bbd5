#include "improve/schedule/schedule.h"

#include <octafront/quality.h>

#include "base/core/fixed_point.h"
#include "base/core/parallel.h"
#include "base/core/stage_timer.h"
#include "base/core/validate.h"
#include "base/geometry/predicates.h"
#include "improve/passes/explain.h"
#include "improve/passes/fewest_poor.h"
#include "improve/passes/passes.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

using namespace improve;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// From the coordinates, so that it checks what the passes believe of the elements.
ImproveOptions::Worst worst_of(const EditMesh& mesh) {
  ImproveOptions::Worst worst{2, 180, 0, true};
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Tet& c = mesh.tet(t);
    const Vec3 a = mesh.point(c[0]), b = mesh.point(c[1]), p = mesh.point(c[2]), q = mesh.point(c[3]);
    worst.positive &= orient3d(a, b, p, q) > 0;
    worst.beta = std::min(worst.beta, radius_ratio(a, b, p, q));
    for (const double angle : dihedral_angles(a, b, p, q)) {
      worst.dihedral_min = std::min(worst.dihedral_min, angle);
      worst.dihedral_max = std::max(worst.dihedral_max, angle);
    }
  }
  return worst;
}

/// Runs passes and notes what each one did.
class Schedule {
 public:
  Schedule(EditMesh& mesh, BoundaryGuide* guide, const ImproveOptions& options, const Stage& stage,
           const BeforePass& before_pass = {})
      : mesh_(mesh),
        guide_(guide),
        options_(options),
        stage_(stage),
        before_pass_(before_pass),
        started_(process_cpu_seconds()) {
    if (options_.after_pass) options_.after_pass("start", worst_of(mesh_));
  }

  void laplacian(int sweeps, double relaxation, MoveRule rule) {
    pass("laplacian moves", [&] { return laplacian_sweeps(mesh_, sweeps, relaxation, rule, stage_.context()); });
  }
  void smooth_mean(int sweeps) {
    pass("moves for the mean", [&] { return improve::smooth_mean(mesh_, sweeps, stage_.context()); });
  }
  /// The boundary too.
  void slide_mean() {
    pass("moves and slides for the mean", [&] { return improve::smooth_mean(mesh_, 1, stage_.context(), guide_); });
  }
  void mean_flips(float threshold, Goal goal = Goal::kMean) {
    pass("reconnections for the mean", [&] { return reconnect(mesh_, threshold, goal, stage_.context()); });
  }
  void flips(float threshold) {
    pass("reconnections", [&] { return reconnect(mesh_, threshold, Goal::kWorst, stage_.context(), guide_); });
  }
  void collapse(float threshold) {
    pass("collapsed vertices", [&] { return collapse_vertices(mesh_, threshold, Goal::kMean, stage_.context()); });
  }
  void insert(float threshold) {
    pass("inserted vertices", [&] { return insert_vertices(mesh_, threshold, Goal::kWorst, stage_.context()); });
  }
  void small_polyhedra(float threshold) {
    pass("small polyhedra", [&] { return reconnect_small_polyhedra(mesh_, threshold, stage_.context()); });
  }
  void optimize(float threshold) {
    pass("optimised vertices", [&] { return optimize_vertices(mesh_, threshold, stage_.context(), guide_); });
  }

  /// Rounds for the worst, until one changes nothing or nothing is left; insertion from round `insert_from` on, below
  /// `poor`.
  void rounds_for_worst(int rounds, float threshold, int insert_from, float poor) {
    for (int round = 0; round < rounds && floor().score < threshold; ++round) {
      const std::uint64_t before = changes_;
      if (round >= insert_from) insert(poor);
      optimize(threshold);
      flips(threshold);
      if (changes_ == before && round >= insert_from) return;
    }
  }

  /// Against elements that worse ones around them hide from the passes for the worst.
  void relieve(float threshold) {
    pass("moves against poor elements", [&] { return relieve_vertices(mesh_, threshold, stage_.context()); });
    pass("reconnections against poor elements",
         [&] { return reconnect(mesh_, threshold, Goal::kFewestPoor, stage_.context()); });
    pass("collapses against poor elements",
         [&] { return collapse_vertices(mesh_, threshold, Goal::kFewestPoor, stage_.context()); });
  }

  void edit_boundary(float threshold) {
    if (!guide_ || guide_->tolerance() == 0) return;
    pass("edits of the boundary", [&] {
      const BoundaryEdits edits = improve::edit_boundary(mesh_, threshold, *guide_, stage_.context());
      boundary_edits_ += edits.result.done;
      largest_move_ = std::max(largest_move_, edits.largest_move);
      return edits.result;
    });
  }

  void insert_against_poor(float threshold) {
    pass("insertions against poor elements",
         [&] { return insert_vertices(mesh_, threshold, Goal::kFewestPoor, stage_.context()); });
  }

  void open_flat() {
    pass("flat elements opened", [&] { return open_flat_elements(mesh_, stage_.context()); });
  }

  /// Where the boundary crosses itself it goes back. Returns where that does not help.
  std::vector<VertexIndex> uncross() {
    if (!guide_) return {};
    if (before_pass_) before_pass_(mesh_);
    TakenBack back = take_back_crossings(mesh_, mesh_.points_taken(), *guide_, stage_.context());
    if (back.pass.tried > 0) note("slides taken back", back.pass);
    validate(mesh_);
    return std::move(back.crossing);
  }

  /// What the elements lack, in sum.
  double lack() const {
    return from_fixed(parallel_sum(mesh_.slots(), [this](std::size_t begin, std::size_t end) {
      Fixed sum = 0;
      for (auto t = static_cast<TetIndex>(begin); t < end; ++t)
        if (mesh_.alive(t)) sum += to_fixed(lack_of(mesh_.shape(t).score));
      return sum;
    }));
  }

  Floor floor() const { return mesh_.floor(); }
  double mean_beta() const { return mesh_.mean_beta(); }

  /// Says what stays poor and why, and where the worst of each kind are.
  void explain(const BoundaryInput* input) {
    const Shortfall s = explain_shortfall(mesh_, kReported, input, stage_.context());
    stage_.count(fmt::format("elements below {:.1f}", kReported), static_cast<double>(s.elements));
    for (int cause = 0; cause < Shortfall::kCauses; ++cause)
      stage_.count(kCauseNames[cause].counter, static_cast<double>(s.by_cause[cause].elements));
    stage_.count("edits of the boundary", static_cast<double>(boundary_edits_));
    stage_.count("largest move of the boundary", largest_move_);
    stage_.count("elements below 0.2 or 10 degrees", static_cast<double>(s.poor));
    stage_.count("elements below 0.2 or 10 degrees, not forced", static_cast<double>(s.poor_not_forced));
    if (s.elements == 0) return;
    std::string note = fmt::format(
        "{} below {:.1f} {}:", s.elements == 1 ? "1 element stays" : fmt::format("{} elements stay", s.elements),
        kReported,
        options_.objective == ImproveOptions::Objective::kBalanced ? "by beta or by its dihedral angles"
                                                                   : "by the objective");
    const char* separator = " ";
    for (int cause = 0; cause < Shortfall::kCauses; ++cause) {
      const Shortfall::Class& c = s.by_cause[cause];
      if (c.elements == 0) continue;
      const Vec3 p = mesh_.point(mesh_.tet(c.worst)[0]);
      note += fmt::format("{}{} {} (the worst, {:.3f}, near ({:.6g}, {:.6g}, {:.6g}))", separator, c.elements,
                          kCauseNames[cause].words, mesh_.shape(c.worst).score, p.x, p.y, p.z);
      separator = ", ";
    }
    stage_.note(std::move(note));
  }

 private:
  static constexpr float kReported = 0.4f;
  struct CauseName {
    const char *counter, *words;
  };
  static constexpr CauseName kCauseNames[Shortfall::kCauses] = {
      {"forced by a wedge", "in wedges of less than 20 degrees"},
      {"forced by a corner", "at corners between curves less than 20 degrees apart"},
      {"forced by thin walls", "between sheets or curves nearer than a tenth of their size"},
      {"forced by kept triangles", "on or beside triangles that were kept"},
      {"not forced", "not forced by the input"}};

  template <typename Run>
  void pass(const char* what, Run&& run) {
    if (late_) return;
    if (before_pass_) before_pass_(mesh_);
    note(what, run());
    validate(mesh_);
    if (!options_.seconds || !(clock_.seconds() > *options_.seconds)) return;
    late_ = true;
    stage_.note(fmt::format("the {} s for improvement were over after pass {}", *options_.seconds, passes_));
  }

  void note(const char* what, const PassResult& result) {
    const double now = process_cpu_seconds();
    stage_.count(fmt::format("pass {}: {}", ++passes_, what), static_cast<double>(result.done));
    changes_ += result.done;
    stage_.count(fmt::format("pass {}: tried", passes_), static_cast<double>(result.tried));
    stage_.count(fmt::format("pass {}: us per element", passes_),
                 1e6 * (now - started_) / static_cast<double>(mesh_.live_tets()));
    started_ = process_cpu_seconds();
    // Rounds go on while they gain something: how many there will be, nobody knows before.
    stage_.progress(passes_ / (passes_ + kUsualPasses));
    if (options_.after_pass) options_.after_pass(what, worst_of(mesh_));
  }

  static constexpr double kUsualPasses = 10;

  EditMesh& mesh_;
  BoundaryGuide* guide_;
  const ImproveOptions& options_;
  const Stage& stage_;
  const BeforePass before_pass_;
  double started_;
  Stopwatch clock_;
  bool late_ = false;
  int passes_ = 0;
  std::uint64_t changes_ = 0, boundary_edits_ = 0;
  double largest_move_ = 0;
};

/// Scores below which elements are worked on. The reference elements of shape.h have .45; .6 is about 30 degrees.
constexpr float kWanted = 0.6f, kWantedBest = 0.65f;
/// Below this a new vertex is worth its elements.
constexpr float kPoorToInsert = 0.5f;
/// Below these, reconnection serves the mean.
constexpr float kGood = 0.8f, kGoodBest = 0.9f;

void run_fast(Schedule& run, const ImproveOptions& options) {
  run.laplacian(2, options.relaxation, MoveRule::kMeanRises);
  run.flips(kWanted);
  run.optimize(kWanted);
  run.flips(kWanted);
}

/// More rounds for the mean as long as one raises it by this: none on meshes that the front made, several on poor ones.
constexpr double kWorthARound = 0.002;
constexpr int kMostRounds = 12;

void rounds_for_mean(Schedule& run, float threshold) {
  double before = run.mean_beta();
  for (int round = 0; round < kMostRounds; ++round) {
    run.collapse(threshold);
    run.mean_flips(threshold);
    run.slide_mean();
    const double now = run.mean_beta();
    if (now - before < kWorthARound) return;
    before = now;
  }
}

void run_default(Schedule& run, const ImproveOptions& options) {
  run.laplacian(1, options.relaxation, MoveRule::kMeanRises);
  run.flips(kWanted);
  run.collapse(kWanted);
  run.mean_flips(kGood, Goal::kMeanQuick);
  run.slide_mean();
  const double before = run.mean_beta();
  run.flips(kWanted);
  run.smooth_mean(1);
  if (run.mean_beta() - before > kWorthARound) rounds_for_mean(run, kGood);
  run.rounds_for_worst(4, kWanted, 2, kPoorToInsert);
}

/// Rounds against poor elements end when one takes away less than this part of what the elements lack.
constexpr double kWorthRelief = 0.04;
/// Insertions find next to nothing later, and cost the most.
constexpr int kRoundsWithInsertions = 2;

void relieve(Schedule& run) {
  double before = run.lack();
  for (int round = 0; round < kMostRounds && before > 0; ++round) {
    run.edit_boundary(kComfort);
    run.relieve(kComfort);
    if (round < kRoundsWithInsertions) run.insert_against_poor(kComfort);
    const double now = run.lack();
    if (now > (1 - kWorthRelief) * before) return;
    before = now;
  }
}

void best_for_mean(Schedule& run) {
  run.collapse(kGood);
  run.mean_flips(kGoodBest);
  run.slide_mean();
  run.smooth_mean(1);
}

void best_for_worst(Schedule& run) {
  run.flips(kWantedBest);
  run.small_polyhedra(kWantedBest);
  run.rounds_for_worst(8, kWantedBest, 2, kWanted);
  relieve(run);
}

/// Moves for the mean take vertices out of the corners into which those for the worst have climbed: both again, as long
/// as that raises the worst element by this.
constexpr float kWorthBoth = 0.005f;

void run_best(Schedule& run, const ImproveOptions& options) {
  run.laplacian(2, options.relaxation, MoveRule::kMeanRises);
  run.flips(kWantedBest);
  run.small_polyhedra(kWantedBest);
  rounds_for_mean(run, kGood);
  for (int round = 0; round < 4; ++round) best_for_mean(run);
  best_for_worst(run);
  for (int round = 0; round < kMostRounds; ++round) {
    const Floor before = run.floor();
    best_for_mean(run);
    best_for_worst(run);
    const Floor now = run.floor();
    if (now.beta < before.beta + kWorthBoth && now.score < before.score + kWorthBoth) return;
  }
}

void run_schedule(Schedule& run, const ImproveOptions& options) {
  switch (options.level) {
    case ImproveOptions::Level::kOff:
      return;
    case ImproveOptions::Level::kPaper:
      return run.laplacian(options.sweeps, options.relaxation, MoveRule::kWorstRises);
    case ImproveOptions::Level::kFast:
      return run_fast(run, options);
    case ImproveOptions::Level::kDefault:
      run_default(run, options);
      relieve(run);
      return run.open_flat();
    case ImproveOptions::Level::kBest:
      run_best(run, options);
      return run.open_flat();
  }
}

/// How often a boundary that came to cross itself is tried again with the places frozen, before all of it is.
constexpr int kMostRetries = 3;

/// The features in the numbering of the result; `edges` and `corners` are in that of the mesh that was taken.
Features renumbered(std::vector<Edge> edges, std::vector<VertexIndex> corners, const std::vector<VertexIndex>& taken) {
  std::vector<VertexIndex> result;
  for (VertexIndex v = 0; v < taken.size(); ++v) {
    if (taken[v] == kNone) continue;
    result.resize(std::max<std::size_t>(result.size(), taken[v] + 1), kNone);
    result[taken[v]] = v;
  }
  for (auto& [a, b] : edges) {
    const Edge e{result[a], result[b]};
    a = std::min(e[0], e[1]), b = std::max(e[0], e[1]);
  }
  for (VertexIndex& v : corners) v = result[v];
  std::sort(edges.begin(), edges.end());
  std::sort(corners.begin(), corners.end());
  return {std::move(edges), std::move(corners)};
}

}  // namespace

bool improve_mesh(TetMesh& mesh, const BoundaryInput* input, const ImproveOptions& options, const Stage& stage,
                  Features* features, const BeforePass& before_pass) {
  check_improve_options(options);
  if (options.level == ImproveOptions::Level::kOff || mesh.tets.empty()) return false;
  mesh.wide_cells.clear();  // edits know of tetrahedra alone
  mesh.wide_faces.clear();
  mesh.face_layers.clear();
  const bool moves = input && options.move_boundary && options.level != ImproveOptions::Level::kPaper;
  std::vector<VertexIndex> frozen;  // they, and those around them, stay where they are
  for (int retry = 0;; ++retry) {
    StageReport attempt = stage.report();
    EditMesh edit(std::move(mesh), options.objective);
    std::optional<BoundaryGuide> guide;
    if (moves && retry < kMostRetries) {
      guide.emplace(edit, *input, frozen);
      edit.remember();
    }
    const Stage tried{stage.context(), attempt};
    Schedule run(edit, guide ? &*guide : nullptr, options, tried, before_pass);
    run_schedule(run, options);
    const std::vector<VertexIndex> crossing = run.uncross();
    const bool moved = guide && edit.moved_boundary();
    if (moved && !crossing.empty()) {
      for (const VertexIndex v : crossing) frozen.push_back(edit.number_taken(v));
      mesh = edit.taken();
      continue;
    }
    run.explain(input);
    if (moved && features)
      *features = renumbered(guide->feature_edges_taken(edit), input->of_mesh.corners, edit.numbers_taken());
    mesh = edit.release();
    stage.report() = std::move(attempt);
    stage.count("runs with places of the boundary frozen", retry);
    return moved;
  }
}

void relieve_mesh(TetMesh& mesh, const ImproveOptions& options, const Stage& stage) {
  if (options.level == ImproveOptions::Level::kOff || mesh.tets.empty()) return;
  if (worst_score(mesh, options.objective) >= kComfort) return;
  EditMesh edit(std::move(mesh), options.objective);
  Schedule run(edit, nullptr, options, stage);
  run.rounds_for_worst(4, kWanted, 2, kPoorToInsert);
  relieve(run);
  mesh = edit.release();
}

}  // namespace octafront
