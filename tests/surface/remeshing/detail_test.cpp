// Detail of the input below the scale of the elements: folds, needles between lines, places where nothing else fits.

#include <octafront/quality.h>

#include "base/geometry/measures.h"
#include "support/named_surfaces.h"
#include "surface/edits/deviation.h"
#include "surface/edits/kept_places.h"
#include "surface/edits/working_mesh.h"
#include "surface/remeshing/mend_folds.h"
#include "surface/remeshing/remesh.h"
#include "surface/remeshing/surface_check.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using namespace octafront::testing;

surface::InputSurface input_surface(const SurfaceMesh& surface) {
  return surface::make_input_surface(surface, make_edge_table(surface.points.size(), surface.triangles));
}

std::optional<surface::Unfolded> unfold(const SurfaceMesh& surface, double tolerance) {
  return surface::unfold(surface, make_edge_table(surface.points.size(), surface.triangles), tolerance, {});
}

constexpr double kDegree = std::numbers::pi / 180;

/// The sharpest edge, inside or outside; radians.
double sharpest(const SurfaceMesh& surface) {
  const HalfEdgeMesh mesh = make_half_edge_mesh(surface);
  double least = std::numbers::pi;
  for (HalfEdge h = 0; h < mesh.start.size(); ++h) {
    const Vec3 n = mesh.area_vector(h / 3), m = mesh.area_vector(mesh.twin[h] / 3);
    least = std::min(least, std::numbers::pi - std::atan2(length(cross(n, m)), dot(n, m)));
  }
  return least;
}

double worst_shape(const SurfaceMesh& surface) {
  double least = 1;
  for (const auto& [a, b, c] : surface.triangles)
    least = std::min(least, triangle_radius_ratio(surface.points[a], surface.points[b], surface.points[c]));
  return least;
}

/// A sphere of which one vertex is pulled over its neighbours, a little above them, so that it overhangs.
SurfaceMesh folded_sphere() {
  SurfaceMesh s = icosphere(3);
  Vec3& p = s.points[s.triangles[0][0]];
  const Vec3 towards = normalized(cross(p, Vec3{0.3, 0.7, 0.2}));
  p = p * 1.01 + towards * 0.22;
  return s;
}

/// A sphere with one vertex far out: a spike.
SurfaceMesh spiked_sphere(double height) {
  SurfaceMesh s = icosphere(4);
  s.points[s.triangles[7][1]] *= 1 + height;
  return s;
}

Remeshed remesh_within(const SurfaceMesh& surface, double h, StageReport& report,
                       std::optional<double> deviation = {}) {
  SurfaceOptions options;
  options.max_deviation = deviation;
  return remesh_surface(KnownSurface(surface, 40), SizeField::uniform(h), options, {{}, report});
}

double counter(const StageReport& report, const std::string& key) {
  for (const auto& [name, value] : report.counters)
    if (name == key) return value;
  return -1;
}

TEST(Unfold, TakesAwayAFoldWithinTheTolerance) {
  const SurfaceMesh folded = folded_sphere();
  ASSERT_TRUE(surface::find_crossings(folded).empty());
  ASSERT_LT(sharpest(folded), 25 * kDegree);
  const auto unfolded = unfold(folded, 0.3);
  ASSERT_TRUE(unfolded.has_value());
  EXPECT_GT(sharpest(unfolded->surface), 25 * kDegree);
  EXPECT_EQ(unfolded->mended.folds_left, 0u);
  EXPECT_LE(unfolded->mended.largest_move, 0.3);
  EXPECT_EQ(first_surface_defect(unfolded->surface, folded), std::nullopt);
  EXPECT_EQ(unfolded->surface.source.size(), unfolded->surface.triangles.size());
}

TEST(Unfold, NothingMovesBeyondTheTolerance) {
  EXPECT_FALSE(unfold(folded_sphere(), 1e-6).has_value());
  EXPECT_FALSE(unfold(cube(4), 1).has_value()) << "a cube has no folds";
}

