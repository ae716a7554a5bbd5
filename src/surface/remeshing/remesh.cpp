#include "surface/remeshing/remesh.h"

#include "core/parallel.h"
#include "core/validate.h"
#include "geometry/measures.h"
#include "mesh/complex.h"
#include "sizing/make_size_field.h"
#include "surface/remeshing/approach.h"
#include "surface/remeshing/coarsen.h"
#include "surface/remeshing/corner_sizes.h"
#include "surface/remeshing/crossings.h"
#include "surface/remeshing/deviation.h"
#include "surface/remeshing/flat_sizes.h"
#include "surface/remeshing/improve.h"
#include "surface/remeshing/insertion.h"
#include "surface/remeshing/keep_volumes.h"
#include "surface/remeshing/mend_folds.h"
#include "surface/remeshing/merge_lines.h"
#include "surface/remeshing/narrow_strips.h"
#include "surface/remeshing/restored.h"
#include "surface/remeshing/seams.h"
#include "surface/remeshing/source_triangles.h"
#include "surface/remeshing/thinned.h"
#include "surface/remeshing/turning.h"
#include "surface/surface_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using namespace remeshing;

/// Rounds of capping the sizes around what crosses. CT isosurfaces of half a million triangles need up to 16.
constexpr int kMostRounds = 24;
/// Sizes around crossing triangles become this part of what they were ...
constexpr double kCap = 0.6;
/// ... but where they have fallen below this part of the first ones, size is not the reason: the input's own triangles
/// return within this many first sizes, and within so many times that where it still crosses.
constexpr double kVain = 0.3, kRestored = 2, kMoreRestored = 1.6;
/// A shell that came out inside out is smaller than its elements: it needs much smaller ones at once.
constexpr double kCapOfShells = 0.29;
/// Where all rounds together have made so many times the triangles of the last one, what crosses gets the input's
/// triangles at once, and later no other round is made: no surface takes more than so many times the work of its last.
constexpr double kPatience = 4, kWornOut = 10;
/// Where all that crosses does so among the input's triangles, so many rounds in a row, no round will end it: points on
/// their edges are rounded, and sheets may lie nearer to each other than that.
constexpr int kMostStuck = 4;
/// Nor is size the reason in a complex where the input's triangles are about as large as those that are wanted: none of
/// their heights is below this part of the size. So it is between the voxels of an image.
constexpr double kAsLarge = 0.5;
/// Where a user's size crosses, triangles of the input are what was asked if they are as large and no longer than so
/// many sizes: smaller sizes take many times the elements between shells that nearly touch.
constexpr double kAsLong = 4;
/// The same where the new surface strays too far from the input, and for how many rounds; more at once where it strays
/// so many times as far as it may.
constexpr double kDeviationCap = 0.7, kMuchTooFar = 2, kDeviationCapFar = 0.5;
constexpr int kMostDeviationRounds = 5;
/// How often points of the input are put in where the new surface strays or nearly does, and where it strays still, if
/// it does so at few places: at this part of its triangles. At more of them it is made anew with smaller sizes.
constexpr int kApproaches = 3, kMostApproaches = 6;
/// Points are put in from this part of the bound on, where the input has vertices or long edges: smaller sizes are the
/// better answer elsewhere.
constexpr double kComeNear = 0.9;
/// From this part of it on nobody shall move the triangles later: sliding vertices stray by a fifth more.
constexpr double kLeftAlone = 0.75;
constexpr double kFewFar = 0.02;
/// At fewer than this part it is mended where it strays or crosses; another round would cost as much as the first. Of a
/// small surface rounds cost little, and make better triangles.
constexpr double kNoRound = 1e-3;
/// In a complex sizes are made smaller by how far it strays: to come to this part of the bound, to no less than this
/// part of themselves at once.
constexpr double kAim = 0.75, kLeastPart = 0.4;
/// A complex that strays at fewer places than this part of its triangles is not made anew for it.
constexpr double kVeryFew = 1e-4;
/// But where it strays at first, with triangles as small as the input's, at more places than this part of their number,
/// the input is noise: what chords of its steps cut off shrinks only as they do, and each new triangulation crosses
/// elsewhere.
constexpr double kNoise = 0.08;
/// So often in a round; there are no more than two for this. (Two in the first and one in the second are half the time,
/// and leave 208 places of a skull too far where three leave 6, and 138 elements below .4 instead of 27.)
constexpr int kRefinements = 3;
/// In a single surface so often, until so many in a row have left no fewer places.
constexpr int kMostRefinements = 5, kMostInVain = 2;
/// And from there they rise faster than elsewhere, as around corners: it is a matter of single ridges and tips.
constexpr double kSteep = 0.4;

/// Triangles below this 2r/R are mended at the end, by moving the surface no farther than this part of the size.
constexpr double kBadShape = 0.25, kMovedPart = 0.25;
/// In a complex once more at the very end, within this part of the bound on deviation.
constexpr double kLittle = 0.3;
/// Mending one crossing may uncover another. Where more triangles than this cross the sizes are too large.
constexpr int kMendingRounds = 4, kFewCrossing = 300;
/// What crosses may move by this part of the size, in a complex on its own patch and farther than the bound on
/// deviation, which leaves no way out between sheets a voxel apart. And there this part of all triangles is few, where
/// it is more.
constexpr double kCrossingPart = 0.5, kFewCrossingPart = 0.005;
/// In a complex points of the input are put in again where that left no more than this part of what crossed.
constexpr double kWorthAnother = 0.7;
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
/// What crosses is not bound by the budget, but no smaller triangles are tried from this part of it on: they would take
/// more elements than it has.
constexpr double kMostTriangles = 0.3;

struct Counts {
  std::uint64_t placed = 0, tried = 0;
  InsertionCounts insertion;
  CoarsenCounts coarsen;
  ImproveCounts improve;
  std::uint64_t divided_edges = 0, merged_lines = 0, places_mended = 0, approached = 0, restored = 0;
  std::uint64_t crossings = 0, triangles = 0;  ///< of all rounds
  int rounds = 0, deviation_rounds = 0;
};

