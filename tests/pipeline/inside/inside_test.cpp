// Sheets, lines and points inside, end to end.

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/inside.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

LineNet polygon(const std::string& name, std::vector<Vec3> points) {
  LineNet net{name, std::move(points), {}};
  for (VertexIndex i = 0; i + 1 < net.points.size(); ++i) net.edges.push_back({i, i + 1});
  return net;
}

LineNet helix(int n) {
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n, angle = 4 * std::numbers::pi * t;
    points.push_back({0.5 + 0.3 * std::cos(angle), 0.5 + 0.3 * std::sin(angle), 0.1 + 0.8 * t});
  }
  return polygon("helix", std::move(points));
}

Options at_size(double size) {
  Options options;
  options.size.size = size;
  return options;
}

double length_of_curve(const TetMesh& mesh, const std::string& name) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.curve_edges.size(); ++e)
    if (mesh.curve_names[mesh.curve[e]] == name)
      sum += distance(mesh.points[mesh.curve_edges[e][0]], mesh.points[mesh.curve_edges[e][1]]);
  return sum;
}

TEST(Inside, ALineIsEdgesOfTheMesh) {
  Domain domain(testing::cube(2));
  domain.wires = {polygon("wire", {{0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, {0.9, 0.1, 0.5}})};
  const Result result = generate(domain, at_size(0.15));
  EXPECT_NEAR(length_of_curve(result.mesh, "wire"), std::sqrt(3) * 0.8 + std::sqrt(0.8), 1e-12);
  EXPECT_TRUE(result.mesh.interfaces.empty());
  EXPECT_EQ(first_defect(result.mesh), std::nullopt);
  EXPECT_GT(result.report.quality.dihedral_min, 15);
}

TEST(Inside, ACurvedLineCostsNoFurtherElements) {
  Domain domain(testing::cube(2));
  const Result plain = generate(domain, at_size(0.05));
  domain.wires = {helix(200)};
  const Result with = generate(domain, at_size(0.05));
  double given = 0;
  for (std::size_t i = 0; i < 200; ++i) given += distance(domain.wires[0].points[i], domain.wires[0].points[i + 1]);
  EXPECT_NEAR(length_of_curve(with.mesh, "helix") / given, 1, 0.005);
  EXPECT_LT(static_cast<double>(with.report.tets), 1.05 * static_cast<double>(plain.report.tets));
  EXPECT_GT(with.report.quality.dihedral_min, 20);
}

TEST(Inside, WhatLiesOutsideIsCutOffAndSaid) {
  Domain domain(testing::cube(2));
  domain.wires = {polygon("rod", {{0.5, 0.5, -1}, {0.5, 0.5, 2}})};
  domain.points = {{"probes", {{0.25, 0.25, 0.25}, {0.5, 0.25, 0.75}, {3, 3, 3}}}};
  const Result result = generate(domain, at_size(0.2));
  EXPECT_NEAR(length_of_curve(result.mesh, "rod"), 1, 1e-12);
  ASSERT_EQ(result.mesh.sets.size(), 1U);
  EXPECT_EQ(result.mesh.sets[0].name, "probes");
  ASSERT_EQ(result.mesh.sets[0].members.size(), 2U);
  for (const VertexIndex v : result.mesh.sets[0].members) {
    const Vec3 p = result.mesh.points[v];
    EXPECT_TRUE(p == domain.points[0].points[0] || p == domain.points[0].points[1]);
  }
  std::string notes;
  for (const StageReport& stage : result.report.stages)
    for (const std::string& note : stage.notes) notes += note + "\n";
  EXPECT_NE(notes.find("2 of 3 are nodes"), std::string::npos) << notes;
  EXPECT_NE(notes.find("length 1 in"), std::string::npos) << notes;
}

std::string notes_of(const Result& result) {
  std::string notes;
  for (const StageReport& stage : result.report.stages)
    for (const std::string& note : stage.notes) notes += note + "\n";
  return notes;
}

/// Turned and moved: nothing is parallel to an axis.
template <class Points>
Points moved_about(Points points) {
  const double c = std::cos(0.5), s = std::sin(0.5);
  for (Vec3& p : points)
    p = Vec3{c * p.x - s * p.y, 0.6 * (s * p.x + c * p.y) - 0.8 * p.z, 0.8 * (s * p.x + c * p.y) + 0.6 * p.z} +
        Vec3{3, 1, 2};
  return points;
}

TEST(Inside, LinesOnEdgesAndFacesAreWhole) {
  for (const bool is_turned : {false, true}) {
    SCOPED_TRACE(is_turned);
    SurfaceMesh body = testing::cube(1);
    if (is_turned) body.points = moved_about(body.points);
    Domain domain(body);
    for (std::vector<Vec3> line : std::vector<std::vector<Vec3>>{
             {{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0.8}}, {{0, 0.5, 0}, {1, 0.5, 0}}, {{1, 1, 1}, {0, 0.5, 0.5}}})
      domain.wires.push_back(polygon(fmt::format("w{}", domain.wires.size()), is_turned ? moved_about(line) : line));
    const Result result = generate(domain, at_size(0.2));
    EXPECT_EQ(first_defect(result.mesh), std::nullopt);
    EXPECT_NEAR(result.report.volume, 1, 1e-9);
    EXPECT_GT(result.report.quality.dihedral_min, 15);
    EXPECT_NEAR(length_of_curve(result.mesh, "w0"), 1, 1e-6);
    EXPECT_NEAR(length_of_curve(result.mesh, "w1"), 0.8, 1e-6);
    EXPECT_NEAR(length_of_curve(result.mesh, "w2"), 1, 1e-6);
    EXPECT_NEAR(length_of_curve(result.mesh, "w3"), std::sqrt(1.5), 1e-6);
    EXPECT_EQ(notes_of(result).find("outside"), std::string::npos) << notes_of(result);
  }
}

TEST(Inside, PointsOnCornersEdgesAndFacesAreNodes) {
  for (const bool is_turned : {false, true}) {
    SurfaceMesh body = testing::cube(1);
    std::vector<Vec3> points{{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}, {0.5, 0.5, 0.5}, {2, 2, 2}};
    if (is_turned) body.points = moved_about(body.points), points = moved_about(points);
    Domain domain(body);
    domain.points = {{"g", points}};
    const Result result = generate(domain, at_size(0.2));
    EXPECT_NEAR(result.report.volume, 1, 1e-9);
    ASSERT_EQ(result.mesh.sets.size(), 1U);
    EXPECT_EQ(result.mesh.sets[0].members.size(), 4U);
    EXPECT_NE(notes_of(result).find("4 of 5 are nodes, 1 lies outside"), std::string::npos) << notes_of(result);
  }
}

TEST(Inside, LinesBesideWallsAreWholeAndForceNoFlatElements) {
  for (const double beside : {0.05, 0.01, 0.003})
    for (const bool is_on_face : {true, false}) {
      SCOPED_TRACE(::testing::Message() << beside << " " << is_on_face);
      Domain domain(testing::cube(1));
      const double z = is_on_face ? 0 : beside;
      domain.wires = {polygon("w", {{0.2, beside, z}, {0.8, beside, z}})};
      const Result result = generate(domain, at_size(0.2));
      EXPECT_EQ(first_defect(result.mesh), std::nullopt);
      EXPECT_NEAR(result.report.volume, 1, 1e-9);
      EXPECT_NEAR(length_of_curve(result.mesh, "w"), 0.6, 1e-9);
      EXPECT_GT(result.report.quality.dihedral_min, 10);
    }
}

TEST(Inside, WhatIsCutOffIsSaidWithItsLength) {
  Domain domain(testing::cube(1));
  domain.wires = {polygon("w", {{0.5, 0.5, -1}, {0.5, 0.5, 0.5}})};
  const Result result = generate(domain, at_size(0.2));
  EXPECT_NEAR(length_of_curve(result.mesh, "w"), 0.5, 1e-9);
  EXPECT_NE(notes_of(result).find("; 1 of it lies outside and is cut off"), std::string::npos) << notes_of(result);
}

TEST(Inside, TheSameMeshForAnyNumberOfThreads) {
  Domain domain(testing::cube(2));
  domain.wires = {helix(50)};
  RunContext one, three;
  one.threads = 1, three.threads = 3;
  EXPECT_EQ(generate(domain, at_size(0.1), one).mesh, generate(domain, at_size(0.1), three).mesh);
}

TEST(Inside, ALineThroughSeveralRegionsIsOneCurve) {
  SurfaceMesh low = testing::box(1, 1, 0.5, 2), high = testing::transformed(low, 1, {0, 0, 0.5});
  Domain domain(join_bodies({{"low", low}, {"high", high}}).surface);
  domain.wires = {polygon("rod", {{0.5, 0.5, 0.1}, {0.5, 0.5, 0.9}})};
  const Result result = generate(domain, at_size(0.2));
  EXPECT_NEAR(length_of_curve(result.mesh, "rod"), 0.8, 1e-12);
  EXPECT_EQ(first_defect(result.mesh), std::nullopt);
}

TEST(Inside, ASplitSheetHasTwoSides) {
  SurfaceMesh crack;
  crack.points = {{0.25, 0.25, 0.5}, {0.75, 0.25, 0.5}, {0.75, 0.75, 0.5}, {0.25, 0.75, 0.5}};
  crack.triangles = {{0, 1, 2}, {0, 2, 3}};
  Domain domain(embed_sheets(testing::cube(2), {{"crack", crack}}).surface);
  Options options = at_size(0.1);
  options.split = "crack";
  for (const int order : {1, 2}) {
    options.order = order;
    const Result result = generate(domain, options);
    EXPECT_EQ(first_defect(result.mesh), std::nullopt);
    EXPECT_FALSE(result.mesh.split_faces.empty());
    for (const char* side : {"crack_plus", "crack_minus"})
      EXPECT_EQ(std::count(result.mesh.patch_names.begin(), result.mesh.patch_names.end(), side), 1);
  }
}

/// Hexagons of radius .3 by chance, some of which stick out.
SurfaceMesh fractures(unsigned state, VertexIndex count) {
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) / 4294967296.0; };
  SurfaceMesh sheets;
  for (VertexIndex n = 0; n < count; ++n) {
    Vec3 center;
    for (int axis = 0; axis < 3; ++axis) center[axis] = next();
    const double angle = 2 * std::numbers::pi * next(), z = 2 * next() - 1, r = std::sqrt(1 - z * z);
    const Vec3 normal{r * std::cos(angle), r * std::sin(angle), z};
    const Vec3 u = normalized(cross(normal, std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 v = cross(normal, u);
    for (int k = 0; k < 6; ++k) {
      const double a = std::numbers::pi / 3 * k;
      sheets.points.push_back(center + (u * std::cos(a) + v * std::sin(a)) * 0.3);
    }
    for (VertexIndex k = 1; k + 1 < 6; ++k) sheets.triangles.push_back({6 * n, 6 * n + k, 6 * n + k + 1});
  }
  return sheets;
}

TEST(Inside, AroundTheRimsOfFracturesNoFaceIsLost) {
  Options options = at_size(0.1);
  const std::pair<unsigned, double> cases[] = {{1, 0.01}, {13, 0.01}, {22, 0.01}, {24, 0.01}, {13, 0.002}, {24, 0.002}};
  for (const auto& [seed, deviation] : cases) {
    SCOPED_TRACE(::testing::Message() << seed << " " << deviation);
    options.surface.max_deviation = deviation;
    const Domain domain(embed_sheets(testing::cube(1), {{"fractures", fractures(seed, 12)}}).surface);
    const Result result = generate(domain, options);
    EXPECT_EQ(first_defect(result.mesh), std::nullopt);
    EXPECT_NEAR(result.report.volume, 1, 1e-9);
  }
}

TEST(Inside, ASplitSheetThroughAPeriodicCellKeepsItsPairs) {
  SurfaceMesh wall;
  wall.points = {{-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  Domain domain(embed_sheets(testing::cube(2), {{"wall", wall}}).surface);
  Options options = at_size(0.2);
  options.periodic = "xy";
  for (const int order : {1, 2}) {
    options.order = order;
    options.split = "";
    const TetMesh whole = generate(domain, options).mesh;
    options.split = "wall";
    const TetMesh mesh = generate(domain, options).mesh;
    EXPECT_EQ(first_defect(mesh), std::nullopt);
    for (const auto& [period, copy, original] : mesh.periodic_nodes)
      EXPECT_EQ(mesh.points[copy], mesh.points[original] + mesh.periods[period]);
    const auto on_wall = [](const TetMesh& m) {
      return std::count_if(m.periodic_nodes.begin(), m.periodic_nodes.end(),
                           [&](const auto& pair) { return m.points[pair[1]].z == 0.5; });
    };
    EXPECT_GT(on_wall(whole), 5);
    EXPECT_EQ(on_wall(mesh), 2 * on_wall(whole));
  }
}

TEST(Inside, NamesOfNothingToSplitAreRefusedBeforeWork) {
  Options options = at_size(0.001);  // would take long
  options.split = "lid";
  EXPECT_THROW(generate(Domain(testing::cube(2)), options), OptionError);
}

TEST(Inside, LinesThatNoMeshCanHaveAreRefused) {
  Domain domain(testing::cube(2));
  domain.wires = {{"wire", {{0.1, 0.1, 0.1}}, {{0, 3}}}};
  EXPECT_THROW(generate(domain, at_size(0.2)), InputError);
  domain.wires = {{"wire", {{0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}}, {{0, 1}}}};
  EXPECT_THROW(generate(domain, at_size(0.2)), InputError);
  domain.wires = {polygon("wire", {{0.1, 0.1, 0.1}, {NAN, 0.1, 0.1}})};
  EXPECT_THROW(generate(domain, at_size(0.2)), InputError);
}

}  // namespace
}  // namespace octafront