TEST(Unfold, KeepsPatchBorders) {
  SurfaceMesh folded = folded_sphere();
  for (std::size_t t = 0; t < folded.triangles.size(); ++t) folded.patch.push_back(t < 5 ? 1 : 0);
  const auto unfolded = unfold(folded, 0.3);
  ASSERT_TRUE(unfolded.has_value());
  EXPECT_EQ(std::count(unfolded->surface.patch.begin(), unfolded->surface.patch.end(), 1u) > 0, true);
  EXPECT_EQ(unfolded->surface.patch.size(), unfolded->surface.triangles.size());
}

TEST(Unfold, KeepsTheNameAndLabelOfTheRegion) {
  SurfaceMesh folded = folded_sphere();
  folded.region_names = {"ball"};
  folded.region_labels = {7};
  const auto unfolded = unfold(folded, 0.3);
  ASSERT_TRUE(unfolded.has_value());
  EXPECT_EQ(unfolded->surface.region_names, folded.region_names);
  EXPECT_EQ(unfolded->surface.region_labels, folded.region_labels);
}

/// A box of which one upright edge is cut off by a sliver of a face: two sharp lines that begin at one corner and end
/// `width` apart, as a decimated model draws one line.
SurfaceMesh box_with_needle(double width) {
  SurfaceMesh s;
  s.points = {{0, 0, 0}, {1, 0, 0},         {1, 1, 0},         {0, 1, 0}, {0, 0, 1},
              {1, 0, 1}, {1, 1 - width, 1}, {1 - width, 1, 1}, {0, 1, 1}};
  s.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {4, 7, 8}, {0, 1, 5}, {0, 5, 4},
                 {1, 2, 6}, {1, 6, 5}, {2, 7, 6}, {2, 3, 8}, {2, 8, 7}, {3, 0, 4}, {3, 4, 8}};
  return s;
}

TEST(MergeLines, OneLineDrawnAsANeedleBecomesOneLine) {
  const SurfaceMesh needle = box_with_needle(0.03);
  ASSERT_LT(worst_shape(needle), 0.1);
  StageReport report;
  const Remeshed made = remesh_within(needle, 0.15, report);
  EXPECT_GT(counter(report, "lines merged"), 0);
  EXPECT_GT(worst_shape(made.surface), 0.3);
  EXPECT_EQ(first_surface_defect(made.surface, needle), std::nullopt);
}

TEST(MergeLines, LinesStayWhereNothingMayMove) {
  StageReport report;
  const Remeshed made = remesh_within(box_with_needle(0.03), 0.15, report, 0.0);
  EXPECT_EQ(counter(report, "lines merged"), 0);
  EXPECT_LT(worst_shape(made.surface), 0.3);
}

TEST(MergeLines, AStripWithAPatchOfItsOwnIsNotLost) {
  SurfaceMesh needle = box_with_needle(0.03);
  needle.patch.assign(needle.triangles.size(), 0);
  needle.patch[9] = 1;
  StageReport report;
  const Remeshed made = remesh_within(needle, 0.15, report);
  EXPECT_GT(std::count(made.surface.patch.begin(), made.surface.patch.end(), 1u), 0);
}

TEST(KeptPlaces, TrianglesThatReachIntoABallStayWhole) {
  const SurfaceMesh ball = icosphere(2);
  surface::InputSurface input = input_surface(ball);
  const Vec3 center = input.mesh.points[0];
  const auto fixed = surface::mark_kept_places(input, TriangleTree(ball), {{center, 0.01}});
  std::size_t lines = 0;
  for (const std::uint8_t f : input.mesh.is_feature) lines += f;
  std::size_t triangles = 0;
  input.mesh.for_each_outgoing(0, [&](HalfEdge) { ++triangles; });
  EXPECT_EQ(lines, 2 * 2 * triangles) << "spokes and rim, both half-edges";
  EXPECT_EQ(static_cast<std::size_t>(std::count(fixed.begin(), fixed.end(), 1)), triangles + 1);
}