/// How near the new surface lies to the input.
struct Nearness {
  std::vector<Vec3> approached;    ///< where points of the input were put in
  std::vector<Vec3> far, farther;  ///< where it strays still: too far, and much too far
  double farthest = 0;
  bool is_near_enough = false;          ///< though there are such places
  std::vector<PointSize> wanted;        ///< sizes by which it would stray less there
  std::vector<VertexIndex> near_limit;  ///< corners of triangles that nearly do, in the working mesh
};

/// The parts of the working mesh that are alive, numbered anew in their order.
struct Compacted {
  Remeshed result;
  std::vector<std::uint32_t> vertex_face;  ///< per vertex: an input face that it lies in
  std::vector<std::uint8_t> is_inner;      ///< per vertex: not on a feature
  bool is_clear = false;                   ///< it is known that nothing crosses
  Nearness nearness;
};
using Crossings = std::vector<std::array<std::uint32_t, 2>>;

/// The regions on the sides of each patch of a complex.
std::vector<Sides> sides_of_patches(const SurfaceMesh& complex) {
  std::vector<Sides> sides;
  for (std::size_t t = 0; t < complex.sides.size(); ++t) {
    if (complex.patch[t] >= sides.size()) sides.resize(complex.patch[t] + 1);
    sides[complex.patch[t]] = complex.sides[t];
  }
  return sides;
}

/// Which vertices of the working mesh its result has: all that live, but for those of backs and of copies.
std::vector<std::uint8_t> vertices_to_keep(const WorkingMesh& mesh, const std::vector<VertexIndex>& sewn) {
  std::vector<std::uint8_t> keep(mesh.points.size(), 0);
  for (const std::uint32_t t : front_triangles(mesh))
    for (const VertexIndex v : mesh.triangle(t)) keep[sewn[v]] = 1;
  return keep;
}

Compacted compacted(const WorkingMesh& mesh, const SurfaceMesh& input, const SizeField& sizes, Nearness nearness) {
  Compacted c{{{}, {}, {}, sizes}, {}, {}, false, std::move(nearness)};
  SurfaceMesh& s = c.result.surface;
  const std::vector<VertexIndex> sewn = sewn_vertices(mesh);
  const std::vector<std::uint8_t> keep = vertices_to_keep(mesh, sewn);
  const std::vector<Sides> sides = sides_of_patches(input);
  std::vector<VertexIndex> old_to_new(mesh.points.size(), kNone);
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (!keep[v]) continue;
    old_to_new[v] = static_cast<VertexIndex>(s.points.size());
    s.points.push_back(mesh.points[v]);
    c.vertex_face.push_back(mesh.face[v]);
    c.is_inner.push_back(mesh.is_free(v));
    if (mesh.kind[v] == VertexKind::kCorner) c.result.features.corners.push_back(old_to_new[v]);
  }
  s.patch_names = input.patch_names;
  s.region_names = input.region_names;
  s.region_labels = input.region_labels;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.is_removed(t) || mesh.is_back(t)) continue;
    Triangle triangle;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const HalfEdge h = 3 * t + i;
      triangle[i] = old_to_new[sewn[mesh.start[h]]];
      if (mesh.is_feature[h] && (h < mesh.twin[h] || mesh.is_seam(h))) {
        const VertexIndex a = triangle[i], b = old_to_new[sewn[mesh.end(h)]];
        c.result.features.edges.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    s.triangles.push_back(triangle);
    if (!input.patch.empty()) s.patch.push_back(mesh.patch[t]);
    if (!sides.empty()) s.sides.push_back(sides[mesh.patch[t]]);
  }
  std::vector<Edge>& edges = c.result.features.edges;
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());  // a seam has one in each of its parts
  for (const VertexIndex v : c.nearness.near_limit)
    if (mesh.outgoing[v] != kNone) c.result.near_limit.push_back(old_to_new[sewn[v]]);
  return c;
}

SurfaceMesh triangles_of(const WorkingMesh& mesh, const std::vector<std::uint32_t>& number) {
  SurfaceMesh alive;
  alive.points = mesh.points;
  const std::vector<VertexIndex> sewn = sewn_vertices(mesh);
  for (const std::uint32_t t : number) {
    const auto [a, b, c] = mesh.triangle(t);
    alive.triangles.push_back({sewn[a], sewn[b], sewn[c]});
  }
  return alive;
}

/// Per triangle of the working mesh whether it crosses another, or has no area.
std::vector<std::uint8_t> crossing_triangles(const WorkingMesh& mesh) {
  const std::vector<std::uint32_t> number = front_triangles(mesh);
  const SurfaceMesh alive = triangles_of(mesh, number);
  std::vector<std::uint8_t> crossing(mesh.triangle_count(), 0);
  for (const auto& [s, t] : find_crossings(alive)) crossing[number[s]] = crossing[number[t]] = 1;
  return crossing;
}

double longest_edge_of(const TriangleCorners& t) {
  return std::max({distance(t[0], t[1]), distance(t[1], t[2]), distance(t[2], t[0])});
}

/// How much of the input's triangulation an attempt may change.
enum class Effort { kFull, kInsertOnly };

/// Where the places are that lie farther than the limit, but not as far as `end`.
std::vector<Vec3> positions_beyond(double limit, const std::vector<FarPlace>& places, double end = HUGE_VAL) {
  std::vector<Vec3> positions;
  for (const FarPlace& place : places)
    if (place.distance >= limit && place.distance < end) positions.push_back(place.at);
  return positions;
}

double farthest_of(const std::vector<FarPlace>& places) {
  double farthest = 0;
  for (const FarPlace& place : places) farthest = std::max(farthest, place.distance);
  return farthest;
}

std::vector<Vec3> centers_of(const SurfaceMesh& surface, const std::vector<std::array<std::uint32_t, 2>>& pairs) {
  std::vector<std::uint32_t> triangles;
  for (const auto& [s, t] : pairs) triangles.insert(triangles.end(), {s, t});
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  std::vector<Vec3> centers;
  for (const std::uint32_t t : triangles) {
    const auto [a, b, c] = surface.triangles[t];
    centers.push_back((surface.points[a] + surface.points[b] + surface.points[c]) / 3);
  }
  return centers;
}

