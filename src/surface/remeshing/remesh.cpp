#include "surface/remeshing/remesh.h"

#include "base/core/validate.h"
#include "surface/edits/faces_of_input.h"
#include "surface/edits/working_mesh.h"
#include "surface/front/surface_front.h"
#include "surface/remeshing/front_kind.h"
#include "surface/remeshing/periodic_faces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using namespace surface;

/// Rounds of capping the sizes around what crosses. CT isosurfaces of half a million triangles need up to 16.
constexpr int kMostRounds = 24;
/// Where all rounds together have made so many times the triangles of the last one, no other round is made: no surface
/// takes more than so many times the work of its last.
constexpr double kWornOut = 10;
/// What crosses is not bound by the budget, but no smaller triangles are tried from this part of it on: they would take
/// more elements than it has.
constexpr double kMostTriangles = 0.3;

/// A draft is made finer so often where it is wrong at fewer places than this part of its triangles, or this many:
/// another round costs more.
constexpr int kDraftRefinements = 3;
constexpr double kFewPart = 1e-3;
constexpr std::size_t kFew = 20;

/// Strips that make this part of the elements are worth a word.
constexpr double kMuchForStrips = 0.25;

/// How much of the input's triangulation an attempt may change.
enum class Effort { kFull, kInsertOnly };

std::vector<Vec3> centers_of(const SurfaceMesh& surface, const std::vector<std::uint32_t>& triangles) {
  std::vector<Vec3> centers;
  for (const std::uint32_t t : triangles) {
    const auto [a, b, c] = surface.triangles[t];
    centers.push_back((surface.points[a] + surface.points[b] + surface.points[c]) / 3);
  }
  return centers;
}

/// Whether all triangles of the input have returned, perhaps with other diagonals.
bool is_input_again(const SurfaceMesh& made, const SurfaceMesh& input) {
  const auto ordered = [](std::vector<Vec3> points) {
    std::ranges::sort(points, {}, [](Vec3 p) { return std::array{p.x, p.y, p.z}; });
    return points;
  };
  return made.triangles.size() == input.triangles.size() && ordered(made.points) == ordered(input.points);
}

/// What keeps a surface from being clean and of the input's kind, and where, if that is known.
struct Wrong {
  std::optional<std::string> defect;
  bool crosses = false;
  std::vector<Vec3> places;

  bool is_nothing() const { return !defect && !crosses; }
  bool is_little(std::size_t triangles) const {
    return places.size() <= std::max(kFew, static_cast<std::size_t>(kFewPart * static_cast<double>(triangles)));
  }
};

/// A triangulation, and what is wrong with it.
struct Attempt {
  Outcome made;
  Wrong wrong;
};

/// Rounds with ever smaller sizes where the last one was not good enough.
class Remesher {
 public:
  Remesher(FrontWork& work, FrontKind& kind, const SizeField& sizes)
      : work_(work), kind_(kind), sizes_(sizes, work.stage.context()) {}

  Remeshed run() {
    FrontCounts& counts = work_.counts;
    kind_.foresee(sizes_);
    if (kind_.is_noise()) return kept_as_noise();
    for (counts.rounds = 1; counts.rounds <= kMostRounds && !counts.exceed(kWornOut) && !kind_.is_stuck();
         ++counts.rounds) {
      auto [made, wrong] = attempt(Effort::kFull);
      if (kind_.is_noise()) return kept_as_noise();
      counts.last_triangles = made.result.surface.triangles.size();
      counts.triangles += counts.last_triangles;
      if (is_sound(made, wrong) && is_true(made)) return finished(made);
      if (static_cast<double>(counts.last_triangles) > kMostTriangles * work_.budget.most()) return kept_for_budget();
      kind_.cap_far(made.nearness, sizes_);
    }
    if (kind_.is_stuck()) return kept_in_crossings();
    auto [made, wrong] = attempt(Effort::kInsertOnly);
    if (!is_sound(made, wrong)) return kept_in_crossings();
    work_.stage.note("the surface's own vertices were kept: coarser triangles would cross");
    made.result.source = sources_of(made);
    return finished(made);
  }

 private:
  /// One triangulation by the sizes as they are now.
  Attempt attempt(Effort effort) {
    work_.progress(0);
    Draft draft = with_all_points();
    work_.progress(0.5);
    if (effort == Effort::kFull)
      kind_.adjust(draft, sizes_);
    else
      work_.counts.coarsen.input_vertices_left = work_.surface().points.size();
    work_.progress(0.9);
    Attempt now = judged(draft);
    if (effort == Effort::kFull)
      for (int k = 0; k < kDraftRefinements && refine(now, draft); ++k) now = judged(draft);
    return now;
  }

