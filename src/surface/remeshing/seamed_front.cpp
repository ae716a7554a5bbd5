// The steps of a complex, on its parts cut open along seams (seams.h).

#include "base/core/elementary.h"
#include "surface/edits/working_mesh.h"
#include "surface/lines/line_sizes.h"
#include "surface/remeshing/front_kind.h"
#include "surface/remeshing/mend_folds.h"
#include "surface/remeshing/outcome.h"
#include "surface/remeshing/periodic_faces.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront::surface {

namespace {

/// A complex that deviates at fewer places than this part of its triangles is not made anew for it.
constexpr double kVeryFew = 1e-4;
/// When the input is noise. It deviates at first, with triangles as small as the input's, at more than kNoise of them;
/// and kManyMore times the triangles leave as many such places, beyond the bound by more than kNoNearer of before.
/// Steps of noise lose their chords only as fast as triangles shrink, and each new triangulation crosses elsewhere.
constexpr double kNoise = 0.08, kManyMore = 1.5, kNoNearer = 0.5;
/// How often sizes are lowered where it deviates, in each of two rounds at most. (Two in the first and one in the
/// second take half the time, and leave 208 places of a skull too far instead of 6, and 138 elements below .4 instead
/// of 27.)
constexpr int kRefinements = 3;
/// The gradation around sizes lowered for deviation: steeper than elsewhere, since they belong to single ridges and
/// tips. That makes far fewer elements.
constexpr double kSteep = 0.4;
/// How often points of the input are inserted where it still deviates.
constexpr int kApproaches = 3;
/// Mended once more at the very end, within this part of the bound on deviation.
constexpr double kLittle = 0.3;
/// Up to this part of all triangles, those that cross are few. More than on single surfaces: sheets may lie a voxel
/// apart.
constexpr double kFewCrossingPart = 0.005;
/// Points are inserted into crossing triangles if these are fewer than kFewToDivide of all, and again if no more than
/// kWorthAnother of them are left.
constexpr double kFewToDivide = 0.02, kWorthAnother = 0.7;
/// Not nearer to their triangles than this part of their size.
constexpr double kInPlane = 0.02;
/// What crosses still at the end may be divided into triangles of this 2r/R, so often.
constexpr double kAnyShape = 0.05;
constexpr int kLastMendings = 3;
/// How a budget of elements is kept: by so many raises of the bound on deviation at most, each by a factor from here to
/// there, by how the number of elements fell with the last one; one that exceeds it by so much is near enough.
constexpr int kMostRaises = 6;
constexpr double kLeastRaise = 1.2, kMostRaise = 4, kNearBudget = 1.1;
constexpr double kFirstSlope = 0.7, kFlattest = 0.3, kSteepest = 1.5;
/// A raise by less than whose power the number falls is in vain: the input turns within its own triangles, so it is
/// noise, or as coarse as it may be.
constexpr double kVainSlope = 0.1;
/// Sizes that are given may meet noise, too: where the input takes so many times the elements that they ask for, and so
/// many for each of its own triangles, raises of the bound from twice to four times it tell whether they are in vain.
constexpr double kManyTimes = 3, kManyForEach = 8, kDoubled = 2, kFourfold = 4;

/// A part of the elements that is said.
constexpr double kWorthTelling = 0.2;

/// Per vertex whether it is on a seam or another line.
std::vector<std::uint8_t> on_lines(const WorkingMesh& mesh) {
  std::vector<std::uint8_t> is_fixed(mesh.points.size());
  for (VertexIndex v = 0; v < is_fixed.size(); ++v) is_fixed[v] = mesh.on_curve(v);
  return is_fixed;
}

class SeamedFront : public FrontKind {
 public:
  explicit SeamedFront(FrontWork& work)
      : FrontKind(work), seamed_(cut_along_seams(work.known, work.periods)), least_(work.known, work.limits.least) {}

  InputSurface& input() override { return seamed_.input; }
  const Features& features() const override { return seamed_.features; }
  const StripRules& strips() const override { return kStripsOfWalls; }

  /// What most triangles would be made smaller for in further rounds.
  void foresee(RoundSizes& sizes) override {
    is_noise_ = seams_per_triangle() > work_.limits.most_seams;
    if (is_noise_ || !work_.limits_deviation()) return;
    set_features(input(), {});
    set_features(input(), features_at_scale(input(), features(), sizes.now()));
    std::vector<std::uint8_t> is_fixed(input().mesh.points.size(), 0);
    const std::vector<Curve> curves = chained_curves(input(), seamed_, sizes.now(), is_fixed).curves;
    SizeField foreseen = followed_within(work_.tolerance, curves, sizes.now());
    if (work_.budget.is_limited()) {
      stray_within_budget(curves, sizes.now(), foreseen);
    } else {
      is_noise_ = follows_in_vain(curves, sizes.now(), foreseen);
      if (is_noise_) return;
    }
    tell_part(sizes.now(), foreseen, "the deviation", "a larger `max_deviation` saves them");
    sizes.start_with(work_.budget.affordable(foreseen, sizes.first(), work_.counts.rounds));
  }