/// Sizes made smaller at places.
struct Caps {
  std::vector<PointSize> places;
  CapShape shape;
};

void report_counts(const Counts& counts, const Stage& stage) {
  stage.count("points placed", static_cast<double>(counts.placed));
  stage.count("places tried", static_cast<double>(counts.tried));
  stage.count("points inserted", static_cast<double>(counts.insertion.inserted));
  stage.count("points skipped", static_cast<double>(counts.insertion.skipped));
  stage.count("collapses", static_cast<double>(counts.coarsen.collapses));
  stage.count("flips", static_cast<double>(counts.coarsen.flips + counts.improve.flips));
  stage.count("smoothing moves", static_cast<double>(counts.improve.moves));
  if (counts.divided_edges > 0) stage.count("edges divided between seams", static_cast<double>(counts.divided_edges));
  stage.count("lines merged", static_cast<double>(counts.merged_lines));
  stage.count("places mended", static_cast<double>(counts.places_mended));
  stage.count("points against deviation", static_cast<double>(counts.approached));
  stage.count("input vertices left", static_cast<double>(counts.coarsen.input_vertices_left));
  stage.count("crossing pairs mended", static_cast<double>(counts.crossings));
  stage.count("places left as in the input", static_cast<double>(counts.restored));
  stage.count("rounds", counts.rounds);
  stage.count("triangles of all rounds", static_cast<double>(counts.triangles));
  stage.count("rounds for deviation", counts.deviation_rounds);
}

/// Attempts with ever smaller sizes where the last one was not good enough.
class Remesher {
 public:
  Remesher(const KnownSurface& surface, const SizeField& sizes, const SurfaceOptions& options, const Stage& stage,
           std::span<const double> bound, const FrontLimits& limits)
      : known_(surface),
        surface_(surface.mesh()),
        bound_(bound),
        first_(sizes),
        sizes_(sizes),
        options_(options),
        tolerance_(options.max_deviation.value_or(HUGE_VAL)),
        leeway_(surface.mesh(), surface.tree(), bound),
        limits_(limits),
        stage_(stage),
        seamed_(!surface_.sides.empty() ? std::optional(cut_along_seams(surface)) : std::nullopt),
        input_(seamed_ ? std::move(seamed_->input) : make_input_surface(surface.mesh(), surface.edges())) {
    if (!seamed_) kind_.emplace(surface_, surface.edges());
  }

  Remeshed run() {
    if (seamed_ && limits_deviation()) foresee_deviation();
    for (counts_.rounds = 1; counts_.rounds <= kMostRounds && !is_worn_out(kWornOut) && stuck_ < kMostStuck;
         ++counts_.rounds) {
      Compacted c = attempt(Effort::kFull);
      if (is_noise_) return kept_as_noise();
      last_triangles_ = c.result.surface.triangles.size();
      counts_.triangles += last_triangles_;
      if (is_sound(c) && is_true(c)) return finished(c);
      if (static_cast<double>(last_triangles_) > kMostTriangles * limits_.budget) return kept_for_budget();
      cap_far(c);
    }
    if (stuck_ == kMostStuck) return kept_in_crossings();
    Compacted c = attempt(Effort::kInsertOnly);
    if (is_sound(c)) {
      stage_.note("the surface's own vertices were kept: coarser triangles would cross");
      c.result.source = sources_of(c);
      return finished(c);
    }
    return kept_in_crossings();
  }

 private:
  /// What most triangles of a complex would be made smaller for in further rounds.
  void foresee_deviation() {
    set_features(input_, {});
    set_features(input_, features_at_scale(input_, features(), sizes_));
    std::vector<std::uint8_t> is_fixed(input_.mesh.points.size(), 0);
    const std::vector<Curve> curves = chained_curves(input_, *seamed_, sizes_, is_fixed).curves;
    SizeField foreseen = followed_within(tolerance_, curves);
    if (std::isfinite(limits_.budget)) stray_within_budget(curves, foreseen);
    first_ = sizes_ = affordable(foreseen);
  }

  SizeField followed_within(double tolerance, const std::vector<Curve>& curves) const {
    const std::vector<PointSize> wanted = sizes_by_flatness(input_, curves, sizes_, tolerance, stage_.context());
    return capped_at(sizes_, wanted, stage_.context(), {.gradation = kSteep});
  }

  /// The surface of a complex may stray farther if following it would take more elements than the budget has.
  void stray_within_budget(const std::vector<Curve>& curves, SizeField& foreseen) {
    if (!expected_) expected_.emplace(surface_);
    const double asked = tolerance_, first = (*expected_)(foreseen);
    double count = first, slope = kFirstSlope;
    for (int step = 0; step < kMostRaises && count > kNearBudget * limits_.budget; ++step) {
      const double raise = std::clamp(std::pow(count / limits_.budget, 1 / slope), kLeastRaise, kMostRaise);
      foreseen = followed_within(tolerance_ *= raise, curves);
      const double now = (*expected_)(foreseen);
      slope = std::clamp(std::log(count / now) / std::log(raise), kFlattest, kSteepest);
      count = now;
    }
    if (tolerance_ == asked) return;
    stage_.note(
        fmt::format("within {:.3g} of the input there would be about {:.2g} million elements; the automatic size has a "
                    "budget of {:.2g} million, so the surface may stray by {:.3g}. For more ask for it, e.g. with "
                    "`max_deviation`, `size` or `elements`",
                    asked, first / 1e6, limits_.budget / 1e6, tolerance_));
  }

  /// Whether all rounds together have made more than so many times the triangles of the last one.
  bool is_worn_out(double times) const {
    return static_cast<double>(counts_.triangles) > times * static_cast<double>(last_triangles_);
  }

  Remeshed kept_in_crossings() {
    report_counts(counts_, stage_);
    stage_.note("the surface was kept as it is: every other triangulation tried crosses itself");
    return input_as_it_is(known_, first_);
  }

  Remeshed kept_for_budget() {
    report_counts(counts_, stage_);
    stage_.note(
        fmt::format("the surface was kept as it is: others cross at every size for which the automatic size's "
                    "budget of {:.2g} million elements suffices. Give a `size` to have them anyway",
                    limits_.budget / 1e6));
    return input_as_it_is(known_, first_);
  }

