#include "periodic/make_periodic.h"

#include <octafront/complex.h>
#include <octafront/error.h>
#include <octafront/repair.h>

#include "support/complexes.h"
#include "support/named_surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::testing::HasSubstr;

constexpr std::array<bool, 3> kAll{true, true, true}, kOnlyX{true, false, false};

/// A box of two triangles a face; those of the faces in `turned` (bits) by the other diagonal.
SurfaceMesh box(Vec3 lo, Vec3 hi, unsigned turned) {
  SurfaceMesh s;
  for (int i = 0; i < 8; ++i) s.points.push_back({(i & 1 ? hi : lo).x, (i & 2 ? hi : lo).y, (i & 4 ? hi : lo).z});
  const std::array<std::array<VertexIndex, 4>, 6> faces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (unsigned f = 0; f < 6; ++f) {
    const auto [a, b, c, d] = faces[f];
    if (turned >> f & 1) {
      s.triangles.insert(s.triangles.end(), {{a, b, d}, {b, c, d}});
    } else {
      s.triangles.insert(s.triangles.end(), {{a, b, c}, {a, c, d}});
    }
  }
  return s;
}

/// Puts a vertex into the middle of an edge of a surface, at all of its triangles.
void divide_edge(SurfaceMesh& s, VertexIndex a, VertexIndex b) {
  const auto middle = static_cast<VertexIndex>(s.points.size());
  s.points.push_back((s.points[a] + s.points[b]) * 0.5);
  const std::size_t count = s.triangles.size();
  for (std::size_t t = 0; t < count; ++t)
    for (int i = 0; i < 3; ++i) {
      const VertexIndex p = s.triangles[t][i], q = s.triangles[t][(i + 1) % 3], r = s.triangles[t][(i + 2) % 3];
      if (!(p == a && q == b) && !(p == b && q == a)) continue;
      s.triangles[t] = {p, middle, r};
      s.triangles.push_back({middle, q, r});
      break;
    }
}

/// Every triangle on a periodic face has its copy; throws otherwise.
std::size_t pairs_of(const SurfaceMesh& s, const PeriodicCell& cell) {
  const PeriodicFaces faces = find_periodic_faces(s, cell);
  std::size_t pairs = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) pairs += faces.face[t] != kNone && faces.face[t] % 2 == 0;
  return pairs;
}

void expect_clean_box(const SurfaceMesh& s, double volume) {
  EXPECT_TRUE(find_defects(repair_surface(s)).clean());
  EXPECT_NEAR(enclosed_volume(s), volume, 1e-9 * volume);
}

TEST(Periods, LeaveTrianglesThatAreCopiesAlready) {
  SurfaceMesh s = box({0, 0, 0}, {1, 2, 3}, 0b101010);
  // Of each pair of faces the second one is seen from the other side: its diagonal is turned to be the same.
  SurfaceMesh t = box({0, 0, 0}, {1, 2, 3}, 0);
  const MadePeriodic made = make_periodic(t, kAll);
  expect_clean_box(t, 6);
  EXPECT_EQ(pairs_of(t, made.cell), 6u);
  const MadePeriodic again = make_periodic(t, kAll);
  EXPECT_EQ(again.imprinted, 0u);
  EXPECT_EQ(again.moved, 0u);
  make_periodic(s, kAll);
  expect_clean_box(s, 6);
}

TEST(Periods, PutTheLinesOfBothFacesOnBoth) {
  SurfaceMesh s = box({0, 0, 0}, {1, 1, 1}, 0b000110);
  divide_edge(s, 1, 5);  // x_max and y_min
  divide_edge(s, 6, 7);  // y_max and z_max
  const MadePeriodic made = make_periodic(s, kAll);
  expect_clean_box(s, 1);
  EXPECT_GT(made.imprinted, 0u);
  EXPECT_GE(pairs_of(s, made.cell), 6u);
  // The middle of an edge along z is on all four of these, and that of one along x.
  int middles = 0;
  for (const Vec3 p : s.points) middles += p.x == 0.5 || p.z == 0.5;
  EXPECT_GE(middles, 8);
}

