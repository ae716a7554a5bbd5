// Flows around bodies: what is meshed is a box without them.

#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/io.h>
#include <octafront/poly_mesh.h>
#include <octafront/validity.h>

#include "base/dual/poly_faults.h"
#include "support/named_surfaces.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::testing::HasSubstr;

SurfaceMesh flown_around(Vec3 center, double radius = 1) {
  return testing::transformed(testing::icosphere(3), radius, center);
}

Domain in_tunnel(const SurfaceMesh& body, const std::string& box) {
  IntakeOptions options;
  options.wind_tunnel = box;
  return open_domain(body, options);
}

/// A car whose sections are rectangles: along the rounded nose their corners are creases that fade to the front.
SurfaceMesh car() {
  constexpr double kRadius = 0.1, kLength = 0.6, kHalf = 0.2;
  constexpr int kSlices = 24;
  SurfaceMesh body;
  for (int i = 0; i <= kSlices + 1; ++i) {
    const double t = static_cast<double>(i) / kSlices, x = i > kSlices ? kLength : kRadius * t * t;
    const double to_shoulder = kRadius - std::min(x, kRadius);
    const double h = kHalf - kRadius + std::sqrt(std::max(0.0, kRadius * kRadius - to_shoulder * to_shoulder));
    for (const auto& [y, z] : {std::pair(-h, -h), {h, -h}, {h, h}, {-h, h}}) body.points.push_back({x, y, z});
  }
  const auto add = [&](VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) {
    body.triangles.push_back({a, b, c}), body.triangles.push_back({a, c, d});
  };
  add(0, 3, 2, 1);
  const auto last = static_cast<VertexIndex>(body.points.size() - 4);
  for (VertexIndex first = 0; first < last; first += 4)
    for (VertexIndex k = 0; k < 4; ++k) {
      const VertexIndex a = first + k, b = first + (k + 1) % 4;
      add(a, b, b + 4, a + 4);
    }
  add(last, last + 1, last + 2, last + 3);
  return body;
}

/// Area of the triangles of a patch.
double area_of(const SurfaceMesh& surface, const std::string& name) {
  double area = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.patch_names[surface.patch_of(t)] != name) continue;
    const auto& [a, b, c] = surface.triangles[t];
    area += 0.5 * length(cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a]));
  }
  return area;
}

TEST(Tunnel, AFloatingBodyIsCutOut) {
  const SurfaceMesh body = flown_around({});
  const Domain domain = in_tunnel(body, "-5,-5,-5:10,5,5");
  EXPECT_NEAR(enclosed_volume(domain.surface), 1500 - enclosed_volume(body), 1e-9);
  EXPECT_NEAR(area_of(domain.surface, "inlet"), 100, 1e-9);
  EXPECT_NEAR(area_of(domain.surface, "ground"), 150, 1e-9);
  EXPECT_EQ(domain.body_length, 2);
}

TEST(Tunnel, TheDefaultBoxIsByTheBodysLength) {
  const Domain domain = in_tunnel(flown_around({}), "auto");
  EXPECT_NEAR(area_of(domain.surface, "outlet"), 22 * 22, 1e-9);
  EXPECT_NEAR(area_of(domain.surface, "top"), 22 * 32, 1e-9);
}

TEST(Tunnel, WhatSticksOutIsCut) {
  const SurfaceMesh body = flown_around({});
  const Domain domain = in_tunnel(body, "-5,-5,0:10,5,5");
  EXPECT_NEAR(enclosed_volume(domain.surface), 750 - 0.5 * enclosed_volume(body), 1e-6);
  EXPECT_LT(area_of(domain.surface, "ground"), 150 - 3);
}

TEST(Tunnel, CavitiesOfTheBodyAreNotFlow) {
  SurfaceMesh hollow = flown_around({}, 2), cavity = flown_around({});
  const double outer = enclosed_volume(hollow);
  const auto first = static_cast<VertexIndex>(hollow.points.size());
  hollow.points.insert(hollow.points.end(), cavity.points.begin(), cavity.points.end());
  for (const auto& [a, b, c] : cavity.triangles) hollow.triangles.push_back({first + a, first + c, first + b});
  EXPECT_NEAR(enclosed_volume(in_tunnel(hollow, "-5,-5,-5:10,5,5").surface), 1500 - outer, 1e-9);
}

TEST(Tunnel, OpenBodiesAndWrongBoxesAreRefused) {
  SurfaceMesh open = flown_around({});
  open.triangles.pop_back();
  IntakeOptions options;
  options.wind_tunnel = "auto", options.repair = IntakeOptions::Repair::kOff;
  EXPECT_THROW(open_domain(open, options), InputError);
  EXPECT_THROW(in_tunnel(flown_around({}), "5,5,5:10,10,10"), OptionError);
  EXPECT_THROW(in_tunnel(flown_around({}), "outside"), OptionError);
}