  /// The sizes as far as the budget goes.
  SizeField affordable(const SizeField& finer) {
    if (!std::isfinite(limits_.budget)) return finer;
    if (!expected_) expected_.emplace(surface_);
    const WithinCount met = within_count(finer, first_, *expected_, limits_.budget, stage_.context());
    if (met.floor == 0) return finer;
    if (spent_.floor == 0) spent_.round = counts_.rounds;
    spent_.asked = std::max(spent_.asked, met.asked);
    spent_.floor = met.floor;
    return met.sizes;
  }

  /// One triangulation by the sizes as they are now.
  Compacted attempt(Effort effort) {
    const RunContext& context = stage_.context();
    progress(0);
    set_features(input_, {});  // no walk crosses seams
    set_features(input_, features_at_scale(input_, features(), sizes_));
    const SizeField in_strips = fitted_to_strips(input_, sizes_, seamed_ ? kStripsOfWalls : kStrips, stage_.context());
    std::vector<std::uint8_t> is_fixed = mark_restored(input_, known_.tree(), restored_);
    SizeField sizes = fitted_sizes(in_strips, is_fixed);
    const std::vector<Curve> curves = curves_of(sizes, is_fixed);
    progress(0.05);
    const FrontPoints front = place_points(input_, curves, sizes, context);
    counts_.placed = front.points.size();
    counts_.tried = front.candidates;
    counts_.insertion = {};
    counts_.coarsen = {};
    counts_.improve = {};
    counts_.places_mended = 0;
    counts_.approached = 0;
    progress(0.4);
    WorkingMesh mesh = insert_points(input_, curves, front, context, counts_.insertion);
    if (seamed_) pin_corners(mesh);
    progress(0.5);
    bool clear = false;
    Nearness nearness;
    if (effort == Effort::kFull && seamed_) {
      change_between_seams(mesh, curves, sizes);
      DeviationWatch watch = deviation_watch();
      refine_far(mesh, watch, curves, sizes, nearness);
      if (!is_noise_) {
        mend_crossings(mesh, is_fixed);
        mend_places(mesh, lines_fixed(mesh), tolerance_);
        approach_far(mesh, watch, sizes, is_fixed, nearness);
        clear = mend_places(mesh, lines_fixed(mesh), kLittle * tolerance_) || mend_last_crossings(mesh, is_fixed);
      }
    } else if (effort == Effort::kFull) {
      remove_input_vertices(mesh, sizes, context, counts_.coarsen);
      progress(0.6);
      counts_.merged_lines = merge_lines(mesh, is_fixed, tolerance_, leeway_);
      improve_surface(mesh, input_, curves, sizes, context, counts_.improve);
      counts_.merged_lines += merge_lines(mesh, is_fixed, tolerance_, leeway_);
      clear = mend_places(mesh, is_fixed, tolerance_);
      nearness = come_near(mesh, curves, sizes, is_fixed, clear);
    } else {
      counts_.coarsen.input_vertices_left = surface_.points.size();
    }
    progress(0.9);
    validate(mesh);
    Compacted c = compacted(mesh, surface_, sizes, std::move(nearness));
    c.is_clear = clear;
    return c;
  }

  const Features& features() const { return seamed_ ? seamed_->features : known_.features(); }

  /// `in_strips`, smaller where corners of seams are nearer together, as far as the budget goes.
  SizeField fitted_sizes(const SizeField& in_strips, const std::vector<std::uint8_t>& is_fixed) {
    return affordable(seamed_ ? fitted_to_corners(input_, *seamed_, is_fixed, in_strips, stage_.context()) : in_strips);
  }

  /// Divided; of a complex, `is_fixed` gets the corners that its parts share.
  std::vector<Curve> curves_of(const SizeField& sizes, std::vector<std::uint8_t>& is_fixed) {
    if (seamed_) return divided_curves(input_, *seamed_, sizes, is_fixed);
    std::vector<Curve> curves = chain_curves(input_, known_.features().corners, is_fixed, sizes);
    divide_curves(input_, sizes, curves);
    return curves;
  }

  void pin_corners(WorkingMesh& mesh) const {
    mesh.pinned = seamed_->pinned;
    for (VertexIndex v = 0; v < mesh.pinned.size(); ++v)
      if (mesh.pinned[v] || v >= seamed_->first_tip) mesh.kind[v] = VertexKind::kCorner;
  }

  /// Of a complex, what remove_input_vertices() and improve_surface() do of a single surface: seams first, which are
  /// the same for all that ends there, and once more when their surroundings are coarse.
  void change_between_seams(WorkingMesh& mesh, const std::vector<Curve>& curves, const SizeField& sizes) {
    const RunContext& context = stage_.context();
    coarsen_seams(mesh, context, counts_.coarsen);
    remove_input_vertices(mesh, sizes, context, counts_.coarsen);
    coarsen_seams(mesh, context, counts_.coarsen);
    settle_seams(mesh, sizes);
    progress(0.6);
    counts_.divided_edges = divide_repeated_edges(mesh, known_, sizes);
    improve_surface(mesh, input_, curves, sizes, context, counts_.improve);
    counts_.divided_edges += divide_repeated_edges(mesh, known_, sizes);
    counts_.divided_edges += divide_repeated_triangles(mesh, known_, sizes);
  }

  /// Of a complex, smaller sizes and more triangles where it strays, while that helps.
  void refine_far(WorkingMesh& mesh, DeviationWatch& watch, const std::vector<Curve>& curves, SizeField& sizes,
                  Nearness& n) {
    for (int k = 0; k < kRefinements; ++k) {
      const std::vector<FarPlace> places = far_places(mesh, watch);
      if (k == 0 && counts_.rounds == 1) is_noise_ = is_noise(places, sizes, front_triangles(mesh).size());
      if (is_noise_) return;
      const std::vector<PointSize> wanted = sizes_against(places, sizes);
      if (wanted.empty()) return;
      n.wanted.insert(n.wanted.end(), wanted.begin(), wanted.end());
      sizes = affordable(capped_at(sizes, wanted, stage_.context(), {.gradation = kSteep}));
      refine(mesh, curves, sizes);
      if (spent_.floor > 0) return;
    }
  }

