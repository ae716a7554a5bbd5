#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/validity.h>

#include "adapt/schedule/adapt_mesh.h"
#include "adapt/schedule/rim_metric.h"
#include "improve/start_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using namespace testing;

AdaptedMesh adapted(const TetMesh& mesh, double size, int threads = 0) {
  Options options;
  options.size.size = size;
  RunContext context;
  context.threads = threads;
  return adapt_existing(mesh, options, context);
}

double part_fitting(const MetricSummary& s) {
  return static_cast<double>(s.fitting) / static_cast<double>(s.edges);
}

TEST(Adapt, CubeBecomesFinerAndCoarserAgain) {
  const TetMesh start = kuhn_cube(3);
  const AdaptedMesh fine = adapted(start, 0.08);
  EXPECT_GT(fine.mesh.tets.size(), 8 * start.tets.size());
  EXPECT_GE(part_fitting(fine.after), 0.97);
  EXPECT_LE(fine.after.longest, 2);
  EXPECT_GE(fine.after.quality_min, 0.3);
  EXPECT_NEAR(volume(fine.mesh), 1, 1e-12);
  const AdaptedMesh coarse = adapted(fine.mesh, 0.4);
  EXPECT_LT(20 * coarse.mesh.tets.size(), fine.mesh.tets.size());
  EXPECT_NEAR(volume(coarse.mesh), 1, 1e-12);
  EXPECT_EQ(first_defect(coarse.mesh), std::nullopt);
}

TEST(Adapt, SamePatchesOnTheSamePlanes) {
  const TetMesh start = kuhn_cube(3);
  const auto areas = [](const TetMesh& mesh) {
    std::vector<double> sum;
    for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
      const Triangle& t = mesh.boundary[f];
      sum.resize(std::max<std::size_t>(sum.size(), mesh.patch[f] + 1), 0);
      const Vec3 n = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
      sum[mesh.patch[f]] += 0.5 * length(n);
    }
    return sum;
  };
  const AdaptedMesh fine = adapted(start, 0.1);
  const auto had = areas(start), has = areas(fine.mesh);
  ASSERT_EQ(had.size(), has.size());
  for (std::size_t p = 0; p < had.size(); ++p) EXPECT_NEAR(had[p], has[p], 1e-12);
}

TEST(Adapt, SameBitsForAnyNumberOfThreads) {
  const TetMesh start = kuhn_cube(13);  // more vertices than a piece has, once it grows
  EXPECT_EQ(adapted(start, 0.055, 1).mesh, adapted(start, 0.055, 2).mesh);
}

TEST(Adapt, RegionsAndSetsStayWhereTheyAre) {
  TetMesh start = kuhn_cube(4);
  start.region.clear();
  NamedSet low{"low", NamedSet::Kind::kElements, {}};
  for (TetIndex t = 0; t < start.tets.size(); ++t) {
    double x = 0, z = 0;
    for (const VertexIndex v : start.tets[t]) x += start.points[v].x / 4, z += start.points[v].z / 4;
    start.region.push_back(x > 0.5);
    if (z < 0.25) low.members.push_back(t);
  }
  start.region_names = {"left", "right"};
  start.sets.push_back(low);
  const AdaptedMesh fine = adapted(start, 0.1);
  EXPECT_EQ(fine.mesh.region_names, start.region_names);
  ASSERT_EQ(fine.mesh.sets.size(), 1u);
  std::array<double, 2> volumes{};
  double of_set = 0;
  const auto volume_of = [&](TetIndex t) {
    const auto& [a, b, c, d] = fine.mesh.tets[t];
    const auto& p = fine.mesh.points;
    return dot(cross(p[b] - p[a], p[c] - p[a]), p[d] - p[a]) / 6;
  };
  for (TetIndex t = 0; t < fine.mesh.tets.size(); ++t) volumes[fine.mesh.region[t]] += volume_of(t);
  for (const TetIndex t : fine.mesh.sets[0].members) of_set += volume_of(t);
  EXPECT_NEAR(volumes[0], 0.5, 1e-12);
  EXPECT_NEAR(volumes[1], 0.5, 1e-12);
  EXPECT_NEAR(of_set, 0.25, 1e-12);
}

/// The linear metric of the Unstructured Grid Adaptation Working Group: sizes .1, .1, .001 + .198 |z - .5|.
std::array<std::array<double, 3>, 3> layer_metric(Vec3 p) {
  const double h = 0.001 + 0.198 * std::abs(p.z - 0.5);
  return {{{100, 0, 0}, {0, 100, 0}, {0, 0, 1 / (h * h)}}};
}

TEST(Adapt, ElementsBecomeAsFlatAsAMetricWants) {
  const AdaptedMesh flat = adapt_to_metric(kuhn_cube(2), layer_metric);
  EXPECT_GE(part_fitting(flat.after), 0.97);
  EXPECT_LE(flat.after.longest, 2);
  EXPECT_GE(flat.after.quality_min, 0.4);
  EXPECT_GE(flat.after.quality_mean, 0.86);
  EXPECT_NEAR(static_cast<double>(flat.mesh.tets.size()) / flat.after.complexity, 10.5, 1);
  EXPECT_NEAR(volume(flat.mesh), 1, 1e-12);
}

