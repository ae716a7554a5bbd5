#include "fill/front/fill.h"

#include <octafront/error.h>
#include <octafront/quality.h>
#include <octafront/validity.h>

#include "base/mesh/complex.h"
#include "support/labelled_walls.h"
#include "support/named_surfaces.h"
#include "support/nasty_surfaces.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::cube;
using testing::hollow_sphere;
using testing::icosphere;
using testing::joined;
using testing::torus;
using testing::transformed;

double mean_edge(const SurfaceMesh& s) {
  double sum = 0;
  for (const Triangle& t : s.triangles)
    for (int i = 0; i < 3; ++i) sum += distance(s.points[t[i]], s.points[t[(i + 1) % 3]]);
  return sum / (3.0 * static_cast<double>(s.triangles.size()));
}

TetMesh filled(const SurfaceMesh& s, const SizeField& sizes, VolumeOptions options = {}) {
  StageReport report;
  return fill_volume(s, sizes, options, {RunContext{}, report});
}

TetMesh filled(const SurfaceMesh& s, VolumeOptions options = {}) {
  return filled(s, SizeField::uniform(mean_edge(s)), options);
}

VolumeOptions front_alone() {
  VolumeOptions options;
  options.core = VolumeOptions::Core::kOff;
  return options;
}

/// A long row of needles: a box whose sides are fans from their corners.
SurfaceMesh needle_box(int n) {
  SurfaceMesh s;
  for (int level = 0; level < 2; ++level)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i <= n; ++i) s.points.push_back({i / double(n), double(side) * 0.3, double(level) * 0.3});
  const auto at = [&](int level, int side, int i) {
    return static_cast<VertexIndex>((2 * level + side) * (n + 1) + i);
  };
  const auto strip = [&](auto&& lower, auto&& upper) {
    // All of the lower row sees the first vertex of the upper one, all of the upper row the last of the lower one.
    for (int i = 0; i < n; ++i) s.triangles.push_back({lower(i), lower(i + 1), upper(0)});
    for (int i = 0; i < n; ++i) s.triangles.push_back({lower(n), upper(i + 1), upper(i)});
  };
  const auto row = [&](int level, int side) { return [&at, level, side](int i) { return at(level, side, i); }; };
  strip(row(0, 0), row(1, 0));
  strip(row(1, 0), row(1, 1));
  strip(row(1, 1), row(0, 1));
  strip(row(0, 1), row(0, 0));
  for (const int i : {0, n}) {
    const VertexIndex a = at(0, 0, i), b = at(0, 1, i), c = at(1, 1, i), d = at(1, 0, i);
    if (i == 0)
      s.triangles.insert(s.triangles.end(), {{a, d, c}, {a, c, b}});
    else
      s.triangles.insert(s.triangles.end(), {{a, b, c}, {a, c, d}});
  }
  return s;
}

struct Sample {
  std::string name;
  SurfaceMesh surface;
};

std::vector<Sample> samples() {
  return {{"tetrahedron", testing::unit_tetrahedron()},
          {"cube of 12", cube()},
          {"cube of many coplanar points", cube(14)},
          {"sphere", icosphere(3)},
          {"torus", torus(48, 16)},
          {"hollow sphere", hollow_sphere(3)},
          {"thin shell", hollow_sphere(3, 1, 0.9)},
          {"coarse thin shell", hollow_sphere(1, 1, 0.75)},
          {"Schoenhardt", testing::twisted_prism(3, 30)},
          {"sharp Schoenhardt", testing::twisted_prism(3, 57)},
          {"needles", needle_box(40)}};
}

void expect_laws(const TetMesh& mesh, const SurfaceMesh& surface) {
  EXPECT_EQ(first_defect(mesh, surface), std::nullopt);
  EXPECT_EQ(mesh.boundary, surface.triangles);
  EXPECT_EQ(mesh.patch, surface.patch);
  ASSERT_GE(mesh.points.size(), surface.points.size());
  EXPECT_TRUE(std::equal(surface.points.begin(), surface.points.end(), mesh.points.begin()));
  EXPECT_TRUE(mesh.region.empty() || mesh.region.size() == mesh.tets.size());
}

TEST(FillVolume, KeepsTheLawsOnNamedSurfaces) {
  for (const Sample& s : samples()) {
    SCOPED_TRACE(s.name);
    expect_laws(filled(s.surface, front_alone()), s.surface);
    expect_laws(filled(s.surface), s.surface);
  }
}

TEST(FillVolume, MakesGoodElementsOnGoodSurfaces) {
  const QualitySummary q = summarize_quality(filled(icosphere(4), front_alone()));
  EXPECT_GT(q.beta_mean, 0.815);
  EXPECT_LT(static_cast<double>(q.beta_classes[0]), 0.0014 * static_cast<double>(q.elements));
}

TEST(FillVolume, IsTheSameEachTime) {
  const SurfaceMesh s = torus(48, 16);
  EXPECT_EQ(filled(s), filled(s));
}

TEST(FillVolume, ScaleAndPlaceChangeNothingEssential) {
  const SurfaceMesh s = icosphere(3);
  const QualitySummary q = summarize_quality(filled(s, front_alone()));
  const std::array<std::pair<double, Vec3>, 4> clothes{
      {{1e6, {}}, {1e-6, {}}, {1, {1e4, -2e4, 3e4}}, {1e-3, {5, 5, 5}}}};
  for (const auto& [scale, shift] : clothes) {
    SCOPED_TRACE(scale);
    const SurfaceMesh other = transformed(s, scale, shift);
    const TetMesh mesh = filled(other, front_alone());
    expect_laws(mesh, other);
    const QualitySummary p = summarize_quality(mesh);
    EXPECT_NEAR(p.beta_mean, q.beta_mean, 0.01);
    EXPECT_NEAR(static_cast<double>(p.elements), static_cast<double>(q.elements),
                0.03 * static_cast<double>(q.elements));
  }
}