  bool is_noise(const std::vector<FarPlace>& places, const SizeField& sizes, std::size_t triangles) const {
    const auto in_vain = std::count_if(places.begin(), places.end(), [&](const FarPlace& p) {
      return p.distance >= tolerance_ && sizes.at(p.at) <= longest_edge_of(known_.tree().corners(p.on_input.face));
    });
    return static_cast<double>(in_vain) > kNoise * static_cast<double>(triangles);
  }

  /// Points of the complex where the mesh strays still. What is left then lies beside seams: another round has to
  /// divide these.
  void approach_far(WorkingMesh& mesh, DeviationWatch& watch, const SizeField& sizes,
                    const std::vector<std::uint8_t>& is_fixed, Nearness& n) {
    std::vector<FarPlace> places = far_places(mesh, watch);
    for (int k = 0; k < kApproaches; ++k) {
      std::erase_if(places, [&](const FarPlace& p) { return p.distance < kComeNear * tolerance_; });
      const std::uint64_t put_in = places.empty() ? 0 : approach(mesh, input_, known_.tree(), is_fixed, places);
      if (put_in == 0) break;
      counts_.approached += put_in;
      places = far_places(mesh, watch);
    }
    n.far = positions_beyond(tolerance_, places);
    n.farthest = farthest_of(places);
    const std::vector<PointSize> wanted = sizes_against(places, sizes);
    n.wanted.insert(n.wanted.end(), wanted.begin(), wanted.end());
  }

  /// Puts points of the complex into triangles that cross others: chords between near sheets.
  void mend_crossings(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed, double least_shape = kFairShape) {
    for (double before = HUGE_VAL;;) {
      const std::vector<std::uint32_t> number = front_triangles(mesh);
      const SurfaceMesh alive = triangles_of(mesh, number);
      std::vector<std::uint32_t> crossing;
      for (const auto& pair : find_crossings(alive)) crossing.insert(crossing.end(), pair.begin(), pair.end());
      std::sort(crossing.begin(), crossing.end());
      crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
      if (crossing.empty()) return;
      const auto now = static_cast<double>(crossing.size());
      if (now > kFewFar * static_cast<double>(number.size()) || now > kWorthAnother * before) return;
      before = now;
      std::vector<FarPlace> places = places_under(crossing, alive, known_.tree());
      for (FarPlace& place : places) place.triangle = number[place.triangle];
      // A point in the plane of its triangle changes nothing, and leaves a flat element.
      std::erase_if(places, [&](const FarPlace& p) {
        return p.distance < kInPlane * std::sqrt(length(mesh.area_vector(p.triangle)));
      });
      const std::uint64_t put_in = approach(mesh, input_, known_.tree(), is_fixed, places, least_shape);
      counts_.approached += put_in;
      if (put_in == 0) return;
    }
  }

  /// Whatever the shapes, where a few cross still: another round costs more. True if it is known that nothing crosses.
  bool mend_last_crossings(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed) {
    for (int k = 0; k < kLastMendings; ++k) {
      mend_crossings(mesh, is_fixed, kAnyShape);
      if (mend_places(mesh, lines_fixed(mesh), kLittle * tolerance_)) return true;
    }
    return false;
  }

  /// Of a complex, per vertex whether it is on a seam or another line.
  static std::vector<std::uint8_t> lines_fixed(const WorkingMesh& mesh) {
    std::vector<std::uint8_t> is_fixed(mesh.points.size());
    for (VertexIndex v = 0; v < is_fixed.size(); ++v) is_fixed[v] = mesh.on_curve(v);
    return is_fixed;
  }

  /// Divides what is longer than the sizes ask for, and makes good triangles of it.
  void refine(WorkingMesh& mesh, const std::vector<Curve>& curves, const SizeField& sizes) {
    parallel_for(mesh.points.size(), [&](std::size_t v) {
      if (mesh.outgoing[v] != kNone) mesh.size[v] = sizes.at(mesh.points[v]);
    });
    improve_surface(mesh, input_, curves, sizes, stage_.context(), counts_.improve);
    if (!seamed_) return;
    counts_.divided_edges += divide_repeated_edges(mesh, known_, sizes);
    counts_.divided_edges += divide_repeated_triangles(mesh, known_, sizes);
  }

  /// What strays or crosses at few places is mended where it is: by points of the input, and smaller triangles where
  /// these do not help. `clear`: whether it is known that nothing crosses, before and after.
  Nearness come_near(WorkingMesh& mesh, const std::vector<Curve>& curves, SizeField& sizes,
                     const std::vector<std::uint8_t>& is_fixed, bool& clear) {
    Nearness n;
    DeviationWatch watch = deviation_watch();
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (int k = 0, in_vain = 0;; ++k) {
      std::vector<FarPlace> places = far_places(mesh, watch);
      if (put_in_points(mesh, watch, is_fixed, places, n)) {
        clear = mend_places(mesh, is_fixed, tolerance_, clear);
        places = far_places(mesh, watch);
      }
      n.far = positions_beyond(tolerance_, places, kMuchTooFar * tolerance_);
      n.farther = positions_beyond(kMuchTooFar * tolerance_, places);
      n.farthest = farthest_of(places);
      n.near_limit = corners_at(mesh, places);
      n.is_near_enough = is_near_enough(mesh, places);
      if (k == kMostRefinements || (clear && n.is_near_enough)) return n;
      std::vector<PointSize> wanted = sizes_where_few(mesh, places, sizes, clear);
      in_vain = wanted.size() < least ? 0 : in_vain + 1;
      if (wanted.empty() || in_vain == kMostInVain) return n;
      least = std::min(least, wanted.size());
      n.wanted.insert(n.wanted.end(), wanted.begin(), wanted.end());
      for (const Vec3 p : std::exchange(n.approached, {})) wanted.push_back({p, kDeviationCap * sizes.at(p)});
      sizes = capped_at(sizes, smallest_ones(std::move(wanted)), stage_.context(), shape_against_deviation());
      refine(mesh, curves, sizes);
      clear = mend_places(mesh, is_fixed, tolerance_);
    }
  }