  Attempt judged(const Draft& draft) {
    validate(draft.mesh);
    Outcome made = outcome_of(draft, work_.surface());
    copy_periodic_faces(work_.surface(), work_.periods, made);
    Wrong wrong = wrong_with(made);
    return {std::move(made), std::move(wrong)};
  }

  bool refine(const Attempt& now, Draft& draft) {
    if (now.wrong.places.empty() || !now.wrong.is_little(now.made.result.surface.triangles.size())) return false;
    return kind_.refine_at(now.wrong.places, draft);
  }

  /// Those of the kind, within the limits.
  StripRules strips() const {
    StripRules rules = kind_.strips();
    rules.gradation = std::max(rules.gradation, work_.limits.rise);
    rules.least = work_.limits.least;
    rules.narrowest = work_.limits.narrowest_strip;
    rules.size_per_width = std::max(rules.size_per_width, work_.limits.per_strip);
    return rules;
  }

  /// The sizes of now, smaller where lines lie near to each other.
  SizeField fine_in_strips() {
    if (work_.options.strips == SurfaceOptions::Strips::kOff) return sizes_.now();
    const auto finer = fitted_to_strips(kind_.input(), sizes_.now(), strips(), work_.stage.context());
    if (!finer) return sizes_.now();
    if (work_.counts.rounds == 1) tell_strips(*finer);
    return *finer;
  }

  void tell_strips(const SizeField& finer) {
    const double without = work_.budget.expected(sizes_.now());
    const double part = 1 - std::min(1.0, without / work_.budget.expected(finer));
    work_.stage.count("made for strips, % of the elements", 100 * part);
    if (part < kMuchForStrips) return;
    work_.stage.note(
        fmt::format("strips between feature edges ask for sizes down to {:.3g} and make about {:.2g} % of "
                    "the elements: `strips` off, or `min_size`, saves them",
                    finer.min_size(), 100 * part));
  }

  /// The input with the points of the front in it.
  Draft with_all_points() {
    const RunContext& context = work_.stage.context();
    FrontCounts& counts = work_.counts;
    InputSurface& input = kind_.input();
    set_features(input, {});  // no walk crosses seams
    set_features(input, features_at_scale(input, kind_.features(), sizes_.now()));
    const SizeField in_strips = fine_in_strips();
    std::vector<std::uint8_t> is_fixed = mark_kept_places(input, work_.known.tree(), sizes_.kept_places());
    SizeField sizes = work_.budget.affordable(kind_.fitted(in_strips, is_fixed), sizes_.first(), counts.rounds);
    std::vector<Curve> curves = kind_.curves(sizes, is_fixed);
    work_.progress(0.05);
    const FrontPoints front = place_points(input, curves, sizes, context);
    counts.start_round(front.points.size(), front.candidates);
    work_.progress(0.4);
    WorkingMesh mesh = insert_points(input, curves, front, context, counts.insertion);
    kind_.settle_input(mesh);
    return {std::move(sizes), std::move(is_fixed), std::move(curves), std::move(mesh), {}, false};
  }

  /// Sizes stay as they are.
  Wrong wrong_with(const Outcome& made) {
    const SurfaceMesh& surface = made.result.surface;
    const auto crossings = made.is_clear ? decltype(find_crossings(surface)){} : find_crossings(surface);
    work_.counts.crossings += crossings.size();
    Wrong wrong{{}, !crossings.empty(), centers_of(surface, triangles_of(crossings))};
    wrong.defect = kind_.first_defect(surface, wrong.crosses, wrong.places);
    return wrong;
  }

  /// Whether the surface is clean and of the input's kind; otherwise the sizes are made smaller.
  bool is_sound(const Outcome& made, const Wrong& wrong) {
    if (wrong.is_nothing()) return true;
    if (!wrong.places.empty()) {
      kind_.answer(wrong.places, made, wrong.crosses, sizes_);
    } else {
      work_.stage.note("an attempt was dropped: " + *wrong.defect);
      sizes_.scale(kCap);
    }
    return false;
  }

  /// Whether the surface is as near to the input as was asked, or could be made so in the rounds allowed; otherwise the
  /// sizes are made smaller. Leaves the sources.
  bool is_true(Outcome& made) {
    made.result.source = sources_of(made);
    const std::size_t far = made.nearness.is_near_enough ? 0 : made.nearness.far.size() + made.nearness.farther.size();
    std::vector<PointSize> turned = turned_too_far(made);
    if ((far == 0 && turned.empty()) || is_last(far, made)) {
      note_what_is_left(far, made.nearness.farthest, turned.size());
      return true;
    }
    ++work_.counts.deviation_rounds;
    sizes_.add(std::move(turned), {});
    return false;
  }

