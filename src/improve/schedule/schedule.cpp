#include "improve/schedule/schedule.h"

#include <octafront/option_table.h>
#include <octafront/quality.h>

#include "base/core/elementary.h"
#include "base/core/fixed_point.h"
#include "base/core/function_ref.h"
#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/geometry/predicates.h"
#include "base/shared/packing.h"
#include "improve/passes/explain.h"
#include "improve/passes/fewest_poor.h"
#include "improve/passes/passes.h"
#include "improve/schedule/kept_labels.h"
#include "improve/schedule/mesh_of_pieces.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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
ImproveOptions::Worst worst_of(const MeshOfPieces& mesh) {
  ImproveOptions::Worst worst{2, 180, 0, true};
  mesh.for_each_tet([&](const Tet& c) {
    const auto points = mesh.points();
    const Vec3 a = points[c[0]], b = points[c[1]], p = points[c[2]], q = points[c[3]];
    worst.positive &= orient3d(a, b, p, q) > 0;
    worst.beta = std::min(worst.beta, radius_ratio(a, b, p, q));
    for (const double angle : dihedral_angles(a, b, p, q)) {
      worst.dihedral_min = std::min(worst.dihedral_min, angle);
      worst.dihedral_max = std::max(worst.dihedral_max, angle);
    }
  });
  std::array<double, 4> least{worst.beta, worst.dihedral_min, -worst.dihedral_max, worst.positive ? 1.0 : 0.0};
  mesh.comm().least(least, "worst elements");
  return {least[0], least[1], -least[2], least[3] == 1};
}

/// What passes of one name did, in all pieces.
struct PassTally {
  std::string what;
  PassResult result;
};

/// What was done to one piece, or to all.
struct Tally {
  std::vector<PassTally> passes;  ///< in the order in which their names came up
  std::uint64_t boundary_edits = 0;
  double largest_move = 0;

  void add(std::string_view what, const PassResult& result) {
    const auto found = std::ranges::find(passes, what, &PassTally::what);
    if (found == passes.end())
      passes.push_back({std::string(what), result});
    else
      found->result += result;
  }
  Tally& operator+=(const Tally& o) {
    for (const PassTally& pass : o.passes) add(pass.what, pass.result);
    boundary_edits += o.boundary_edits;
    largest_move = std::max(largest_move, o.largest_move);
    return *this;
  }

  Bytes packed() const {
    Packer to;
    to.add(passes.size()), to.add(boundary_edits), to.add(largest_move);
    for (const PassTally& pass : passes) {
      to.add_text(pass.what), to.add(pass.result);
    }
    return std::move(to.bytes());
  }
  static Tally unpacked(const Bytes& bytes) {
    Tally tally;
    if (bytes.empty()) return tally;  // of a piece without elements
    Unpacker from(bytes);
    const auto passes = from.take<std::size_t>();
    tally.boundary_edits = from.take<std::uint64_t>();
    tally.largest_move = from.take<double>();
    for (std::size_t k = 0; k < passes; ++k) {
      std::string what = from.take_text();
      tally.passes.push_back({std::move(what), from.take<PassResult>()});
    }
    return tally;
  }
};

/// What all workers have in common.
struct Setting {
  const ImproveOptions& options;
  const RunContext& context;
  const Stopwatch clock{};
  std::atomic<bool> late{false};
};

/// Runs passes on a piece and notes what each one did.
class Schedule {
 public:
  Schedule(EditMesh& mesh, BoundaryGuide* guide, Setting& setting, Tally& tally)
      : mesh_(mesh), guide_(guide), setting_(setting), tally_(tally) {}