  /// Points of the input at the places, and where it strays then, while that leaves fewer; false if none was put in.
  bool put_in_points(WorkingMesh& mesh, DeviationWatch& watch, const std::vector<std::uint8_t>& is_fixed,
                     std::vector<FarPlace> places, Nearness& n) {
    const auto strays = [&] {
      return std::ranges::count_if(places, [&](const FarPlace& p) { return p.distance > tolerance_; });
    };
    bool any = false;
    for (int k = 0; k < kMostApproaches; ++k) {
      const auto before = strays();
      std::erase_if(places, [&](const FarPlace& p) { return p.within || p.distance < kComeNear * tolerance_; });
      if (places.empty() || !are_few(count_triangles(places), mesh, kFewFar)) return any;
      const std::uint64_t put_in = approach(mesh, input_, known_.tree(), is_fixed, places);
      if (put_in == 0) return any;
      any = true;
      counts_.approached += put_in;
      const std::vector<Vec3> there = positions_beyond(0, places);
      n.approached.insert(n.approached.end(), there.begin(), there.end());
      places = far_places(mesh, watch);
      if (before > 0 ? strays() >= before : k + 1 == kApproaches) return any;
    }
    return any;
  }

  /// Whether it strays nowhere, or a little at few places.
  bool is_near_enough(const WorkingMesh& mesh, std::vector<FarPlace> places) const {
    std::erase_if(places, [&](const FarPlace& p) { return p.distance < tolerance_; });
    const double most = limits_.slack * tolerance_;
    return places.empty() || (are_few(count_triangles(places), mesh, kNoRound) &&
                              std::ranges::all_of(places, [&](const FarPlace& p) { return p.distance <= most; }));
  }

  static bool are_few(std::ptrdiff_t triangles, const WorkingMesh& mesh, double part) {
    return static_cast<double>(triangles) < part * static_cast<double>(mesh.triangle_count());
  }

  /// Sizes by which it would stray no more, and smaller ones where it crosses; none if that is at many places.
  std::vector<PointSize> sizes_where_few(const WorkingMesh& mesh, std::vector<FarPlace> places, const SizeField& sizes,
                                         bool clear) const {
    std::erase_if(places, [&](const FarPlace& p) { return p.distance < tolerance_; });
    if (!are_few(count_triangles(places), mesh, kNoRound)) return {};
    std::vector<PointSize> wanted = sizes_against(places, sizes);
    if (clear) return wanted;
    const std::vector<std::uint8_t> crossing = crossing_triangles(mesh);
    if (!are_few(std::count(crossing.begin(), crossing.end(), 1), mesh, kNoRound)) return {};
    for (std::uint32_t t = 0; t < crossing.size(); ++t) {
      if (!crossing[t]) continue;
      const auto [a, b, c] = mesh.triangle(t);
      const Vec3 middle = centroid(mesh.points[a], mesh.points[b], mesh.points[c]);
      if (const double size = sizes.at(middle); size >= kVain * first_.at(middle))
        wanted.push_back({middle, kCap * size});
    }
    return smallest_ones(std::move(wanted));
  }

  /// Sizes by which the mesh would stray no more: what chords cut off grows with the square of their length. Of places
  /// near to each other that of the smallest size.
  std::vector<PointSize> sizes_against(const std::vector<FarPlace>& places, const SizeField& sizes) const {
    std::vector<PointSize> wanted;
    for (const FarPlace& place : places) {
      if (place.distance < tolerance_) continue;
      const double part = std::sqrt(kAim * tolerance_ / place.distance);
      wanted.push_back({place.at, sizes.at(place.at) * std::max(part, kLeastPart)});
    }
    return smallest_ones(std::move(wanted));
  }

  /// A steep field lets all sizes rise steeply from then on, which makes far fewer elements: for complexes only.
  CapShape shape_against_deviation() const { return {.gradation = seamed_ ? kSteep : 0}; }

  /// Smaller sizes where the surface strayed.
  void cap_far(const Compacted& c) {
    add({c.nearness.wanted, shape_against_deviation()});
    if (seamed_) return;
    std::vector<Vec3> places = c.nearness.far;
    if (!places.empty()) cap(places, kDeviationCap);
    if (!c.nearness.farther.empty()) cap(c.nearness.farther, kDeviationCapFar);
  }

  static std::ptrdiff_t count_triangles(const std::vector<FarPlace>& places) {
    std::vector<std::uint32_t> triangles;
    for (const FarPlace& place : places) triangles.push_back(place.triangle);
    std::sort(triangles.begin(), triangles.end());
    return std::unique(triangles.begin(), triangles.end()) - triangles.begin();
  }

  static std::vector<VertexIndex> corners_at(const WorkingMesh& mesh, const std::vector<FarPlace>& places) {
    std::vector<VertexIndex> corners;
    for (const FarPlace& place : places)
      for (const VertexIndex v : mesh.triangle(place.triangle)) corners.push_back(v);
    return corners;
  }

  /// Where the mesh is too far from the input, or nearly so, by the numbers of its triangles.
  std::vector<FarPlace> far_places(const WorkingMesh& mesh, DeviationWatch& watch) const {
    if (!limits_deviation()) return {};
    const std::vector<std::uint32_t> number = front_triangles(mesh);
    return watch.look(triangles_of(mesh, number), number);
  }

  DeviationWatch deviation_watch() const {
    const Fine fine = seamed_ ? Fine::kCorners : Fine::kParts;
    return {kLeftAlone * tolerance_, tolerance_, surface_, known_.tree(), fine, bound_};
  }