  /// Smaller where corners of seams are nearer together; the same on opposite faces of a cell.
  SizeField fitted(const SizeField& in_strips, const std::vector<std::uint8_t>& is_fixed) const override {
    const RunContext& context = work_.stage.context();
    const SizeField in_corners = fitted_to_corners(seamed_.input, seamed_, is_fixed, in_strips, least_, context);
    const std::vector<PointSize> small = least_.small_shells(in_corners);
    return periodic_sizes(small.empty() ? in_corners : capped_at(in_corners, small, context, {.gradation = kSteep}),
                          work_.surface(), work_.periods, context);
  }

  std::vector<Curve> curves(const SizeField& sizes, std::vector<std::uint8_t>& is_fixed) override {
    return divided_curves(input(), seamed_, sizes, is_fixed);
  }

  void settle_input(WorkingMesh& mesh) const override {
    mesh.pinned = seamed_.pinned;
    for (VertexIndex v = 0; v < mesh.pinned.size(); ++v)
      if (mesh.pinned[v] || v >= seamed_.first_tip) mesh.kind[v] = VertexKind::kCorner;
  }

  void adjust(Draft& draft, const RoundSizes& sizes) override {
    change_between_seams(draft);
    DeviationWatch watch(kLeftAlone * work_.tolerance, work_.tolerance, work_.surface(), work_.known.tree(),
                         Fine::kCorners, work_.bound);
    refine_far(draft, watch, sizes.first());
    if (is_noise_) return;
    mend_crossings(draft);
    mend_between_lines(draft.mesh, work_.tolerance);
    approach_far(draft, watch);
    clear(draft);
  }

  bool is_noise() const override { return is_noise_; }

  /// What does not agree shows beside what crosses; both are left to the same round.
  std::optional<std::string> first_defect(const SurfaceMesh& made, bool, std::vector<Vec3>& at) override {
    return first_complex_defect_but_crossings(made, work_.stage.context(), &at);
  }

  /// By the sizes that were fitted to the seams.
  void answer(const std::vector<Vec3>& places, const Outcome& made, bool, RoundSizes& sizes) override {
    const SizeField& by = made.result.sizes;
    sizes.cap_or_keep(places, kCap, false, [&](Vec3 p) -> std::optional<KeptPlace> {
      if (by.at(p) < kVain * sizes.first().at(p) || is_as_large(p, by))
        return KeptPlace{p, kKeptRadius * by.at(p), false};
      if (is_in_vain(p, sizes)) return KeptPlace{p, kKeptRadius * sizes.first().at(p)};
      return {};
    });
  }

  /// Seams stay as they are.
  bool refine_at(const std::vector<Vec3>& places, Draft& draft) override {
    draft.sizes =
        capped_at(draft.sizes, smaller_at(places, kCap, draft.sizes), work_.stage.context(), {.gradation = kSteep});
    divide_long(draft);
    divide_repeated(draft);
    clear(draft);
    return true;
  }

  bool leaves_far(std::size_t far, const Outcome& made) const override {
    return work_.counts.rounds > 1 ||
           static_cast<double>(far) < kVeryFew * static_cast<double>(made.result.surface.triangles.size());
  }

  void cap_far(const Nearness& near, RoundSizes& sizes) const override {
    sizes.add(near.wanted, {.gradation = kSteep});
  }

 private:
  std::vector<PointSize> not_below_least(std::vector<PointSize> wanted) const {
    for (PointSize& w : wanted) w.size = std::max(w.size, least_.at(w.p));
    return wanted;
  }

  double seams_per_triangle() const {
    std::size_t seams = 0;
    const auto sides = static_cast<HalfEdge>(3 * work_.surface().triangles.size());
    for (HalfEdge h = 0; h < sides; ++h) seams += seamed_.input.is_seam(h);
    return 3 * static_cast<double>(seams) / static_cast<double>(sides);
  }

  /// What smaller sizes make of the elements, by the prediction.
  void tell_part(const SizeField& without, const SizeField& with, const char* what, const char* advice) {
    const double part = 1 - std::min(1.0, work_.budget.expected(without) / work_.budget.expected(with));
    work_.stage.count(fmt::format("made for {}, % of the elements", what), 100 * part);
    if (part > kWorthTelling)
      work_.stage.note(fmt::format("{} makes about {:.2g} % of the elements: {}", what, 100 * part, advice));
  }