TEST(Periods, CrossLinesOfRegionsThatDiffer) {
  // The cells of a foam meet opposite faces in other lines.
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    const testing::KnownComplex foam = testing::foam(8, seed);
    SurfaceMesh s = foam.surface;
    const MadePeriodic made = make_periodic(s, kAll);
    EXPECT_TRUE(find_defects(repair_surface(s)).clean());
    EXPECT_GT(pairs_of(s, made.cell), 20u);
    const std::vector<double> volumes = testing::region_volumes(s);
    ASSERT_EQ(volumes.size(), foam.volumes.size());
    for (std::size_t r = 0; r < volumes.size(); ++r) EXPECT_NEAR(volumes[r], foam.volumes[r], 1e-9);
  }
}

TEST(Periods, CarryEndsOfSheets) {
  SurfaceMesh s = testing::cracked_plate().surface;
  const MadePeriodic made = make_periodic(s, kAll);
  EXPECT_TRUE(find_defects(repair_surface(s)).clean());
  EXPECT_GT(pairs_of(s, made.cell), 3u);
}

TEST(Periods, BringTogetherWhatRoundingParted) {
  SurfaceMesh s = box({0, 0, 0}, {1, 1, 1}, 0);
  divide_edge(s, 0, 4);
  divide_edge(s, 1, 5);
  s.points[8].z += 3e-7;
  s.points[3].x -= 2e-7;
  const MadePeriodic made = make_periodic(s, kOnlyX);
  EXPECT_GT(made.moved, 0u);
  EXPECT_LT(made.largest_move, 1e-6);
  EXPECT_GE(pairs_of(s, made.cell), 2u);
  EXPECT_TRUE(find_defects(repair_surface(s)).clean());
}

TEST(Periods, GiveFacesPatchesOfTheirOwn) {
  SurfaceMesh s = box({0, 0, 0}, {1, 1, 1}, 0);
  s.patch.assign(12, 0);
  s.patch[0] = s.patch[1] = 1;
  s.patch_names = {"skin", "inlet"};
  make_periodic(s, kOnlyX);
  EXPECT_THAT(s.patch_names, ::testing::UnorderedElementsAre("skin", "inlet", "x_max"));
}

TEST(Periods, SayWhereOppositeFacesDiffer) {
  SurfaceMesh wedge = box({0, 0, 0}, {1, 1, 1}, 0);
  for (const VertexIndex v : {5u, 7u}) wedge.points[v].z = 0.5;
  try {
    make_periodic(wedge, kOnlyX);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("x_min has something at (0, "));
  }
  SurfaceMesh sphere = testing::icosphere(3);
  EXPECT_THROW(make_periodic(sphere, kOnlyX), InputError);
}

TEST(PeriodicCell, NamesAxes) {
  EXPECT_EQ(axes_named("periodic", "zx"), (std::array{true, false, true}));
  for (const char* wrong : {"xx", "w", "x,y", "X"}) EXPECT_THROW(axes_named("periodic", wrong), OptionError);
}

TEST(PeriodicCell, EndsWhereThePeriodLeads) {
  // .1 + (1.4 - .1) is not 1.4 in doubles everywhere; the end of the cell is what the sum is.
  for (const auto& [lo, hi] : {std::pair{0.1, 1.4}, {0.3, 0.9}, {-0.7, 1e-3}, {1e6 + 0.1, 1e6 + 0.4}}) {
    const PeriodicCell cell = cell_of({{lo, 0, 0}, {hi, 1, 1}}, kAll);
    EXPECT_EQ(cell.box.lo.x + cell.period(0), cell.box.hi.x);
    EXPECT_NEAR(cell.box.hi.x, hi, 1e-9);
  }
}

TEST(PeriodicCell, FindsOriginals) {
  const PeriodicCell cell = cell_of({{0, 0, 0}, {1, 1, 1}}, {true, true, false});
  EXPECT_EQ(cell.original({1, 1, 1}), (Vec3{0, 0, 1}));
  EXPECT_EQ(cell.original({1, 0.5, 0.5}), (Vec3{0, 0.5, 0.5}));
  // An edge that leaves the face moves along no axis.
  const auto ends = cell.originals(std::array{Vec3{1, 1, 0}, Vec3{0.5, 1, 0}});
  EXPECT_EQ(ends[0], (Vec3{1, 0, 0}));
  EXPECT_EQ(ends[1], (Vec3{0.5, 0, 0}));
}

}  // namespace
}  // namespace octafront
