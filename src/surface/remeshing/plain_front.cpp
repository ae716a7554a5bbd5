// The steps of a single surface.

#include "base/geometry/measures.h"
#include "surface/lines/line_sizes.h"
#include "surface/lines/merge_lines.h"
#include "surface/remeshing/front_kind.h"
#include "surface/remeshing/mend_folds.h"
#include "surface/remeshing/outcome.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace octafront::surface {

namespace {

/// A shell that came out inside out is smaller than its elements: it needs much smaller ones at once.
constexpr double kCapOfShells = 0.29;
/// Where all that crosses does so among the input's triangles, so many rounds in a row, no round will end it: points on
/// their edges are rounded, and sheets may lie nearer to each other than that.
constexpr int kMostStuck = 4;
/// Where a user's size crosses, triangles of the input are what was asked if they are as large and no longer than so
/// many sizes: smaller sizes take many times the elements between shells that nearly touch.
constexpr double kAsLong = 4;
/// Triangles of the input longer than so many sizes that stay get fans of as many needles around them, on which every
/// search takes the square of their number: where they are this part of the surface, as the facets of a needle are, all
/// of it stays.
constexpr double kFarTooLong = 100, kMostlyTooLong = 0.25;
/// Sizes where the new surface deviates too far become this part of themselves, and for how many rounds; less at once
/// where it deviates so many times as far as it may.
constexpr double kDeviationCap = 0.7, kMuchTooFar = 2, kDeviationCapFar = 0.5;
constexpr int kMostDeviationRounds = 5;
/// How often points of the input are put in where the new surface nearly deviates, and where it deviates, if it does so
/// at few places: at this part of its triangles. At more of them it is made anew with smaller sizes.
constexpr int kApproachesWhereNear = 3, kMostApproaches = 6;
constexpr double kFewFar = 0.02;
/// At fewer than this part it is mended where it deviates or crosses; another round would cost as much as the first. Of
/// a small surface rounds cost little, and make better triangles.
constexpr double kNoRound = 1e-3;
/// So often, until so many in a row have left no fewer places.
constexpr int kMostRefinements = 5, kMostInVain = 2;

std::ptrdiff_t count_triangles(const std::vector<FarPlace>& places) {
  std::vector<std::uint32_t> triangles;
  for (const FarPlace& place : places) triangles.push_back(place.triangle);
  std::sort(triangles.begin(), triangles.end());
  return std::unique(triangles.begin(), triangles.end()) - triangles.begin();
}

bool are_few(std::ptrdiff_t triangles, const WorkingMesh& mesh, double part) {
  return static_cast<double>(triangles) < part * static_cast<double>(mesh.made_triangles());
}

std::vector<VertexIndex> corners_at(const WorkingMesh& mesh, const std::vector<FarPlace>& places) {
  std::vector<VertexIndex> corners;
  for (const FarPlace& place : places)
    for (const VertexIndex v : mesh.triangle(place.triangle)) corners.push_back(v);
  return corners;
}

class PlainFront : public FrontKind {
 public:
  explicit PlainFront(FrontWork& work)
      : FrontKind(work),
        input_(make_input_surface(work.surface(), work.known.edges())),
        kind_(work.surface(), work.known.edges()) {}

  InputSurface& input() override { return input_; }
  const Features& features() const override { return work_.known.features(); }
  const StripRules& strips() const override { return kStrips; }
  SizeField fitted(const SizeField& in_strips, const std::vector<std::uint8_t>&) const override { return in_strips; }

  std::vector<Curve> curves(const SizeField& sizes, std::vector<std::uint8_t>& is_fixed) override {
    std::vector<Curve> curves = chain_curves(input_, features().corners, is_fixed, sizes);
    divide_curves(input_, sizes, curves);
    return curves;
  }

  void adjust(Draft& draft, const RoundSizes& sizes) override {
    const RunContext& context = work_.stage.context();
    remove_input_vertices(draft.mesh, draft.sizes, context, work_.counts.coarsen);
    compact(draft);
    work_.progress(0.6);
    work_.counts.merged_lines = merge_all_lines(draft);
    improve_surface(draft.mesh, input_, draft.curves, draft.sizes, context, work_.counts.improve);
    work_.counts.merged_lines += merge_all_lines(draft);
    draft.is_clear = mend_draft(draft, false);
    come_near(draft, sizes.first());
  }

  std::optional<std::string> first_defect(const SurfaceMesh& made, bool crosses, std::vector<Vec3>& at) override {
    if (crosses) return {};
    return kind_.first_defect_but_crossings(made, work_.stage.context(), &at);
  }