  SizeField followed_within(double tolerance, const std::vector<Curve>& curves, const SizeField& sizes) const {
    const RunContext& context = work_.stage.context();
    const std::vector<PointSize> wanted =
        not_below_least(sizes_by_flatness(seamed_.input, curves, sizes, tolerance, context));
    return capped_at(sizes, wanted, context, {.gradation = kSteep});
  }

  bool follows_in_vain(const std::vector<Curve>& curves, const SizeField& sizes, const SizeField& foreseen) {
    ElementBudget& budget = work_.budget;
    const double count = budget.expected(foreseen);
    const double many = kManyForEach * static_cast<double>(work_.surface().triangles.size());
    if (count < many || count < kManyTimes * budget.expected(sizes)) return false;
    const double doubled = budget.expected(followed_within(kDoubled * work_.tolerance, curves, sizes));
    const double fourfold = budget.expected(followed_within(kFourfold * work_.tolerance, curves, sizes));
    return elementary::log(doubled / fourfold) < kVainSlope * elementary::log(kFourfold / kDoubled);
  }

  /// The surface may deviate farther if following it would take more elements than the budget has.
  void stray_within_budget(const std::vector<Curve>& curves, const SizeField& sizes, SizeField& foreseen) {
    ElementBudget& budget = work_.budget;
    double& tolerance = work_.tolerance;
    const double asked = tolerance, first = budget.expected(foreseen);
    double count = first, slope = kFirstSlope;
    for (int step = 0; step < kMostRaises && count > kNearBudget * budget.most(); ++step) {
      const double raise = std::clamp(elementary::pow(count / budget.most(), 1 / slope), kLeastRaise, kMostRaise);
      SizeField followed = followed_within(tolerance * raise, curves, sizes);
      const double now = budget.expected(followed);
      slope = elementary::log(count / now) / elementary::log(raise);
      is_noise_ = slope < kVainSlope;
      if (is_noise_) {
        tolerance = asked;
        return;
      }
      foreseen = std::move(followed);
      tolerance *= raise;
      slope = std::clamp(slope, kFlattest, kSteepest);
      count = now;
    }
    if (tolerance == asked) return;
    work_.stage.note(
        fmt::format("within {:.3g} of the input there would be about {:.2g} million elements; the automatic size has a "
                    "budget of {:.2g} million, so the surface may stray by {:.3g}. For more ask for it, e.g. with "
                    "`max_deviation`, `size` or `elements`",
                    asked, first / 1e6, budget.most() / 1e6, tolerance));
  }

  /// What remove_input_vertices() and improve_surface() do of a single surface: seams first, which are the same for all
  /// that ends there, and once more when their surroundings are coarse.
  void change_between_seams(Draft& draft) {
    const RunContext& context = work_.stage.context();
    WorkingMesh& mesh = draft.mesh;
    coarsen_seams(mesh, work_.periods.cell, context, work_.counts.coarsen);
    remove_input_vertices(mesh, draft.sizes, context, work_.counts.coarsen);
    coarsen_seams(mesh, work_.periods.cell, context, work_.counts.coarsen);
    settle_seams(mesh, draft.sizes);
    work_.progress(0.6);
    work_.counts.divided_edges = divide_repeated_edges(mesh, work_.known, work_.periods, draft.sizes);
    improve_surface(mesh, input(), draft.curves, draft.sizes, context, work_.counts.improve);
    divide_repeated(draft);
  }

  /// Mends what crosses at last.
  void clear(Draft& draft) {
    draft.is_clear = mend_between_lines(draft.mesh, kLittle * work_.tolerance) || mend_last_crossings(draft);
  }

  void divide_repeated(Draft& draft) {
    work_.counts.divided_edges += divide_repeated_edges(draft.mesh, work_.known, work_.periods, draft.sizes);
    work_.counts.divided_edges += divide_repeated_triangles(draft.mesh, work_.known, work_.periods, draft.sizes);
  }

  bool mend_between_lines(WorkingMesh& mesh, double tolerance) {
    const auto part = static_cast<std::int64_t>(kFewCrossingPart * static_cast<double>(mesh.triangle_count()));
    const PlaceLimits limits{tolerance, HUGE_VAL, std::max(kFewCrossing, part), &seamed_.input.patch};
    return mend_places(mesh, on_lines(mesh), limits, false);
  }

  /// Smaller sizes and more triangles where it deviates, while that helps.
  void refine_far(Draft& draft, DeviationWatch& watch, const SizeField& first) {
    Straying at_first;
    for (int k = 0; k < kRefinements; ++k) {
      const std::vector<FarPlace> places = far_places(work_, draft.mesh, watch);
      const Straying now = straying(places, draft);
      if (k == 0) at_first = now;
      is_noise_ = work_.counts.rounds == 1 && is_noise(at_first, now);
      if (is_noise_) return;
      const std::vector<PointSize> wanted = note_wanted(draft, places);
      if (wanted.empty()) return;
      const SizeField finer = capped_at(draft.sizes, wanted, work_.stage.context(), {.gradation = kSteep});
      draft.sizes = work_.budget.affordable(finer, first, work_.counts.rounds);
      divide_long(draft);
      divide_repeated(draft);
      if (work_.budget.is_spent()) return;
    }
  }

