#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "base/core/stage_timer.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

struct ClosedSample {
  const char* name;
  SurfaceMesh surface;
  double size;
};

std::vector<ClosedSample> closed_samples() {
  return {{"cube", testing::cube(1), 0.15},
          {"tetrahedron", testing::unit_tetrahedron(), 0.12},
          {"sphere", testing::icosphere(4), 0.2},
          {"torus", testing::torus(64, 32), 0.15},
          {"hollow sphere", testing::hollow_sphere(4), 0.2},
          {"two bodies", testing::joined(testing::cube(4), testing::transformed(testing::icosphere(3), 0.4, {2, 0, 0})),
           0.15}};
}

Options sized(double h) {
  Options o;
  o.size.size = h;
  return o;
}

TEST(Generate, FillsTheSurfaceItWasGiven) {
  for (const ClosedSample& s : closed_samples()) {
    SCOPED_TRACE(s.name);
    const Result r = generate(s.surface, sized(s.size));
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    EXPECT_NEAR(r.report.volume / enclosed_volume(s.surface), 1, 0.03);
    EXPECT_GT(r.report.quality.beta_min, 0.1);
    EXPECT_GT(r.report.quality.beta_mean, 0.8);
    EXPECT_NEAR(r.report.volume_edges.mean_ratio, 1, 0.15);
  }
}

TEST(Generate, KeepsTheSurfaceExactlyWhenAsked) {
  for (ClosedSample s : closed_samples()) {
    if (std::string(s.name) == "cube") s.surface = testing::cube(6);
    SCOPED_TRACE(s.name);
    Options o = sized(s.size);
    o.surface.keep = true;
    const Result r = generate(s.surface, o);
    EXPECT_EQ(first_defect(r.mesh, s.surface), std::nullopt);
    EXPECT_EQ(r.mesh.source.size(), s.surface.triangles.size());
  }
}

TEST(Generate, KeepsPatchesOfACube) {
  const Result r = generate(testing::cube(2), sized(0.2));
  ASSERT_EQ(r.mesh.patch.size(), r.mesh.boundary.size());
  std::array<double, 6> patch_area{};
  for (std::size_t f = 0; f < r.mesh.boundary.size(); ++f) {
    const auto& [a, b, c] = r.mesh.boundary[f];
    const auto& p = r.mesh.points;
    patch_area.at(r.mesh.patch[f]) += length(cross(p[b] - p[a], p[c] - p[a])) / 2;
  }
  for (const double area : patch_area) EXPECT_NEAR(area, 1, 1e-9);
}

TEST(Generate, NumbersBodiesAsRegions) {
  const SurfaceMesh two =
      testing::joined(testing::icosphere(2), testing::transformed(testing::icosphere(2), 1, {3, 0, 0}));
  const Result r = generate(two, sized(0.4));
  EXPECT_EQ(std::set<std::uint32_t>(r.mesh.region.begin(), r.mesh.region.end()), (std::set<std::uint32_t>{0, 1}));
  for (std::size_t t = 0; t < r.mesh.tets.size(); ++t) {
    const bool right = r.mesh.points[r.mesh.tets[t][0]].x > 1.5;
    EXPECT_EQ(r.mesh.region[t], right ? 1u : 0u);
  }
}

TEST(Generate, RecoversKeptSurfacesWithTheirPatchesAndRegions) {
  const SurfaceMesh two = testing::joined(testing::cube(2), testing::transformed(testing::icosphere(2), 1, {3, 0, 0}));
  Options o;
  o.method = Method::kRecover;
  const Result r = generate(two, o);
  EXPECT_EQ(first_defect(r.mesh, two), std::nullopt);
  EXPECT_EQ(r.mesh.boundary.size(), two.triangles.size());
  EXPECT_EQ(r.mesh.patch, two.patch);
  EXPECT_EQ(std::set<std::uint32_t>(r.mesh.region.begin(), r.mesh.region.end()), (std::set<std::uint32_t>{0, 1}));
}

TEST(Generate, CountsTimeOnce) {
  for (const Method method : {Method::kOctreeAft, Method::kRecover}) {
    Options o;
    o.method = method;
    const double before = process_cpu_seconds();
    const Report report = generate(testing::torus(40, 20), o).report;
    EXPECT_LE(report.cpu_seconds, process_cpu_seconds() - before);
    double sum = 0;
    for (const StageReport& stage : report.stages) sum += stage.cpu_seconds;
    EXPECT_NEAR(sum, report.cpu_seconds, 1e-9);
  }
}