TEST(Detail, ASpikeBelowTheSizeIsPulledIn) {
  StageReport report;
  const Remeshed made = remesh_within(spiked_sphere(0.03), 0.2, report);
  EXPECT_GT(worst_shape(made.surface), 0.4);
  for (const Vec3 p : made.surface.points) EXPECT_LT(length(p), 1.02);
}

/// A ball whose upper half overhangs the lower one like a cap, `gap` above it: sizes that would tell the sheets apart
/// are some hundred times smaller.
SurfaceMesh capped_ball(double gap) {
  constexpr int kAround = 60;
  constexpr double kStep = 0.05;
  std::vector<std::array<double, 2>> profile;  // angle from the north pole, radius
  for (int k = 62; k >= 16; --k) profile.push_back({kStep * k, 1});
  for (int k = 17; k <= 24; ++k) profile.push_back({kStep * k, 1 + gap});
  for (int k = 24; k >= 1; --k) profile.push_back({kStep * k, 1.1});
  SurfaceMesh s;
  s.points = {{0, 0, -1}, {0, 0, 1.1}};
  for (const auto& [a, r] : profile) {
    for (int i = 0; i < kAround; ++i) {
      const double b = 2 * std::numbers::pi * i / kAround;
      s.points.push_back({r * std::sin(a) * std::cos(b), r * std::sin(a) * std::sin(b), r * std::cos(a)});
    }
  }
  const auto at = [&](std::size_t ring, int i) { return static_cast<VertexIndex>(2 + ring * kAround + i % kAround); };
  for (int i = 0; i < kAround; ++i) {
    s.triangles.push_back({0, at(0, i + 1), at(0, i)});
    s.triangles.push_back({1, at(profile.size() - 1, i), at(profile.size() - 1, i + 1)});
    for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
      s.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      s.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  }
  return s;
}

TEST(Fallback, IsLocal) {
  const SurfaceMesh capped = capped_ball(1e-4);
  ASSERT_TRUE(surface::find_crossings(capped).empty());
  StageReport report;
  const Remeshed made = remesh_within(capped, 0.25, report, 0.0);
  EXPECT_GT(counter(report, "places left as in the input"), 0);
  EXPECT_EQ(first_surface_defect(made.surface, capped), std::nullopt);
  // The gap is 1.65 away: sizes that grow by .12 from nothing are larger than this.
  EXPECT_GT(made.sizes.at({0, 0, -1}), 0.195);
  std::size_t coarse = 0, all = 0;
  for (const auto& [a, b, c] : made.surface.triangles) {
    if (made.surface.points[a].z > -0.6) continue;
    ++all;
    coarse += distance(made.surface.points[a], made.surface.points[b]) > 0.15;
  }
  EXPECT_GT(coarse, 0.9 * static_cast<double>(all));
}

/// A ball, and a small one in it whose wall is `gap` below its own.
SurfaceMesh ball_with_a_pearl(double gap) {
  constexpr double kRadius = 0.1;
  SurfaceMesh s = icosphere(5);
  s.sides.assign(s.triangles.size(), {kNone, 0});
  SurfaceMesh pearl = icosphere(3);
  const auto first = static_cast<VertexIndex>(s.points.size());
  for (const Vec3 p : pearl.points) s.points.push_back(p * kRadius + Vec3{0, 0, 1 - gap - kRadius});
  for (const auto& [a, b, c] : pearl.triangles) s.triangles.push_back({a + first, b + first, c + first});
  s.sides.resize(s.triangles.size(), {0, 1});
  s.patch.assign(s.triangles.size(), 0);
  std::fill(s.patch.begin() + 20 * 1024, s.patch.end(), 1);
  return s;
}