  std::vector<PointSize> note_wanted(Draft& draft, const std::vector<FarPlace>& places) const {
    std::vector<PointSize> wanted = not_below_least(sizes_against(places, work_.tolerance, draft.sizes));
    draft.nearness.wanted.insert(draft.nearness.wanted.end(), wanted.begin(), wanted.end());
    return wanted;
  }

  /// Where it deviates with triangles as small as the input's: at how many places, how far beyond the bound in all; and
  /// how many triangles there are.
  struct Straying {
    double places = 0, beyond = 0, triangles = 0;
  };
  Straying straying(const std::vector<FarPlace>& places, const Draft& draft) const {
    Straying all;
    all.triangles = static_cast<double>(front_triangles(draft.mesh).size());
    for (const FarPlace& p : places) {
      if (p.distance < work_.tolerance) continue;
      if (draft.sizes.at(p.at) > longest_edge_of(work_.known.tree().corners(p.on_input.face))) continue;
      ++all.places;
      all.beyond += p.distance - work_.tolerance;
    }
    return all;
  }

  /// Chords across edges of coarse facets come nearer as they get shorter; in noise there are only more of them.
  /// In a periodic cell the second look costs the same faces on opposite sides: what is many at first is noise there.
  bool is_noise(const Straying& first, const Straying& now) const {
    if (!(first.places > kNoise * first.triangles)) return false;
    if (work_.periods.cell.is_periodic()) return true;
    return now.triangles > kManyMore * first.triangles && now.places >= first.places &&
           now.beyond * first.places > kNoNearer * first.beyond * now.places;
  }

  /// Points of the complex where the draft deviates still. What is left then lies beside seams: another round has to
  /// divide these.
  void approach_far(Draft& draft, DeviationWatch& watch) {
    std::vector<FarPlace> places = far_places(work_, draft.mesh, watch);
    for (int k = 0; k < kApproaches; ++k) {
      std::erase_if(places, [&](const FarPlace& p) { return p.distance < kComeNear * work_.tolerance; });
      const std::uint64_t put_in =
          places.empty() ? 0 : draw_to_input(draft.mesh, input(), work_.known.tree(), draft.is_fixed, places);
      if (put_in == 0) break;
      work_.counts.approached += put_in;
      places = far_places(work_, draft.mesh, watch);
    }
    draft.nearness.far = positions_beyond(work_.tolerance, places);
    draft.nearness.farthest = farthest_of(places);
    note_wanted(draft, places);
  }

  /// Puts points of the complex into triangles that cross others: chords between near sheets.
  void mend_crossings(Draft& draft, double least_shape = kFairShape) {
    WorkingMesh& mesh = draft.mesh;
    for (double before = HUGE_VAL;;) {
      const std::vector<std::uint32_t> number = front_triangles(mesh);
      const SurfaceMesh alive = sewn_triangles(mesh, number);
      const std::vector<std::uint32_t> crossing = triangles_of(find_crossings(alive));
      if (crossing.empty()) return;
      const auto now = static_cast<double>(crossing.size());
      if (now > kFewToDivide * static_cast<double>(number.size()) || now > kWorthAnother * before) return;
      before = now;
      std::vector<FarPlace> places = places_under(crossing, alive, work_.known.tree());
      for (FarPlace& place : places) place.triangle = number[place.triangle];
      // A point in the plane of its triangle changes nothing, and leaves a flat element.
      std::erase_if(places, [&](const FarPlace& p) {
        return p.distance < kInPlane * std::sqrt(length(mesh.area_vector(p.triangle)));
      });
      const std::uint64_t put_in =
          draw_to_input(mesh, input(), work_.known.tree(), draft.is_fixed, places, least_shape);
      work_.counts.approached += put_in;
      if (put_in == 0) return;
    }
  }

  /// Whatever the shapes, where a few cross still: another round costs more. True if it is known that nothing crosses.
  bool mend_last_crossings(Draft& draft) {
    for (int k = 0; k < kLastMendings; ++k) {
      mend_crossings(draft, kAnyShape);
      if (mend_between_lines(draft.mesh, kLittle * work_.tolerance)) return true;
    }
    return false;
  }

  SeamedSurface seamed_;
  LeastSizes least_;
  bool is_noise_ = false;
};

}  // namespace

std::unique_ptr<FrontKind> make_seamed_front(FrontWork& work) {
  return std::make_unique<SeamedFront>(work);
}

}  // namespace octafront::surface