  /// What is left of bad triangles, of edges too sharp for any element, and of crossings where these are few. True if
  /// it is known that nothing crosses then. `clear`: whether it is known before.
  bool mend_places(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed, double tolerance, bool clear = false) {
    FoldLimits limits{.tolerance = tolerance,
                      .size_part = kMovedPart,
                      .least_shape = kBadShape,
                      .crossing_part = kCrossingPart,
                      .crossing_most = seamed_ ? HUGE_VAL : tolerance,
                      .leeway = &leeway_,
                      .keep_lines = true,
                      .onto = &known_.tree(),
                      .is_fixed = is_fixed,
                      .patch_of = seamed_ ? &input_.patch : nullptr};
    const auto part = static_cast<std::int64_t>(kFewCrossingPart * static_cast<double>(mesh.triangle_count()));
    const std::int64_t few = seamed_ ? std::max<std::int64_t>(kFewCrossing, part) : kFewCrossing;
    for (int round = 0; round < kMendingRounds; ++round) {
      const std::vector<std::uint8_t> crossing =
          clear ? std::vector<std::uint8_t>(mesh.triangle_count()) : crossing_triangles(mesh);
      const auto count = std::count(crossing.begin(), crossing.end(), 1);
      if (round > 0 && count == 0) return true;
      limits.crossing = count <= few ? &crossing : nullptr;
      const std::uint64_t done = mend_folds(mesh, limits, stage_.context()).operations;
      counts_.places_mended += done;
      if (count == 0) return true;  // mending makes no crossings
      if (done == 0 || count > few) return false;
    }
    return false;
  }

  /// Nobody knows how many rounds there will be: each takes half of what is left.
  void progress(double part_of_round) const {
    stage_.progress(1 - std::ldexp(1 - part_of_round / 2, 1 - counts_.rounds));
  }

  std::vector<std::uint32_t> sources_of(const Compacted& c) const {
    return source_triangles(input_, known_, c.result.surface, c.vertex_face, c.is_inner);
  }

  /// Whether the surface is clean and of the input's kind; otherwise the sizes are made smaller.
  bool is_sound(const Compacted& c) {
    const auto crossings = c.is_clear ? Crossings{} : find_crossings(c.result.surface);
    counts_.crossings += crossings.size();
    std::vector<Vec3> places = centers_of(c.result.surface, crossings);
    std::optional<std::string> defect;
    // In a complex what does not agree shows beside what crosses; both are left to the same round.
    if (seamed_)
      defect = first_complex_defect_but_crossings(c.result.surface, stage_.context(), &places);
    else if (crossings.empty())
      defect = kind_->first_defect_but_crossings(c.result.surface, stage_.context(), &places);
    if (!defect && crossings.empty()) return true;
    if (!places.empty()) {
      cap_or_restore(places, seamed_ ? c.result.sizes : sizes_, crossings.empty() && !seamed_ ? kCapOfShells : kCap);
    } else {
      stage_.note("an attempt was dropped: " + *defect);
      sizes_ = scaled(sizes_, kCap, stage_.context());
    }
    return false;
  }

  void cap(const std::vector<Vec3>& places, double factor) {
    Caps caps{{}, {.reach = CapShape{}.reach / factor}};
    for (const Vec3 p : thinned(sizes_, places)) caps.places.push_back({p, factor * sizes_.at(p)});
    add(std::move(caps));
  }

  void add(Caps caps) {
    sizes_ = capped_at(sizes_, caps.places, stage_.context(), caps.shape);
    caps_.push_back(std::move(caps));
  }

  /// Smaller sizes around what crosses; where that was in vain, the input's own triangles, and the first sizes again.
  /// `made_by`: of a complex the sizes that were fitted to its seams.
  void cap_or_restore(const std::vector<Vec3>& places, const SizeField& made_by, double factor) {
    std::vector<Vec3> to_cap;
    const std::size_t before = restored_.size();
    std::vector<std::uint8_t> has_grown(before, 0);
    bool in_vain = false, all_restored = true;
    for (const Vec3 p : places) {
      const auto around = restored_around(p, 1);
      all_restored &= around != restored_.end();
      if (around != restored_.end()) {
        const auto i = static_cast<std::size_t>(around - restored_.begin());
        // Of a complex once for each place: its balls are as small as voxels.
        if (i < before && (seamed_ || !has_grown[i])) around->radius *= kMoreRestored, has_grown[i] = 1;
        in_vain |= around->in_vain;
      } else if (seamed_ && (made_by.at(p) < kVain * first_.at(p) || is_as_large(p, made_by))) {
        restored_.push_back({p, kRestored * made_by.at(p), false});
      } else if (sizes_.at(p) < kVain * first_.at(p) || is_as_asked(p) || is_worn_out(kPatience) ||
                 restored_around(p, kMoreRestored) != restored_.end()) {
        restored_.push_back({p, kRestored * first_.at(p)});
        in_vain = true;
      } else {
        to_cap.push_back(p);
      }
    }
    stuck_ = all_restored && !seamed_ ? stuck_ + 1 : 0;
    if (in_vain) forget_caps();
    if (!to_cap.empty()) cap(to_cap, factor);
  }

  /// Of a single surface and a size that a user gave, whether the input's triangle at p is about as large as asked.
  bool is_as_asked(Vec3 p) const {
    if (seamed_ || std::isfinite(limits_.budget) || !is_as_large(p, first_)) return false;
    return longest_edge_of(input_triangle_at(p)) <= kAsLong * first_.at(p);
  }

  const TriangleCorners& input_triangle_at(Vec3 p) const {
    return known_.tree().corners(known_.tree().nearest(p).triangle);
  }

  /// Whether the input's triangle at p is as large as those that are wanted there.
  bool is_as_large(Vec3 p, const SizeField& sizes) const {
    const TriangleCorners& t = input_triangle_at(p);
    return length(double_area_normal(t[0], t[1], t[2])) >= kAsLarge * sizes.at(p) * longest_edge_of(t);
  }

  /// The first place where the input's triangles return that has p within so many radii.
  std::vector<Ball>::iterator restored_around(Vec3 p, double radii) {
    return std::find_if(restored_.begin(), restored_.end(),
                        [&](const Ball& b) { return distance(b.center, p) < radii * b.radius; });
  }

  /// The sizes again without what was asked of them where the input's triangles have returned.
  void forget_caps() {
    sizes_ = first_;
    for (Caps& caps : caps_) {
      std::erase_if(caps.places, [&](const PointSize& s) {
        return std::any_of(restored_.begin(), restored_.end(),
                           [&](const Ball& b) { return b.in_vain && distance(b.center, s.p) < b.radius; });
      });
      sizes_ = capped_at(sizes_, caps.places, stage_.context(), caps.shape);
    }
  }