  void laplacian(int sweeps, double relaxation, MoveRule rule) {
    pass("laplacian moves", [&] { return laplacian_sweeps(mesh_, sweeps, relaxation, rule, setting_.context); });
  }
  void smooth_mean(int sweeps) {
    pass("moves for the mean", [&] { return improve::smooth_mean(mesh_, sweeps, setting_.context); });
  }
  /// The boundary too.
  void slide_mean() {
    pass("moves and slides for the mean", [&] { return improve::smooth_mean(mesh_, 1, setting_.context, guide_); });
  }
  void mean_flips(float threshold, Goal goal = Goal::kMean) {
    pass("reconnections for the mean", [&] { return reconnect(mesh_, threshold, goal, setting_.context); });
  }
  void flips(float threshold) {
    pass("reconnections", [&] { return reconnect(mesh_, threshold, Goal::kWorst, setting_.context, guide_); });
  }
  void collapse(float threshold) {
    pass("collapsed vertices", [&] { return collapse_vertices(mesh_, threshold, Goal::kMean, setting_.context); });
  }
  void insert(float threshold) {
    pass("inserted vertices", [&] { return insert_vertices(mesh_, threshold, Goal::kWorst, setting_.context); });
  }
  void small_polyhedra(float threshold) {
    pass("small polyhedra", [&] { return reconnect_small_polyhedra(mesh_, threshold, setting_.context); });
  }
  void optimize(float threshold) {
    pass("optimised vertices", [&] { return optimize_vertices(mesh_, threshold, setting_.context, guide_); });
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
    pass("moves against poor elements", [&] { return relieve_vertices(mesh_, threshold, setting_.context); });
    pass("reconnections against poor elements",
         [&] { return reconnect(mesh_, threshold, Goal::kFewestPoor, setting_.context); });
    pass("collapses against poor elements",
         [&] { return collapse_vertices(mesh_, threshold, Goal::kFewestPoor, setting_.context); });
  }

  void edit_boundary(float threshold) {
    if (!guide_ || guide_->tolerance() == 0) return;
    pass("edits of the boundary", [&] {
      const BoundaryEdits edits = improve::edit_boundary(mesh_, threshold, *guide_, setting_.context);
      tally_.boundary_edits += edits.result.done;
      tally_.largest_move = std::max(tally_.largest_move, edits.largest_move);
      return edits.result;
    });
  }

  void insert_against_poor(float threshold) {
    pass("insertions against poor elements",
         [&] { return insert_vertices(mesh_, threshold, Goal::kFewestPoor, setting_.context); });
  }