  void answer(const std::vector<Vec3>& places, const Outcome&, bool crosses, RoundSizes& sizes) override {
    const bool all_kept =
        sizes.cap_or_keep(places, crosses ? kCap : kCapOfShells, true, [&](Vec3 p) -> std::optional<KeptPlace> {
          if (!is_as_asked(p, sizes.first()) && !is_in_vain(p, sizes)) return {};
          return KeptPlace{p, kKeptRadius * sizes.first().at(p)};
        });
    stuck_ = all_kept ? stuck_ + 1 : 0;
    needles_kept_ = keeps_mostly_needles(sizes);
  }

  bool leaves_far(std::size_t, const Outcome&) const override {
    return work_.counts.deviation_rounds == kMostDeviationRounds || work_.counts.exceed(kPatience);
  }

  void cap_far(const Nearness& near, RoundSizes& sizes) const override {
    sizes.add(near.wanted, {});
    if (!near.far.empty()) sizes.cap(near.far, kDeviationCap);
    if (!near.farther.empty()) sizes.cap(near.farther, kDeviationCapFar);
  }

  bool is_stuck() const override { return stuck_ == kMostStuck || needles_kept_; }
  bool has_needles_kept() const override { return needles_kept_; }

  void finish(Remeshed& made, const Nearness& near) const override {
    if (near.approached.empty() || work_.budget.is_spent()) return;
    made.sizes = capped_near(made.sizes, thinned(made.sizes, near.approached), kDeviationCap, work_.stage.context());
  }

 private:
  /// Of a fine scan little is left, and each step from here on goes through all that is.
  static void compact(Draft& draft) {
    std::vector<std::uint8_t> is_fixed;
    for (const VertexIndex v : draft.mesh.compact())
      is_fixed.push_back(v < draft.is_fixed.size() ? draft.is_fixed[v] : 0);
    draft.is_fixed = std::move(is_fixed);
  }

  std::uint64_t merge_all_lines(Draft& draft) const {
    return merge_lines(draft.mesh, draft.is_fixed, work_.tolerance, work_.leeway);
  }

  bool mend_draft(Draft& draft, bool clear) {
    const PlaceLimits limits{work_.tolerance, work_.tolerance, kFewCrossing};
    return mend_places(draft.mesh, draft.is_fixed, limits, clear);
  }

  /// What deviates or crosses at few places is mended where it is: by points of the input, and smaller triangles where
  /// these do not help.
  void come_near(Draft& draft, const SizeField& first) {
    Nearness& n = draft.nearness;
    DeviationWatch watch(kLeftAlone * work_.tolerance, work_.tolerance, work_.surface(), work_.known.tree(),
                         Fine::kParts, work_.bound);
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (int k = 0, in_vain = 0;; ++k) {
      const std::vector<FarPlace> places = brought_near(draft, watch);
      note_far(draft, places);
      if (k == kMostRefinements || (draft.is_clear && n.is_near_enough)) return;
      std::vector<PointSize> wanted = sizes_where_few(draft, places, first);
      in_vain = wanted.size() < least ? 0 : in_vain + 1;
      if (wanted.empty() || in_vain == kMostInVain) return;
      least = std::min(least, wanted.size());
      n.wanted.insert(n.wanted.end(), wanted.begin(), wanted.end());
      draft.sizes = capped_at(draft.sizes, smallest_ones(std::move(wanted)), work_.stage.context());
      divide_long(draft);
      draft.is_clear = mend_draft(draft, false);
    }
  }

  /// Puts in points of the input where the draft deviates or nearly does. Returns where it does so still.
  std::vector<FarPlace> brought_near(Draft& draft, DeviationWatch& watch) {
    std::vector<FarPlace> places = far_places(work_, draft.mesh, watch);
    if (!put_in_points(draft, watch, places)) return places;
    draft.is_clear = mend_draft(draft, draft.is_clear);
    return far_places(work_, draft.mesh, watch);
  }

  /// Points of the input at the places, and where it deviates then, while that leaves fewer; false if none was put in.
  bool put_in_points(Draft& draft, DeviationWatch& watch, std::vector<FarPlace> places) {
    const double tolerance = work_.tolerance;
    const auto strays = [&] {
      return std::ranges::count_if(places, [&](const FarPlace& p) { return p.distance > tolerance; });
    };
    bool any = false;
    for (int k = 0; k < kMostApproaches; ++k) {
      const auto before = strays();
      std::erase_if(places, [&](const FarPlace& p) { return p.within || p.distance < kComeNear * tolerance; });
      if (places.empty() || !are_few(count_triangles(places), draft.mesh, kFewFar)) return any;
      const std::uint64_t put_in = draw_to_input(draft.mesh, input_, work_.known.tree(), draft.is_fixed, places);
      if (put_in == 0) return any;
      any = true;
      work_.counts.approached += put_in;
      const std::vector<Vec3> there = positions_beyond(0, places);
      draft.nearness.approached.insert(draft.nearness.approached.end(), there.begin(), there.end());
      places = far_places(work_, draft.mesh, watch);
      if (before > 0 ? strays() >= before : k + 1 == kApproachesWhereNear) return any;
    }
    return any;
  }