  std::vector<PointSize> turned_too_far(const Outcome& made) {
    const auto& most = work_.options.normal_deviation;
    if (!most) return {};
    return turned_places(*most, made.result.surface, kind_.input(), sizes_.now(), made.vertex_face, made.is_inner,
                         made.result.source);
  }

  bool is_last(std::size_t far, const Outcome& made) const {
    const int round = work_.counts.rounds;
    const ElementBudget& budget = work_.budget;
    return round == kMostRounds || (budget.is_spent() && (round > budget.spent_in_round() || round > 1)) ||
           kind_.leaves_far(far, made);
  }

  std::vector<std::uint32_t> sources_of(const Outcome& made) {
    return source_triangles(kind_.input(), work_.known, made.result.surface, made.vertex_face, made.is_inner);
  }

  /// What the user asked for and does not get.
  void note_what_is_left(std::size_t far, double farthest, std::size_t turned) const {
    const SurfaceOptions& options = work_.options;
    if (work_.limits_deviation()) work_.stage.count("places beyond the deviation", static_cast<double>(far));
    if (options.normal_deviation) work_.stage.count("triangles turned too far", static_cast<double>(turned));
    if (work_.budget.is_spent())
      work_.budget.note(far, farthest, options.max_deviation.value_or(0));
    else if (far > 0)
      work_.stage.note(fmt::format("{} places lie farther than {:.4g} from the input still: a smaller size helps", far,
                                   *options.max_deviation));
    if (turned > 0)
      work_.stage.note(
          fmt::format("{} triangles turn by more than {:.4g} degrees against the input still: it is "
                      "rough there, or turns sharply without a feature edge",
                      turned, *options.normal_deviation));
  }

  Remeshed kept(const SizeField& sizes, std::string why) {
    work_.counts.report(work_.stage);
    work_.stage.note("the surface was kept as it is: " + std::move(why));
    return input_as_it_is(work_.known, sizes);
  }

  Remeshed kept_in_crossings() {
    Remeshed made = kept(sizes_.first(), "every other triangulation tried crosses itself");
    made.stays = kind_.has_needles_kept();
    return made;
  }

  Remeshed kept_for_budget() {
    return kept(sizes_.first(),
                fmt::format("others cross at every size for which the automatic size's budget of {:.2g} million "
                            "elements suffices. Give a `size` to have them anyway",
                            work_.budget.most() / 1e6));
  }

  Remeshed kept_as_noise() {
    return kept(sizes_.now(), fmt::format("no triangles but its own follow such noise within {:.4g}. Clean the input "
                                          "first, or give a larger `max_deviation`",
                                          work_.tolerance));
  }

  Remeshed finished(Outcome& made) {
    kind_.finish(made.result, made.nearness);
    const std::vector<KeptPlace>& kept = sizes_.kept_places();
    work_.counts.kept_places = kept.size();
    made.result.stays = !kept.empty() && is_input_again(made.result.surface, work_.surface());
    if (!kept.empty())
      work_.stage.note(
          fmt::format("the input's own triangles stay in {} places, the first around ({:.6g}, {:.6g}, {:.6g}): "
                      "others cross there at every size",
                      kept.size(), kept[0].center.x, kept[0].center.y, kept[0].center.z));
    work_.counts.report(work_.stage);
    return std::move(made.result);
  }

  FrontWork& work_;
  FrontKind& kind_;
  RoundSizes sizes_;
};

}  // namespace

Remeshed input_as_it_is(const KnownSurface& surface, const SizeField& sizes) {
  Remeshed kept{surface.mesh(), surface.features(), {}, sizes};
  kept.source.resize(kept.surface.triangles.size());
  std::iota(kept.source.begin(), kept.source.end(), 0u);
  return kept;
}

Remeshed remesh_surface(const KnownSurface& surface, const SizeField& sizes, const SurfaceOptions& options,
                        const Stage& stage, std::span<const double> bound, const FrontLimits& limits,
                        const PeriodicCell& cell) {
  if (cell.is_periodic() && surface.mesh().sides.empty()) {
    // The seams of a complex are what holds faces together.
    SurfaceMesh with_sides = surface.mesh();
    with_sides.sides.assign(with_sides.triangles.size(), {kNone, 0});
    const KnownSurface complex(std::move(with_sides), surface.edges(), surface.features());
    Remeshed made = remesh_surface(complex, sizes, options, stage, bound, limits, cell);
    made.surface.sides.clear();
    return made;
  }
  FrontWork work(surface, options, stage, bound, limits, cell);
  const auto kind = surface.mesh().sides.empty() ? make_plain_front(work) : make_seamed_front(work);
  return Remesher(work, *kind, sizes).run();
}

}  // namespace octafront