  /// Whether the surface is as near to the input as was asked, or could be made so in the rounds allowed; otherwise the
  /// sizes are made smaller. Leaves the sources.
  bool is_true(Compacted& c) {
    const std::size_t far = c.nearness.is_near_enough ? 0 : c.nearness.far.size() + c.nearness.farther.size();
    const bool is_last =
        counts_.rounds == kMostRounds || (spent_.floor > 0 && (counts_.rounds > spent_.round || counts_.rounds > 1)) ||
        (seamed_ ? counts_.rounds > 1 ||
                       static_cast<double>(far) < kVeryFew * static_cast<double>(c.result.surface.triangles.size())
                 : counts_.deviation_rounds == kMostDeviationRounds || is_worn_out(kPatience));
    c.result.source = sources_of(c);
    std::vector<PointSize> turned;
    if (options_.normal_deviation) {
      turned = turned_places(*options_.normal_deviation, c.result.surface, input_, sizes_, c.vertex_face, c.is_inner,
                             c.result.source);
    }
    if ((far == 0 && turned.empty()) || is_last) {
      if (limits_deviation()) stage_.count("places beyond the deviation", static_cast<double>(far));
      if (options_.normal_deviation) stage_.count("triangles turned too far", static_cast<double>(turned.size()));
      note_what_is_left(far, c.nearness.farthest, turned.size());
      return true;
    }
    ++counts_.deviation_rounds;
    add({std::move(turned), {}});
    return false;
  }

  bool limits_deviation() const { return options_.max_deviation.value_or(0) > 0; }

  /// What the user asked for and does not get.
  void note_what_is_left(std::size_t far, double farthest, std::size_t turned) {
    if (spent_.floor > 0)
      note_spent_budget(far, farthest);
    else if (far > 0)
      stage_.note(fmt::format("{} places lie farther than {:.4g} from the input still: a smaller size helps", far,
                              *options_.max_deviation));
    if (turned > 0)
      stage_.note(
          fmt::format("{} triangles turn by more than {:.4g} degrees against the input still: it is "
                      "rough there, or turns sharply without a feature edge",
                      turned, *options_.normal_deviation));
  }

  void note_spent_budget(std::size_t far, double farthest) {
    std::string left, by;
    if (far > 0) {
      left = fmt::format(", and {} places lie farther than {:.4g} from the input, up to {:.4g}", far,
                         *options_.max_deviation, farthest);
      by = fmt::format("`max_deviation` {:.4g} or ", *options_.max_deviation);
    }
    stage_.note(
        fmt::format("this surface asks for {:.2g} million elements, and the automatic size has a budget of {:.2g} "
                    "million: it stops at {:.4g}{}. For more ask for it, e.g. with {}`automatic_factor` 0.7",
                    spent_.asked / 1e6, limits_.budget / 1e6, spent_.floor, left, by));
  }

  Remeshed kept_as_noise() {
    report_counts(counts_, stage_);
    stage_.note(
        fmt::format("the surface was kept as it is: no triangles but its own follow such noise within {:.4g}. "
                    "Clean the input first, or give a larger `max_deviation`",
                    tolerance_));
    return input_as_it_is(known_, sizes_);
  }

  Remeshed finished(Compacted& c) {
    const std::vector<Vec3>& near = c.nearness.approached;
    if (!near.empty() && spent_.floor == 0)
      c.result.sizes = capped_near(c.result.sizes, thinned(c.result.sizes, near), kDeviationCap, stage_.context());
    if (options_.keep_volumes && seamed_)
      stage_.count("vertices moved for volumes",
                   static_cast<double>(keep_volumes(c.result.surface, c.result.features, surface_, stage_.context())));
    counts_.restored = restored_.size();
    if (!restored_.empty())
      stage_.note(
          fmt::format("the input's own triangles stay in {} places, the first around ({:.6g}, {:.6g}, {:.6g}): "
                      "others cross there at every size",
                      restored_.size(), restored_[0].center.x, restored_[0].center.y, restored_[0].center.z));
    report_counts(counts_, stage_);
    return std::move(c.result);
  }

  const KnownSurface& known_;
  const SurfaceMesh& surface_;     ///< of known_
  std::span<const double> bound_;  ///< see remesh_surface()
  SizeField first_;                ///< the sizes as they were asked, in a complex as they were foreseen
  SizeField sizes_;                ///< and as they are now
  std::vector<Caps> caps_;         ///< between the two
  std::vector<Ball> restored_;     ///< where the input's own triangles stay
  const SurfaceOptions& options_;
  double tolerance_;  ///< for details of the input: none moves farther
  Leeway leeway_;
  FrontLimits limits_;
  const Stage& stage_;
  std::optional<SeamedSurface> seamed_;  ///< of a complex
  InputSurface input_;
  std::optional<SurfaceKind> kind_;  ///< of a single surface
  Counts counts_;
  std::optional<TetPrediction> expected_;  ///< made when it is needed
  struct Spent {
    double asked = 0, floor = 0;  ///< 0: it is not
    int round = 0;                ///< since when
  } spent_;                       ///< the budget
  std::size_t last_triangles_ = 0;
  int stuck_ = 0;          ///< see kMostStuck
  bool is_noise_ = false;  ///< of a complex: no triangles but its own follow it
};

}  // namespace

Remeshed input_as_it_is(const KnownSurface& surface, const SizeField& sizes) {
  Remeshed kept{surface.mesh(), surface.features(), {}, sizes};
  kept.source.resize(kept.surface.triangles.size());
  std::iota(kept.source.begin(), kept.source.end(), 0u);
  return kept;
}

Remeshed remesh_surface(const KnownSurface& surface, const SizeField& sizes, const SurfaceOptions& options,
                        const Stage& stage, std::span<const double> bound, const FrontLimits& limits) {
  return Remesher(surface, sizes, options, stage, bound, limits).run();
}

}  // namespace octafront