  void note_far(Draft& draft, const std::vector<FarPlace>& places) const {
    const double much = kMuchTooFar * work_.tolerance;
    Nearness& n = draft.nearness;
    n.far = positions_beyond(work_.tolerance, places, much);
    n.farther = positions_beyond(much, places);
    n.farthest = farthest_of(places);
    n.near_limit = corners_at(draft.mesh, places);
    n.is_near_enough = is_near_enough(draft.mesh, places);
  }

  /// Whether it deviates nowhere, or a little at few places.
  bool is_near_enough(const WorkingMesh& mesh, std::vector<FarPlace> places) const {
    std::erase_if(places, [&](const FarPlace& p) { return p.distance < work_.tolerance; });
    const double most = work_.limits.slack * work_.tolerance;
    return places.empty() || (are_few(count_triangles(places), mesh, kNoRound) &&
                              std::ranges::all_of(places, [&](const FarPlace& p) { return p.distance <= most; }));
  }

  /// Sizes by which it would deviate no more, and smaller ones where it crosses; none if that is at many places.
  std::vector<PointSize> sizes_where_few(const Draft& draft, std::vector<FarPlace> places,
                                         const SizeField& first) const {
    const WorkingMesh& mesh = draft.mesh;
    std::erase_if(places, [&](const FarPlace& p) { return p.distance < work_.tolerance; });
    if (!are_few(count_triangles(places), mesh, kNoRound)) return {};
    std::vector<PointSize> wanted = sizes_against(places, work_.tolerance, draft.sizes);
    if (draft.is_clear) return wanted;
    const std::vector<std::uint8_t> crossing = crossing_triangles(mesh);
    if (!are_few(std::count(crossing.begin(), crossing.end(), 1), mesh, kNoRound)) return {};
    for (std::uint32_t t = 0; t < crossing.size(); ++t) {
      if (!crossing[t]) continue;
      const auto [a, b, c] = mesh.triangle(t);
      const Vec3 middle = centroid(mesh.points[a], mesh.points[b], mesh.points[c]);
      if (const double size = draft.sizes.at(middle); size >= kVain * first.at(middle))
        wanted.push_back({middle, kCap * size});
    }
    return smallest_ones(std::move(wanted));
  }

  /// Of a size that a user gave, whether the input's triangle at p is about as large as asked.
  bool is_as_asked(Vec3 p, const SizeField& first) const {
    if (work_.budget.is_limited() || !is_as_large(p, first)) return false;
    return longest_edge_of(input_triangle_at(p)) <= kAsLong * first.at(p);
  }

  /// Whether triangles that are far too long, and are to stay, are a large part of the surface. With a given size the
  /// fans are as fine as was asked, and volumes need not be kept.
  bool keeps_mostly_needles(const RoundSizes& sizes) {
    if (sizes.kept_places().empty() || !work_.budget.is_limited()) return false;
    const std::vector<std::uint8_t> is_fixed =
        mark_kept_places(input_, work_.known.tree(), sizes.kept_places());  // the next round marks anew
    const SurfaceMesh& surface = work_.surface();
    double all = 0, needles = 0;
    for (const auto& [a, b, c] : surface.triangles) {
      const TriangleCorners t{surface.points[a], surface.points[b], surface.points[c]};
      const double area = length(double_area_normal(t[0], t[1], t[2]));
      all += area;
      if (is_fixed[a] && is_fixed[b] && is_fixed[c] &&
          longest_edge_of(t) > kFarTooLong * sizes.first().at(centroid(t[0], t[1], t[2])))
        needles += area;
    }
    return needles > kMostlyTooLong * all;
  }

  InputSurface input_;
  SurfaceKind kind_;
  int stuck_ = 0;  ///< rounds in a row
  bool needles_kept_ = false;
};

}  // namespace

std::unique_ptr<FrontKind> make_plain_front(FrontWork& work) {
  return std::make_unique<PlainFront>(work);
}

}  // namespace octafront::surface
