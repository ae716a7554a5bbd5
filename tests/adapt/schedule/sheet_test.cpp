#include <octafront/adapt.h>
#include <octafront/error.h>

#include "base/geometry/measures.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/edge_table.h"
#include "improve/start_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;

/// The boundary of the unit cube, a patch for each side.
SurfaceMesh cube_surface(int n) {
  const TetMesh mesh = kuhn_cube(n);
  SurfaceMesh surface;
  std::map<VertexIndex, VertexIndex> number;
  for (Triangle t : mesh.boundary) {
    for (VertexIndex& v : t) {
      const auto [at, is_new] = number.try_emplace(v, static_cast<VertexIndex>(surface.points.size()));
      if (is_new) surface.points.push_back(mesh.points[v]);
      v = at->second;
    }
    surface.triangles.push_back(t);
  }
  surface.patch = mesh.patch;
  return surface;
}

SurfaceMesh round_surface(int n) {
  SurfaceMesh surface = cube_surface(n);
  for (Vec3& p : surface.points) p = normalized(2 * p - Vec3{1, 1, 1});
  surface.patch.clear();
  return surface;
}

/// n x n squares of the unit square at z = 0, turned upward.
SurfaceMesh unit_square(int n) {
  SurfaceMesh surface;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) surface.points.push_back({double(i) / n, double(j) / n, 0});
  const auto at = [&](int i, int j) { return static_cast<VertexIndex>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return surface;
}

AdaptedSurface adapted_sheet(const SurfaceMesh& surface, double size, int threads = 0) {
  Options options;
  options.size.size = size;
  RunContext context;
  context.threads = threads;
  return adapt_surface(surface, options, context);
}

double part_that_fits(const AdaptedSurface& made) {
  return static_cast<double>(made.after.fitting) / static_cast<double>(made.after.edges);
}

std::map<std::uint32_t, double> areas_of(const SurfaceMesh& surface) {
  std::map<std::uint32_t, double> areas;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    areas[surface.patch.empty() ? 0 : surface.patch[t]] += triangle_area(surface.points, surface.triangles[t]);
  return areas;
}

/// How many edges have so many triangles.
std::map<std::size_t, std::size_t> edges_by_triangles(const SurfaceMesh& surface) {
  std::map<std::size_t, std::size_t> count;
  const EdgeTable table = make_edge_table(surface.points.size(), surface.triangles);
  for (std::size_t e = 0; e < table.size(); ++e) ++count[table.uses(e).size()];
  return count;
}

double length_of_edges(const SurfaceMesh& surface, std::size_t triangles) {
  double sum = 0;
  const EdgeTable table = make_edge_table(surface.points.size(), surface.triangles);
  for (std::size_t e = 0; e < table.size(); ++e)
    if (table.uses(e).size() == triangles)
      sum += distance(surface.points[table.edges[e][0]], surface.points[table.edges[e][1]]);
  return sum;
}

TEST(AdaptSheet, CubeKeepsPatchesAndCorners) {
  for (const double size : {0.06, 0.7}) {
    const AdaptedSurface made = adapted_sheet(cube_surface(5), size);
    const auto areas = areas_of(made.surface);
    ASSERT_EQ(areas.size(), 6u);
    for (const auto& [patch, area] : areas) EXPECT_NEAR(area, 1, 1e-12);
    EXPECT_NEAR(enclosed_volume(made.surface), 1, 1e-12);
    EXPECT_EQ(edges_by_triangles(made.surface).size(), 1u);
    EXPECT_EQ(edges_by_triangles(made.surface).begin()->first, 2u);
    EXPECT_GT(part_that_fits(made), 0.8);
    EXPECT_TRUE(self_intersections(made.surface.points, made.surface.triangles, 1).empty());
  }
}

TEST(AdaptSheet, BallFitsFineAndCoarseSizes) {
  const SurfaceMesh ball = round_surface(12);
  const AdaptedSurface fine = adapted_sheet(ball, 0.08), coarse = adapted_sheet(ball, 0.4);
  EXPECT_GT(part_that_fits(fine), 0.95);
  EXPECT_GT(fine.after.quality_mean, 0.9);
  EXPECT_GT(fine.after.quality_min, 0.4);
  EXPECT_NEAR(enclosed_volume(fine.surface), 4.18879, 0.04);
  EXPECT_LT(2 * coarse.surface.triangles.size(), ball.triangles.size());
  EXPECT_LE(coarse.deviation.upper, coarse.deviation.bound);
}

TEST(AdaptSheet, SameBitsForAnyNumberOfThreads) {
  const SurfaceMesh ball = round_surface(12);
  const auto both = [&](int threads) {
    std::vector<AdaptedSurface> made{adapted_sheet(ball, 0.04, threads)};
    made.push_back(adapted_sheet(made[0].surface, 0.08, threads));
    return made;
  };
  const auto one = both(1);
  // Of many cells, whose rims are no worse than what lies inside.
  EXPECT_GT(one[0].surface.points.size(), 8192u);
  for (const AdaptedSurface& made : one) {
    EXPECT_EQ(edges_by_triangles(made.surface), (std::map<std::size_t, std::size_t>{{2, made.after.edges}}));
    EXPECT_GT(part_that_fits(made), 0.95);
    EXPECT_LT(made.after.longest, 2);
    EXPECT_GT(made.after.quality_min, 0.4);
  }
  for (const int threads : {2, 3}) {
    const auto more = both(threads);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(more[k].surface.points, one[k].surface.points);
      EXPECT_EQ(more[k].surface.triangles, one[k].surface.triangles);
      EXPECT_EQ(more[k].old_of_new, one[k].old_of_new);
    }
  }
}