TEST(Refine, MendsAComplexThatIsWrongAtOnePlaceWithoutAnotherRound) {
  const SurfaceMesh input = ball_with_a_pearl(0.005);
  StageReport report;
  const Remeshed made = remesh_within(input, 0.7, report, 0.3);
  EXPECT_LE(counter(report, "rounds"), 2);  // three where each chord that passes the pearl by costs one
  EXPECT_TRUE(surface::find_crossings(made.surface).empty());
  EXPECT_EQ(first_complex_defect_but_crossings(made.surface, no_context()), std::nullopt);
}

std::vector<surface::FarPlace> places_beyond(double limit, const SurfaceMesh& made, const SurfaceMesh& input) {
  std::vector<std::uint32_t> number(made.triangles.size());
  std::iota(number.begin(), number.end(), 0u);
  const TriangleTree tree(input);
  return surface::DeviationWatch(limit, limit, input, tree).look(made, number);
}

/// A sphere with a bump narrower than the triangles that are to come: vertices pass it by.
SurfaceMesh bumpy_sphere() {
  SurfaceMesh s = icosphere(5);
  const Vec3 top = normalized(Vec3{0.3, 0.5, 0.8});
  for (Vec3& p : s.points) p *= 1 + 0.4 * std::max(0.0, 0.1 - distance(p, top));
  return s;
}

TEST(Approach, MendsAPlaceThatStraysWithoutAnotherRound) {
  const SurfaceMesh input = bumpy_sphere();
  StageReport report;
  const Remeshed made = remesh_within(input, 0.25, report, 0.02);
  EXPECT_EQ(counter(report, "rounds"), 1);
  EXPECT_GT(counter(report, "points against deviation"), 0);
  EXPECT_TRUE(surface::find_crossings(made.surface).empty());
  EXPECT_TRUE(places_beyond(0.02, made.surface, input).empty());
}

TEST(DeviationWatch, RoundingMayHideTheNearestTriangle) {
  // A face of almost no size at a vertex of the made surface, nearer to it than its own coordinates are exact.
  const Vec3 a{0.0144217, 0.0273499, 0.99549}, b{0.0492329, -0.0014078, 0.9920928};
  SurfaceMesh made, input;
  made.points = {a, {8.6160231305757192e-32, 1.3940329699783265e-31, 1}, b};
  made.triangles = {{0, 1, 2}};
  const Vec3 m{3.6394480898000725e-33, -6.006948655464061e-33, 1};
  const double e = 1e-32;
  input.points = {a, b, m + Vec3{e, 0, 0}, m + Vec3{-e, e, 0}, m + Vec3{0, -e, 0}};
  input.triangles = {{0, 2, 1}, {0, 3, 1}, {0, 4, 1}, {2, 3, 4}};
  EXPECT_TRUE(places_beyond(1e-3, made, input).empty());
}

TEST(DeviationWatch, FindsAgainWhatAllAnewWouldFind) {
  const SurfaceMesh input = bumpy_sphere();
  const TriangleTree tree(input);
  SurfaceMesh made = icosphere(4);
  std::vector<std::uint32_t> number(made.triangles.size());
  std::iota(number.begin(), number.end(), 10u);
  surface::DeviationWatch watch(0.01, 0.02, input, tree);
  const auto triangles_at = [](const std::vector<surface::FarPlace>& places) {
    std::set<std::uint32_t> found;
    for (const surface::FarPlace& place : places) found.insert(place.triangle);
    return found;
  };
  EXPECT_FALSE(watch.look(made, number).empty());
  for (const double height : {0.05, -0.03, 0.0}) {
    made.points[made.triangles[7][1]] *= 1 + height;
    const auto again = triangles_at(watch.look(made, number));
    EXPECT_EQ(again, triangles_at(surface::DeviationWatch(0.01, 0.02, input, tree).look(made, number)));
    EXPECT_EQ(again, triangles_at(watch.look(made, number)));
  }
  made.triangles.pop_back();  // it leaves a hole in the input's sight
  number.pop_back();
  EXPECT_EQ(triangles_at(watch.look(made, number)),
            triangles_at(surface::DeviationWatch(0.01, 0.02, input, tree).look(made, number)));
}