  void open_flat() {
    pass("flat elements opened", [&] { return open_flat_elements(mesh_, setting_.context); });
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

 private:
  template <typename Run>
  void pass(const char* what, Run&& run) {
    if (setting_.late.load(std::memory_order_relaxed)) return;
    const PassResult result = run();
    tally_.add(what, result);
    changes_ += result.done;
    validate(mesh_);
    const std::optional<double>& seconds = setting_.options.seconds;
    if (seconds && setting_.clock.seconds() > *seconds) setting_.late = true;
  }

  EditMesh& mesh_;
  BoundaryGuide* guide_;
  Setting& setting_;
  Tally& tally_;
  std::uint64_t changes_ = 0;
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
/// Around triangles that cross, so many rings of elements are looked at.
constexpr int kRingsAtCrossings = 6;
/// Around vertices that were at the rim of a piece, these move again, too.
constexpr int kRingsAtRim = 1;
/// Around elements that are still poor once pieces have been worked on.
constexpr int kRingsAtPoor = 3;

/// A whole mesh, piece by piece.
class Improvement {
 public:
  /// `moves`: whether the boundary may.
  Improvement(TetMesh&& mesh, const BoundaryInput* input, bool moves, const ImproveOptions& options, const Stage& stage,
              Tets tets = Tets::kAll)
      : input_(input),
        stage_(stage),
        setting_{options, stage.context()},
        mesh_(std::move(mesh), options.objective, moves ? input : nullptr, Comm(stage.context().ranks), tets),
        moves_(moves) {
    if (input) ground_ = std::make_shared<const BoundaryGround>(*input);
    tell("start");
  }

  MeshOfPieces& mesh() { return mesh_; }
  /// From now on the boundary stays.
  void hold_boundary() { moves_ = false; }

  using Passes = FunctionRef<void(Schedule&)>;

  /// Runs passes on all pieces, or on those around the vertices that are marked.
  void run(const char* what, const std::vector<std::uint8_t>& waiting, int rings, Passes passes) {
    if (waiting.empty() || setting_.late) return;
    mesh_.work(
        waiting, rings,
        [&](MeshPiece& piece) {
          Tally tally;
          work_on(piece, [&](BoundaryGuide* guide) {
            Schedule schedule(*piece.mesh, guide, setting_, tally);
            passes(schedule);
          });
          return tally.packed();
        },
        [&](std::span<const Bytes> of_pieces) {
          for (const Bytes& bytes : of_pieces) tally_ += Tally::unpacked(bytes);
          ++stages_;
          tell(what);
        },
        [&](double part) { progress(part); });
  }

  /// Where the boundary crosses itself it goes back. Returns where that does not help.
  std::vector<VertexIndex> uncross() {
    std::vector<VertexIndex> crossing;
    const std::vector<std::uint8_t> marks = mesh_.corners_of_crossings();
    if (marks.empty()) return crossing;
    const Bytes found = mesh_.work_on_one(marks, kRingsAtCrossings, [&](MeshPiece& piece) {
      Packer to;
      work_on(piece, [&](BoundaryGuide* guide) {
        std::vector<Vec3> home;
        for (VertexIndex v = 0; v < piece.vertices.size(); ++v)
          home.push_back(piece.vertices[v] < mesh_.home().size() ? mesh_.home()[piece.vertices[v]]
                                                                 : piece.mesh->point(v));
        TakenBack back = take_back_crossings(*piece.mesh, home, *guide, setting_.context);
        for (VertexIndex& v : back.crossing) v = piece.vertices[v];
        to.add(back.pass), to.add(back.crossing);
      });
      return std::move(to.bytes());
    });
    Unpacker from(found);
    tally_.add("slides taken back", from.take<PassResult>());
    from.take(crossing);
    return crossing;
  }

  /// Says what stays poor and why, and where the worst of each kind are.
  void explain() {
    Shortfall shortfall;
    std::string note;
    if (const std::vector<std::uint8_t> poor = mesh_.corners_below(kReported); !poor.empty()) {
      const Bytes found = mesh_.work_on_one(poor, 0, [&](MeshPiece& piece) {
        const Shortfall here =
            explain_shortfall(*piece.mesh, kReported, input_ ? &ground_->force : nullptr, setting_.context);
        Packer to;
        to.add(here), to.add_text(in_words(here, *piece.mesh));
        return std::move(to.bytes());
      });
      Unpacker from(found);
      shortfall = from.take<Shortfall>(), note = from.take_text();
    }
    for (const PassTally& pass : tally_.passes) {
      stage_.count(pass.what, static_cast<double>(pass.result.done));
      stage_.count(fmt::format("{}: tried", pass.what), static_cast<double>(pass.result.tried));
    }
    stage_.count("pieces CPU seconds", mesh_.piece_seconds());
    stage_.count(fmt::format("elements below {:.1f}", kReported), static_cast<double>(shortfall.elements));
    for (int cause = 0; cause < Shortfall::kCauses; ++cause)
      stage_.count(kCauseNames[cause].counter, static_cast<double>(shortfall.by_cause[cause].elements));
    stage_.count("edits of the boundary", static_cast<double>(tally_.boundary_edits));
    stage_.count("largest move of the boundary", tally_.largest_move);
    stage_.count("elements below 0.2 or 10 degrees", static_cast<double>(shortfall.poor));
    stage_.count("elements below 0.2 or 10 degrees, not forced", static_cast<double>(shortfall.poor_not_forced));
    if (!note.empty()) stage_.note(std::move(note));
    if (setting_.late) stage_.note(fmt::format("the {} s for improvement were over", *setting_.options.seconds));
  }

  void forget_tally() { tally_ = {}; }

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

  /// Each stage has less to do than the one before; how many there will be, nobody knows.
  void progress(double part_of_stage) const {
    constexpr double kLeft = 0.3;
    stage_.progress(1 - elementary::pow(kLeft, stages_ + part_of_stage));
  }

  void tell(const char* what) const {
    if (setting_.options.after_pass) setting_.options.after_pass(what, worst_of(mesh_));
  }

  template <class Work>
  void work_on(MeshPiece& piece, const Work& work) {
    EditMesh& mesh = *piece.mesh;
    if (!moves_) return work(nullptr);
    const Features features = piece.features;
    const BoundaryInput input{input_->surface,   input_->tree, input_->features, features,
                              input_->tolerance, piece.pinned, input_->bound,    piece.frozen};
    BoundaryGuide guide(mesh, input, piece.at_rim, ground_);
    work(&guide);
    piece.features.edges = guide.feature_edges();
  }

  std::string in_words(const Shortfall& s, const EditMesh& mesh) const {
    const bool is_balanced = setting_.options.objective == ImproveOptions::Objective::kBalanced;
    std::string note = fmt::format(
        "{} below {:.1f} {}:", s.elements == 1 ? "1 element stays" : fmt::format("{} elements stay", s.elements),
        kReported, is_balanced ? "by beta or by its dihedral angles" : "by the objective");
    const char* separator = " ";
    for (int cause = 0; cause < Shortfall::kCauses; ++cause) {
      const Shortfall::Class& c = s.by_cause[cause];
      if (c.elements == 0) continue;
      const Vec3 p = mesh.point(mesh.tet(c.worst)[0]);
      // How poor it is the summary says: it may be moved still.
      note += fmt::format("{}{} {} (the worst near ({:.6g}, {:.6g}, {:.6g}))", separator, c.elements,
                          kCauseNames[cause].words, p.x, p.y, p.z);
      separator = ", ";
    }
    return note;
  }

  const BoundaryInput* input_;
  const Stage& stage_;
  Setting setting_;
  std::shared_ptr<const BoundaryGround> ground_;
  MeshOfPieces mesh_;
  Tally tally_;
  int stages_ = 0;
  bool moves_;
};

void relieve_places(Improvement& improvement) {
  improvement.run("places", improvement.mesh().corners_below(kWanted), kRingsAtPoor, [](Schedule& run) {
    run.rounds_for_worst(4, kWanted, 2, kPoorToInsert);
    relieve(run);
  });
}

/// Where there is nothing to improve, as in the lattice, no piece is made.
std::vector<std::uint8_t> waiting_at_first(const MeshOfPieces& mesh, ImproveOptions::Level level) {
  return level == ImproveOptions::Level::kPaper ? mesh.all() : mesh.corners_to_improve(kGoodEnough, kGoodBest);
}

bool uses_places(ImproveOptions::Level level) {
  return level == ImproveOptions::Level::kDefault || level == ImproveOptions::Level::kBest;
}

}  // namespace

bool improve_mesh(TetMesh& mesh, const BoundaryInput* input, const ImproveOptions& options, const Stage& stage,
                  Features* features, Tets tets, const MeshOfPieces::BeforeStage& before_stage) {
  Options ranges;
  ranges.improve = options;
  check_ranges(ranges);
  const bool is_empty = tets == Tets::kAll && mesh.tets.empty();
  if (options.level == ImproveOptions::Level::kOff || is_empty) return false;
  const KeptLabels labels(mesh);
  std::vector<VertexIndex> numbers;
  if (mesh.tets.empty() && tets == Tets::kAll) {
    labels.put_back(mesh, numbers);
    return false;
  }
  const bool moves = input && options.move_boundary && options.level != ImproveOptions::Level::kPaper;
  Improvement improvement(std::move(mesh), input, moves, options, stage, tets);
  MeshOfPieces& pieces = improvement.mesh();
  pieces.call_before_stages(before_stage);
  int retries = 0;
  for (;;) {
    improvement.run("pieces", waiting_at_first(pieces, options.level), kRingsAtRim,
                    [&](Schedule& run) { run_schedule(run, options); });
    if (uses_places(options.level)) relieve_places(improvement);
    if (!moves || retries == kMostRetries) break;
    const std::vector<VertexIndex> crossing = improvement.uncross();
    if (crossing.empty()) break;
    pieces.freeze(crossing);
    pieces.rewind();
    improvement.forget_tally();
    if (++retries == kMostRetries) improvement.hold_boundary();
  }
  improvement.explain();
  stage.count("runs with places of the boundary frozen", retries);
  const bool moved = moves && retries < kMostRetries && pieces.moved_boundary();
  mesh = pieces.release(moved ? features : nullptr, labels.needs_numbers() ? &numbers : nullptr);
  labels.put_back(mesh, numbers);
  return moved;
}

void relieve_mesh(TetMesh& mesh, const ImproveOptions& options, const Stage& stage) {
  if (options.level == ImproveOptions::Level::kOff || mesh.tets.empty()) return;
  if (worst_score(mesh, options.objective) >= kComfort) return;
  const KeptLabels labels(mesh);
  Improvement improvement(std::move(mesh), nullptr, false, options, stage);
  relieve_places(improvement);
  std::vector<VertexIndex> numbers;
  mesh = improvement.mesh().release(nullptr, labels.needs_numbers() ? &numbers : nullptr);
  labels.put_back(mesh, numbers);
}

}  // namespace octafront