/// The Working Group's polar-2 on a quarter of a ring: .001 + .198 |r - .5| along the radius, .025 around at r = .5.
std::array<std::array<double, 3>, 3> ring_metric(Vec3 p) {
  const double r = std::hypot(p.x, p.y), c = p.x / r, s = p.y / r, d = std::min(10 * (0.6 - r), 1.0);
  const double along = 0.001 + 0.198 * std::abs(r - 0.5), around = d < 0 ? 0.1 : d / 40 + (1 - d) * 0.1;
  const double a = 1 / (along * along), b = 1 / (around * around);
  return {{{a * c * c + b * s * s, (a - b) * c * s, 0}, {(a - b) * c * s, a * s * s + b * c * c, 0}, {0, 0, 100}}};
}

TEST(Adapt, MetricOfTurningDirectionsDoesNotExplode) {
  const TetMesh start = transformed(kuhn_cube(8), 1, {0.3, 0.3, 0});
  const AdaptedMesh made = adapt_to_metric(start, ring_metric);
  EXPECT_GE(part_fitting(made.after), 0.95);
  EXPECT_LE(made.after.longest, 2.5);
  EXPECT_GE(made.after.quality_min, 0.15);
  EXPECT_GE(made.after.quality_mean, 0.84);
  EXPECT_LE(static_cast<double>(made.mesh.tets.size()), 12 * made.after.complexity);
}

TEST(Adapt, WallsStayWhereTheyAreAskedTo) {
  const TetMesh start = kuhn_cube(6);
  StageReport report;
  const adapt::SizeMetric metric(SizeField::uniform(0.06));
  const adapt::AdaptRules rules{.feature_angle = 40, .tolerance = 0.01, .keep_walls = true};
  const std::vector<std::uint8_t> walls = adapt::on_walls(start);
  const TetMesh mesh = adapt::adapt_mesh(start, adapt::RimMetric(start, walls, metric), rules, {{}, report}).mesh;
  EXPECT_GT(mesh.tets.size(), 2 * start.tets.size());
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  const auto corners = [](const TetMesh& m) {
    std::vector<std::array<double, 9>> all;
    for (Triangle t : m.boundary) {
      const auto before = [&](VertexIndex a, VertexIndex b) {
        const Vec3 p = m.points[a], q = m.points[b];
        return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
      };
      std::sort(t.begin(), t.end(), before);
      std::array<double, 9> c;
      for (int i = 0; i < 9; ++i) c[i] = m.points[t[i / 3]][i % 3];
      all.push_back(c);
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_EQ(corners(mesh), corners(start));
}

TEST(Adapt, WorstElementIsSaidWithItsPlace) {
  const TetMesh start = perturbed(kuhn_cube(4), 0.2, 7);
  // Where sizes are the same everywhere the measure is 12 (3 V)^(2/3) over the sum of the squared edges.
  double worst = 1;
  Vec3 middle;
  for (const auto& [a, b, c, d] : start.tets) {
    const std::array<Vec3, 4> p{start.points[a], start.points[b], start.points[c], start.points[d]};
    double sum = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) sum += dot(p[j] - p[i], p[j] - p[i]);
    const double quality = 12 * std::pow(dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 2, 2.0 / 3) / sum;
    if (quality < worst) worst = quality, middle = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  }
  const MetricSummary fit = adapted(start, 0.3).before;
  EXPECT_NEAR(fit.quality_min, worst, 1e-6);
  EXPECT_LT(length(fit.quality_min_at - middle), 1e-12);
}

TEST(Adapt, OldVerticesAreNamed) {
  const TetMesh start = kuhn_cube(3);
  const AdaptedMesh fine = adapted(start, 0.1);
  ASSERT_EQ(fine.old_of_new.size(), fine.mesh.points.size());
  std::size_t corners = 0;
  for (VertexIndex v = 0; v < fine.old_of_new.size(); ++v) {
    if (v > 0 && fine.old_of_new[v] != kNone) {
      EXPECT_LT(fine.old_of_new[v - 1], fine.old_of_new[v]);
    }
    if (fine.old_of_new[v] == kNone) continue;
    const Vec3 p = start.points[fine.old_of_new[v]];
    const bool corner = (p.x == 0 || p.x == 1) && (p.y == 0 || p.y == 1) && (p.z == 0 || p.z == 1);
    if (!corner) continue;
    ++corners;
    EXPECT_EQ(fine.mesh.points[v], p);
  }
  EXPECT_EQ(corners, 8u);
}

TEST(Adapt, WhatIsNoMeshOrNoMetricIsRefused) {
  TetMesh broken = kuhn_cube(2);
  std::swap(broken.tets[0][0], broken.tets[0][1]);
  EXPECT_THROW(adapted(broken, 0.2), InputError);
  const auto flat = [](Vec3) { return std::array<std::array<double, 3>, 3>{{{1, 0, 0}, {0, 0, 0}, {0, 0, 1}}}; };
  EXPECT_THROW(adapt_to_metric(kuhn_cube(2), flat), InputError);
  TetMesh periodic = kuhn_cube(2);
  periodic.periodic_nodes.push_back({0, 1, 0});
  EXPECT_THROW(adapted(periodic, 0.2), InputError);
}

TEST(Adapt, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  RunContext context;
  context.cancel = &stop;
  Options options;
  options.size.size = 0.1;
  EXPECT_THROW(adapt_existing(kuhn_cube(2), options, context), Cancelled);
}

}  // namespace
}  // namespace octafront