TEST(Generate, MeetsTheNumberOfElements) {
  for (const std::int64_t n : {3'000, 20'000, 100'000}) {
    for (const SurfaceMesh& s : {testing::cube(2), testing::icosphere(4), testing::torus(48, 24)}) {
      Options o;
      o.size.elements = n;
      const Result r = generate(s, o);
      EXPECT_NEAR(static_cast<double>(r.mesh.tets.size()) / static_cast<double>(n), 1, 0.15);
    }
  }
}

// A lattice of equal cells along a square bar: refills of equal worth, over which reconnection once went on for ever.
TEST(Generate, EndsOnARegularBar) {
  SurfaceMesh bar = testing::cube(1);
  for (Vec3& p : bar.points) p = {2.3 + 0.4 * p.x, 2.3 + 0.4 * p.y, -1.3 + 3.6 * p.z};
  Options o;
  o.size.elements = 20'000;
  EXPECT_EQ(first_defect(generate(bar, o).mesh), std::nullopt);
}

TEST(Generate, RefusesAModelTooFarFromTheOrigin) {
  EXPECT_THROW(generate(testing::transformed(testing::cube(1), 1, {1e15, 1e15, 1e15})), InputError);
}

TEST(Generate, RefusesAnOpenSurfaceAndSaysWhere) {
  SurfaceMesh open = testing::cube(2);
  open.triangles.pop_back();
  open.patch.pop_back();
  try {
    generate(open);
    ADD_FAILURE() << "an open surface was accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("open"), std::string::npos) << e.what();
  }
}

TEST(Generate, RefusesASelfIntersectingSurface) {
  const SurfaceMesh crossing =
      testing::joined(testing::cube(2), testing::transformed(testing::cube(2), 1, {0.53, 0.51, 0.57}));
  EXPECT_THROW(generate(crossing), InputError);
}

TEST(Generate, SearchesACleanSurfaceAgainOnceItIsAnotherOne) {
  Domain domain = testing::cube(2);
  domain.found_clean = fingerprint(domain.surface);
  EXPECT_EQ(generate(domain).report.hash, generate(testing::cube(2)).report.hash);
  domain.surface.points[0] = {5, 5, 5};  // through the opposite corner
  EXPECT_NE(domain.found_clean, fingerprint(domain.surface));
  EXPECT_THROW(generate(domain), InputError);
  domain.found_clean = 0;
  EXPECT_THROW(generate(domain), InputError);
}

TEST(Generate, RefusesAnEmptySurface) {
  EXPECT_THROW(generate(SurfaceMesh{}), InputError);
}

TEST(Generate, StopsWhenAsked) {
  std::atomic<bool> cancel{false};
  RunContext context;
  context.cancel = &cancel;
  context.progress = [&](std::string_view stage, double) {
    if (stage == "volume front") cancel = true;
  };
  EXPECT_THROW(generate(testing::icosphere(3), sized(0.1), context), Cancelled);
}

TEST(Generate, SurfaceAndSizesAreWhatTheWholeRunUses) {
  const SurfaceMesh s = testing::torus(48, 24);
  const SurfaceResult surface = generate_surface(s, sized(0.2));
  const Result whole = generate(s, sized(0.2));
  EXPECT_EQ(surface.surface.triangles.size(), whole.mesh.boundary.size());
  EXPECT_EQ(surface.sizes.at({0.3, 0.2, 0.1}), whole.sizes.at({0.3, 0.2, 0.1}));
  EXPECT_NEAR(generate_sizes(s, sized(0.2)).report.expected_tets / static_cast<double>(whole.mesh.tets.size()), 1,
              0.25);
}

TEST(Generate, PredictsWhatTheBoundOnDeviationAdds) {
  const SurfaceMesh s = testing::torus(96, 48);
  Options options = sized(0.5);
  options.surface.max_deviation = 0.01;
  const double expected = generate_sizes(s, options).report.expected_tets;
  const double made = static_cast<double>(generate(s, options).mesh.tets.size());
  EXPECT_GT(made, 2 * static_cast<double>(generate(s, sized(0.5)).mesh.tets.size()));
  EXPECT_NEAR(expected / made, 1, 0.15);
}

TEST(Generate, EveryMethodMakesAValidMesh) {
  for (const ClosedSample& s : closed_samples())
    for (const Method method : {Method::kOctreeAft, Method::kAft, Method::kOctree, Method::kRecover}) {
      SCOPED_TRACE(std::string(s.name) + " " + std::to_string(static_cast<int>(method)));
      Options o = sized(s.size);
      o.method = method;
      const Result r = generate(s.surface, o);
      EXPECT_EQ(first_defect(r.mesh), std::nullopt);
      EXPECT_NEAR(r.report.volume / enclosed_volume(s.surface), 1, 0.04);
      EXPECT_EQ(r.mesh.source.size(), r.mesh.boundary.size());
      EXPECT_EQ(generate(s.surface, o).mesh, r.mesh);
    }
}

TEST(Generate, TheOctreeMethodMeshesOpenAndInsideOutSurfaces) {
  SurfaceMesh open = testing::icosphere(4);
  std::erase_if(open.triangles, [&](const Triangle& t) { return open.points[t[0]].z > 0.95; });
  Options o = sized(0.15);
  EXPECT_THROW(generate(open, o), InputError);
  o.method = Method::kOctree;
  const Result r = generate(open, o);
  EXPECT_NE(r.report.stages[0].notes.back().find("open"), std::string::npos);
  EXPECT_NEAR(r.report.volume / (4 * std::numbers::pi / 3), 1, 0.03);
  EXPECT_NEAR(generate(testing::reversed(open), o).report.volume / r.report.volume, 1, 1e-3);
  SurfaceMesh sheet = open;
  for (Vec3& p : sheet.points) p.z = 0;
  EXPECT_THROW(generate(sheet, o), InputError);
}

TEST(Generate, TheOctreeMethodSaysWhatItLoses) {
  SurfaceMesh plate = testing::cube(4);
  for (Vec3& p : plate.points) p.z *= 0.12;
  Options o = sized(0.2);
  o.method = Method::kOctree;
  try {
    const Result r = generate(plate, o);
    ASSERT_LT(r.report.volume / 0.12, 0.97);
    bool said = false;
    for (const StageReport& stage : r.report.stages)
      for (const std::string& note : stage.notes) said = said || note.find("of its volume") != std::string::npos;
    EXPECT_TRUE(said);
  } catch (const MeshingError& e) {
    EXPECT_NE(std::string(e.what()).find("smaller element size"), std::string::npos);
  }
}

}  // namespace
}  // namespace octafront