TEST(AdaptSheet, OpenSurfaceKeepsItsRim) {
  const AdaptedSurface fine = adapted_sheet(unit_square(4), 0.03), coarse = adapted_sheet(fine.surface, 0.5);
  for (const AdaptedSurface* made : {&fine, &coarse}) {
    EXPECT_NEAR(areas_of(made->surface)[0], 1, 1e-12);
    EXPECT_NEAR(length_of_edges(made->surface, 1), 4, 1e-12);
    for (const Triangle& t : made->surface.triangles) {
      const auto& p = made->surface.points;
      EXPECT_GT(double_area_normal(p[t[0]], p[t[1]], p[t[2]]).z, 0);
    }
  }
  EXPECT_GT(part_that_fits(fine), 0.97);
  EXPECT_LT(coarse.surface.triangles.size(), 30u);
}

TEST(AdaptSheet, ThreeSheetsStayTogetherAtTheirEdge) {
  // The second square stands on the middle of the first.
  SurfaceMesh surface = unit_square(4);
  surface.patch.assign(surface.triangles.size(), 0);
  const SurfaceMesh other = unit_square(4);
  std::vector<VertexIndex> number;
  for (const Vec3 p : other.points) {
    const Vec3 q{0.5, p.x, p.y};
    const auto at = std::find(surface.points.begin(), surface.points.end(), q);
    number.push_back(static_cast<VertexIndex>(at - surface.points.begin()));
    if (at == surface.points.end()) surface.points.push_back(q);
  }
  for (const auto& [a, b, c] : other.triangles) {
    surface.triangles.push_back({number[a], number[b], number[c]});
    surface.patch.push_back(1);
  }
  for (const double size : {0.06, 0.4}) {
    const AdaptedSurface made = adapted_sheet(surface, size);
    EXPECT_NEAR(areas_of(made.surface).at(0), 1, 1e-12);
    EXPECT_NEAR(areas_of(made.surface).at(1), 1, 1e-12);
    EXPECT_NEAR(length_of_edges(made.surface, 3), 1, 1e-12);
    EXPECT_GT(part_that_fits(made), 0.85);
  }
}

TEST(AdaptSheet, TrianglesBecomeAsLongAsAMetricWants) {
  const SurfaceMesh square = unit_square(40);
  MetricMesh metric;
  metric.points = square.points, metric.triangles = square.triangles;
  for (const Vec3 p : square.points) {
    const double across = 0.01 + 0.1 * std::abs(p.x - 0.5);
    metric.metrics.push_back({1 / (across * across), 0, 0, 100, 0, 100});
  }
  const AdaptedSurface made = adapt_surface_to_metric(square, metric);
  EXPECT_GT(part_that_fits(made), 0.9);
  EXPECT_GT(made.after.quality_mean, 0.8);
  EXPECT_NEAR(areas_of(made.surface)[0], 1, 1e-12);
}

TEST(AdaptSheet, ComesToASurfaceThatIsGiven) {
  const Domain ground(round_surface(30));
  Options options;
  options.size.size = 0.1;
  const AdaptedSurface made = adapt_surface(round_surface(4), options, {}, &ground);
  EXPECT_NEAR(enclosed_volume(made.surface) / enclosed_volume(ground.surface), 1, 5e-3);
  EXPECT_LE(made.deviation.upper, made.deviation.bound);
}

TEST(AdaptSheet, TrianglesWithVerticesOfTheirOwnAreJoined) {
  const SurfaceMesh whole = cube_surface(3);
  SurfaceMesh soup;
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    const auto first = static_cast<VertexIndex>(soup.points.size());
    for (const VertexIndex v : whole.triangles[t]) soup.points.push_back(whole.points[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
    soup.patch.push_back(whole.patch[t]);
  }
  const AdaptedSurface made = adapted_sheet(soup, 0.2);
  EXPECT_EQ(edges_by_triangles(made.surface).begin()->first, 2u);
  EXPECT_NEAR(enclosed_volume(made.surface), 1, 1e-12);
  std::size_t stayed = 0;
  for (VertexIndex v = 0; v < made.old_of_new.size(); ++v)
    stayed += made.old_of_new[v] != kNone && soup.points[made.old_of_new[v]] == made.surface.points[v];
  EXPECT_GE(stayed, 8u);
}

TEST(AdaptSheet, WhatItCannotDoIsRefused) {
  Options options;
  options.size.size = 0.5;
  options.adapt.only = "box:0,0,0,1,1,1";
  EXPECT_THROW(adapt_surface(cube_surface(2), options), OptionError);
  options.adapt.only.clear();
  SurfaceMesh wrong = cube_surface(2);
  wrong.triangles[3][1] = 1000;
  EXPECT_THROW(adapt_surface(wrong, options), InputError);
  EXPECT_THROW(adapt_surface(SurfaceMesh{}, options), InputError);
}

TEST(AdaptSurface, CornersThatTheFileNamesStay) {
  // A blunt cone, whose tip no feature tells.
  SurfaceMesh cone;
  constexpr int kSides = 48;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * M_PI * i / kSides;
    cone.points.push_back({std::cos(angle), std::sin(angle), 0});
  }
  cone.points.push_back({0, 0, 0.3});
  for (VertexIndex i = 0; i < kSides; ++i) cone.triangles.push_back({i, (i + 1) % kSides, kSides});
  Options options;
  for (const double size : {0.3, 0.08}) {
    options.size.size = size;
    const std::vector<PlacedSet> sets{{"Corners", NamedSet::Kind::kNodes, {{0, 0, 0.3}}}};
    const AdaptedSurface made = adapt_surface(cone, options, {}, nullptr, sets);
    const auto& points = made.surface.points;
    EXPECT_NE(std::find(points.begin(), points.end(), Vec3{0, 0, 0.3}), points.end()) << size;
  }
}

}  // namespace
}  // namespace octafront