TEST(DeviationWatch, LooksCloserAtTrianglesWithABoundOfTheirOwn) {
  const SurfaceMesh input = icosphere(4), made = icosphere(2);  // some .02 below
  const TriangleTree tree(input);
  std::vector<std::uint32_t> number(made.triangles.size());
  std::iota(number.begin(), number.end(), 0u);
  std::vector<double> bound(input.triangles.size(), HUGE_VAL);
  for (std::size_t t = 0; t < bound.size(); ++t)
    if (input.points[input.triangles[t][0]].x > 0.5) bound[t] = 0.01;
  EXPECT_TRUE(surface::DeviationWatch(0.04, 0.04, input, tree).look(made, number).empty());
  const auto places = surface::DeviationWatch(0.04, 0.04, input, tree, surface::Fine::kParts, bound).look(made, number);
  EXPECT_FALSE(places.empty());
  for (const surface::FarPlace& place : places) {
    EXPECT_GT(place.at.x, 0.35);
    EXPECT_GE(place.distance, 0.04);  // as many times more
  }
}

/// A cylinder of radius 1 and height 2 whose sides are as long as it is high.
SurfaceMesh cylinder_of_strips(VertexIndex sides) {
  SurfaceMesh s;
  for (VertexIndex k = 0; k < sides; ++k) {
    const double turn = 2 * std::numbers::pi * k / sides;
    for (const double z : {0.0, 2.0}) s.points.push_back({std::cos(turn), std::sin(turn), z});
  }
  s.points.push_back({0, 0, 0});
  s.points.push_back({0, 0, 2});
  for (VertexIndex k = 0; k < sides; ++k) {
    const VertexIndex a = 2 * k, b = 2 * ((k + 1) % sides);
    for (const Triangle& t :
         {Triangle{a, b, b + 1}, {a, b + 1, a + 1}, {2 * sides, b, a}, {2 * sides + 1, a + 1, b + 1}})
      s.triangles.push_back(t);
  }
  return s;
}

TEST(DeviationWatch, FindsWhatStraysFromStripsWithoutLookingAlongEachOfThem) {
  const SurfaceMesh input = cylinder_of_strips(3000);
  StageReport report;
  SurfaceMesh made = remesh_within(input, 0.2, report).surface;
  EXPECT_TRUE(places_beyond(0.02, made, input).empty());
  EXPECT_LT(places_beyond(1e-5, made, input).size(), 20 * input.triangles.size());
  const auto pulled = std::ranges::min_element(made.points, {}, [](Vec3 p) { return distance(p, {1, 0, 1}); });
  pulled->x += 0.1;
  const auto places = places_beyond(0.04, made, input);
  EXPECT_TRUE(std::ranges::any_of(places, [](const surface::FarPlace& place) { return place.within; }));
  for (const surface::FarPlace& place : places) EXPECT_LT(distance(place.at, *pulled), 0.3);
}

TEST(Coarsening, ComesToAnEndAtAHubOfThousandsOfTriangles) {
  StageReport report;
  const Remeshed made = remesh_within(cylinder_of_strips(60'000), 0.3, report);
  EXPECT_GT(worst_shape(made.surface), 0.5);
}

TEST(DeviationWatch, FindsFromBothSides) {
  const SurfaceMesh smooth = icosphere(4), spiked = spiked_sphere(0.1);
  EXPECT_TRUE(places_beyond(0.11, smooth, spiked).empty());
  for (const auto& [made, input] : {std::pair{&smooth, &spiked}, std::pair{&spiked, &smooth}}) {
    const auto places = places_beyond(0.05, *made, *input);
    ASSERT_FALSE(places.empty());
    for (const surface::FarPlace& place : places)
      EXPECT_LT(distance(place.at, spiked.points[spiked.triangles[7][1]]), 0.1);
  }
}

}  // namespace
}  // namespace octafront