TEST(Tunnel, SizesAreSmallOnTheBodyAndGrowFromIt) {
  Options options;
  options.size.size = 0.25;
  options.layers.count = 2, options.layers.first_part = 0.1;
  SurfaceMesh body = flown_around({});
  body.patch_names = {"body"};  // which is also what the only region of a mesh is called
  const Result made = generate(in_tunnel(body, "-5,-5,-5:10,5,5"), options);
  EXPECT_FALSE(first_defect(made.mesh));
  // With edges of a quarter everywhere there would be some 800,000.
  EXPECT_LT(made.mesh.tets.size(), 100000);
  ASSERT_EQ(made.report.layers.size(), 1);
  EXPECT_EQ(made.report.layers[0].patch, "body");
  EXPECT_GT(made.report.layers[0].full, 0.99);
}

TEST(Tunnel, PolyhedraAreSoundWhereACreaseUnderLayersFades) {
  for (const double h : {0.08, 0.05}) {
    Options options;
    options.size.size = h;
    options.layers.count = 4, options.layers.first = 0.0008;
    const Result made = generate(in_tunnel(car(), "-1,-1,-1:2,1,1"), options);
    EXPECT_FALSE(first_defect(dual_mesh(made.mesh))) << h;
  }
}

TEST(Tunnel, FirstHeightsFollowSpeedAndFluid) {
  Options options;
  options.size.size = 0.5;
  options.layers.count = 1, options.layers.yplus = 100, options.layers.speed = 1;
  const auto first = [&](const char* fluid) {
    options.layers.fluid = fluid;
    return generate(in_tunnel(flown_around({}), "-5,-5,-5:10,5,5"), options).report.layers.at(0).first_median;
  };
  // h = y+ L / (Re sqrt(.013 Re^(-1/7))), L the body's length.
  const double re = 2 / 1.5e-5;
  EXPECT_NEAR(first("air"), 100 * 2 / (re * std::sqrt(0.013 * std::pow(re, -1.0 / 7))), 1e-4);
  EXPECT_NEAR(first("1.5e-5"), first("air"), 1e-12);
  EXPECT_LT(first("water"), 0.2 * first("air"));
  EXPECT_THROW(first("honey"), OptionError);
}

TEST(Tunnel, ADeckIsACaseAndWritesOverNone) {
  namespace fs = std::filesystem;
  const testing::TemporaryFolder folder;
  fs::create_directories(folder / "constant");
  Options options;
  options.size.size = 0.5;
  const TetMesh mesh = generate(in_tunnel(flown_around({}), "-5,-5,-5:10,5,5"), options).mesh;
  WriteOptions how;
  how.deck = true;
  const std::string target = (folder / "constant" / "polyMesh").string();
  EXPECT_THROW(check_mesh_target(target, how), OptionError);
  how.speed = 20;
  how.unit = "furlong";
  EXPECT_THROW(check_mesh_target(target, how), OptionError);
  how.unit = "cm";
  check_mesh_target(target, how);
  write_mesh(target, mesh, {}, how);
  for (const char* file : {"0/U", "0/p", "0/k", "0/omega", "0/nut", "system/controlDict", "system/fvSchemes",
                           "system/fvSolution", "constant/transportProperties", "constant/turbulenceProperties"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  const auto text_of = [&](const fs::path& file) {
    std::ifstream in(folder / file);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  const std::string text = text_of("system/controlDict");
  EXPECT_THAT(text, HasSubstr("patches (wall)"));
  EXPECT_THAT(text, HasSubstr("magUInf 20;"));
  EXPECT_THAT(text, HasSubstr("lRef 0.0198"));
  EXPECT_THAT(text_of("constant/polyMesh/points"), HasSubstr("(-0.05 -0.05 -0.05)"));
  EXPECT_THROW(check_mesh_target(target, how), OutputError);
  how.deck = false;
  check_mesh_target(target, how);
}

TEST(Tunnel, PolyhedraSeeTheirFacesAtASharpEdge) {
  constexpr double kHalf = 0.17632698;  // of an edge of 20 degrees
  SurfaceMesh blade;
  blade.points = {{0, 0, 0}, {1, -kHalf, 0}, {1, kHalf, 0}, {0, 0, 1}, {1, -kHalf, 1}, {1, kHalf, 1}};
  blade.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  Options options;
  options.size.size = 0.25;
  options.layers.count = 3;
  options.layers.first_part = 0.1;
  const PolyMesh dual = dual_mesh(generate(in_tunnel(blade, "-1,-1.5,-1:3,1.5,2"), options).mesh);
  EXPECT_EQ(dual::faults_of(dual).turned, 0U);
}

}  // namespace
}  // namespace octafront