TEST(FillVolume, NumberingOfTheInputChangesNothingEssential) {
  const SurfaceMesh s = torus(48, 16);
  const QualitySummary q = summarize_quality(filled(s, front_alone()));
  const SurfaceMesh other = testing::permuted(s, 3);
  const TetMesh mesh = filled(other, front_alone());
  expect_laws(mesh, other);
  const QualitySummary p = summarize_quality(mesh);
  EXPECT_NEAR(p.beta_mean, q.beta_mean, 0.01);
  EXPECT_NEAR(static_cast<double>(p.elements), static_cast<double>(q.elements), 0.03 * static_cast<double>(q.elements));
}

TEST(FillVolume, NumbersRegionsByBody) {
  // A hollow sphere with a ball in its cavity and a cube beside it: three bodies.
  SurfaceMesh s = joined(hollow_sphere(2, 1, 0.6), icosphere(2, 0.3));
  s = joined(s, transformed(cube(4), 1, {2, 0, 0}));
  const TetMesh mesh = filled(s, SizeField::uniform(0.25), front_alone());
  expect_laws(mesh, s);
  std::array<double, 3> volume{};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    ASSERT_LT(mesh.region[t], 3u);
    volume[mesh.region[t]] +=
        dot(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]), mesh.points[d] - mesh.points[a]) /
        6;
  }
  EXPECT_NEAR(volume[0], enclosed_volume(hollow_sphere(2, 1, 0.6)), 1e-12);
  EXPECT_NEAR(volume[1], enclosed_volume(icosphere(2, 0.3)), 1e-12);
  EXPECT_NEAR(volume[2], 1, 1e-12);
}

/// Cells side by side, regions that touch in edges only, and a sheet that ends inside.
std::vector<SurfaceMesh> complexes() {
  const testing::GridPlanes planes{testing::even_planes(5), testing::even_planes(5), testing::even_planes(5)};
  const auto octant = [](Vec3 c) {
    return std::uint32_t(c.x > 0.5) + 2 * std::uint32_t(c.y > 0.5) + 4 * std::uint32_t(c.z > 0.5);
  };
  return {testing::box_walls(planes, octant),
          testing::box_walls(planes, [](Vec3 c) { return (c.x > 0.5) == (c.y > 0.5) ? 0 : kNone; }),
          testing::box_walls(
              planes, [](Vec3) { return 0; }, [](Vec3 m) { return m.z == 0.5 && m.x > 0.25; })};
}

TEST(FillVolume, FillsAllRegionsOfAComplexAtOnce) {
  for (SurfaceMesh complex : complexes())
    for (const bool with_core : {true, false}) {
      face_lower_regions_behind(complex);
      const TetMesh mesh =
          filled(complex, SizeField::uniform(with_core ? 0.1 : 0.25), with_core ? VolumeOptions{} : front_alone());
      EXPECT_EQ(first_defect(mesh, complex), std::nullopt);
      EXPECT_EQ(mesh.boundary.size() + mesh.interfaces.size(), complex.triangles.size());
    }
}

TEST(FillVolume, FollowsASizeThatVaries) {
  const SurfaceMesh s = cube(24);
  const SizeField sizes = SizeField::from_function(
      [](Vec3 p) {
        const auto to_side = [](double x) { return std::min(x, 1 - x); };
        return 1 / 24.0 + 0.2 * std::max(0.0, std::min({to_side(p.x), to_side(p.y), to_side(p.z)}));
      },
      1 / 24.0, 1);
  const TetMesh mesh = filled(s, sizes, front_alone());
  expect_laws(mesh, s);
  // Edges are as long as wanted, in the mean over all.
  double ratio = 0;
  for (const Tet& t : mesh.tets)
    for (const auto& [i, j] : kTetEdges) {
      const Vec3 p = mesh.points[t[i]], q = mesh.points[t[j]];
      ratio += distance(p, q) / sizes.at((p + q) / 2) / (6.0 * static_cast<double>(mesh.tets.size()));
    }
  EXPECT_NEAR(ratio, 1, 0.12);
}

TEST(FillVolume, StopsWhenAsked) {
  const SurfaceMesh s = icosphere(3);
  const std::atomic<bool> cancel{true};
  RunContext context;
  context.cancel = &cancel;
  StageReport report;
  EXPECT_THROW(fill_volume(s, SizeField::uniform(mean_edge(s)), front_alone(), {context, report}), Cancelled);
}

TEST(FillVolume, RefusesAnEmptySurface) {
  EXPECT_THROW(filled(SurfaceMesh{}, SizeField::uniform(1)), InputError);
}

TEST(FillVolume, EndsOnASurfaceThatCutsItself) {
  // Two spheres that overlap are no clean surface; whatever comes out, the run ends.
  const SurfaceMesh s = joined(icosphere(2), transformed(icosphere(2), 1, {0.7, 0, 0}));
  try {
    filled(s, front_alone());
  } catch (const Error&) {
    SUCCEED();
  }
}

}  // namespace
}  // namespace octafront
