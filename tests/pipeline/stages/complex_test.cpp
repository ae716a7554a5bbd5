// Several regions in one mesh, end to end.

#include <octafront/complex.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/complexes.h"
#include "support/faceted.h"
#include "support/labelled_walls.h"
#include "support/named_surfaces.h"
#include "support/nasty_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box_walls;
using testing::even_planes;
using testing::GridPlanes;
using testing::nearest_of;
using testing::rough_walls;
using testing::volume_of_region;

struct ComplexSample {
  std::string name;
  SurfaceMesh complex;
  double size;
};

bool is_between(double x, double lo, double hi) {
  return x > lo && x < hi;
}

/// A box of one region, with a sheet in the middle of it that ends inside.
SurfaceMesh cracked_box() {
  return box_walls(
      {even_planes(7), even_planes(7), even_planes(7)}, [](Vec3) { return 0; },
      [](Vec3 m) { return m.z == 0.5 && is_between(m.x, 0.2, 0.8) && is_between(m.y, 0.2, 0.8); });
}

std::vector<ComplexSample> samples() {
  const GridPlanes even{even_planes(5), even_planes(5), even_planes(5)};
  const auto number = [](bool x, bool y, bool z) {
    return std::uint32_t(x) + 2 * std::uint32_t(y) + 4 * std::uint32_t(z);
  };
  std::vector<ComplexSample> all;
  all.push_back({"two boxes", box_walls(even, [](Vec3 c) { return c.x > 0.5 ? 1u : 0u; }), 0.25});
  all.push_back({"layers",
                 box_walls({even_planes(9), even_planes(9), {0, 0.25, 0.35, 0.4, 0.7, 1}},
                           [](Vec3 c) {
                             return c.z < 0.25 ? 0u : c.z < 0.35 ? 1u : c.z < 0.4 ? 2u : c.z < 0.7 ? 3u : 4u;
                           }),
                 0.2});
  all.push_back(
      {"grid of cells", box_walls(even, [&](Vec3 c) { return number(c.x > 0.5, c.y > 0.5, c.z > 0.5); }), 0.25});
  all.push_back({"box in box",
                 box_walls(even,
                           [](Vec3 c) {
                             const auto in = [](double x) { return is_between(x, 0.25, 0.75); };
                             return in(c.x) && in(c.y) && in(c.z) ? 1u : 0u;
                           }),
                 0.25});
  all.push_back({"touching in an edge",
                 box_walls(even, [](Vec3 c) { return (c.x > 0.5) == (c.y > 0.5) ? std::uint32_t(c.x > 0.5) : kNone; }),
                 0.25});
  all.push_back({"one region touching itself",
                 box_walls(even, [](Vec3 c) { return (c.x > 0.5) == (c.y > 0.5) ? 0u : 1u; }), 0.25});
  all.push_back({"touching in a point",
                 box_walls(even,
                           [](Vec3 c) {
                             const bool x = c.x > 0.5, y = c.y > 0.5, z = c.z > 0.5;
                             return x == y && y == z ? std::uint32_t(x) : kNone;
                           }),
                 0.25});
  all.push_back({"crack", cracked_box(), 0.2});
  all.push_back({"foam", rough_walls(6, nearest_of(12, 1), 1), 0.2});
  return all;
}

Options keeping(double h) {
  Options o;
  o.size.size = h;
  o.surface.keep = true;
  return o;
}

void expect_complex(const Result& r, const SurfaceMesh& complex) {
  EXPECT_EQ(first_defect(r.mesh, complex), std::nullopt);
  ASSERT_LE(r.report.regions.size(), 100u);
  for (std::uint32_t region = 0; region < r.report.regions.size(); ++region)
    EXPECT_NEAR(r.report.regions[region].volume, volume_of_region(complex, region), 1e-12);
}

TEST(Complex, EveryRegionIsFilledWithItsTrianglesKept) {
  for (const ComplexSample& s : samples()) {
    SCOPED_TRACE(s.name);
    expect_complex(generate(s.complex, keeping(s.size)), s.complex);
  }
}

TEST(Complex, RecoveryAloneFillsEveryRegion) {
  for (const ComplexSample& s : samples()) {
    SCOPED_TRACE(s.name);
    Options o = keeping(s.size);
    o.method = Method::kRecover;
    expect_complex(generate(s.complex, o), s.complex);
  }
}

TEST(Complex, WhichWayTrianglesFaceDoesNotMatter) {
  for (const ComplexSample& s : samples()) {
    SCOPED_TRACE(s.name);
    expect_complex(generate(testing::shuffled(s.complex, 3), keeping(s.size)), s.complex);
  }
}

TEST(Complex, PatchesAreTriangulatedAnewAndFit) {
  for (const ComplexSample& s : samples()) {
    SCOPED_TRACE(s.name);
    Options o;
    o.size.size = 0.12;
    const Result r = generate(s.complex, o);
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    for (std::uint32_t region = 0; region < r.report.regions.size(); ++region)
      EXPECT_NEAR(r.report.regions[region].volume, volume_of_region(s.complex, region),
                  s.name == "foam" ? 2e-2 : 1e-12);
  }
}

/// Their shortest edges are .01 and .03 of the size. With mirror images of walls as backs, angles were .2 degrees.
TEST(Complex, TinyEdgesOfFoamsMakeNoFlatElements) {
  for (const auto& [cells, seed] : {std::pair{35, 2}, {51, 4}}) {
    const testing::KnownComplex foam = testing::foam(cells, static_cast<std::uint64_t>(seed));
    SCOPED_TRACE(foam.name);
    Options o;
    o.size.size = 0.2;
    const Result r = generate(foam.surface, o);
    EXPECT_GT(r.report.quality.beta_min, 0.05);
    EXPECT_GT(r.report.quality.dihedral_min, 5);
    EXPECT_LT(r.report.quality.dihedral_max, 165);
    for (std::size_t region = 0; region < foam.volumes.size(); ++region)
      EXPECT_NEAR(r.report.regions[region].volume, foam.volumes[region], 1e-12);
  }
}

/// Chords across the edges of facets stray at many places at first: 8,267 elements of 1.6 degrees of the facets as they
/// were.
TEST(Complex, CoarseFacetsAreNotNoise) {
  for (const int sides : {16, 24}) {
    SCOPED_TRACE(sides);
    const Complex complex = join_bodies(
        {{"low", testing::faceted_pin(sides, 1, 0, 1)}, {"high", testing::faceted_pin(sides + 3, .8, 1, 2.2)}});
    const Result r = generate(complex.surface, {});
    EXPECT_GT(r.report.quality.dihedral_min, 20);
    for (const StageReport& stage : r.report.stages)
      for (const std::string& note : stage.notes) EXPECT_EQ(note.find("noise"), std::string::npos) << note;
  }
}

/// A cube of a hundredth of the size, amid its neighbours: only what lies around it gets small.
TEST(Complex, SizesRiseSteeplyFromTinyWalls) {
  const std::vector<double> even = even_planes(5), near{0, 0.25, 0.5, 0.5025, 0.75, 1};
  const auto elements = [](const std::vector<double>& planes, double upper) {
    const auto in = [=](double x) { return is_between(x, 0.5, upper); };
    const SurfaceMesh complex =
        box_walls({planes, planes, planes}, [&](Vec3 c) { return in(c.x) && in(c.y) && in(c.z) ? 1u : 0u; });
    Options o;
    o.size.size = 0.25;
    const Result r = generate(complex, o);
    EXPECT_GT(r.report.quality.beta_min, 0.2);
    return r.mesh.tets.size();
  };
  EXPECT_LT(elements(near, 0.5025), 20 * elements(even, 0.75));
}

TEST(Complex, PatchesAndCurvesHaveNames) {
  SurfaceMesh two = samples()[0].complex;
  two.region_names = {"bone", "skin"};
  const Result r = generate(two, keeping(0.25));
  EXPECT_EQ(r.mesh.region_names, two.region_names);
  const std::set<std::string> names(r.mesh.patch_names.begin(), r.mesh.patch_names.end());
  EXPECT_EQ(names, (std::set<std::string>{"bone", "skin", "bone|skin"}));
  ASSERT_EQ(r.mesh.curve_names.size(), 1u);
  std::vector<std::string> parts{"bone", "skin", "bone|skin"};
  std::string name;
  std::sort(parts.begin(), parts.end(), [&](const std::string& a, const std::string& b) {
    const auto& all = r.mesh.patch_names;
    return std::find(all.begin(), all.end(), a) < std::find(all.begin(), all.end(), b);
  });
  for (const std::string& part : parts) name += (name.empty() ? "" : " + ") + part;
  EXPECT_EQ(r.mesh.curve_names[0], name);
}

TEST(Complex, SizesByNameHoldWhereTheyAreAsked) {
  SurfaceMesh two = samples()[0].complex;
  two.region_names = {"bone", "skin"};
  Options o;
  o.size.size = 0.2;
  const auto tets_of = [&] {
    const Result r = generate(two, o);
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    return std::array{r.report.regions[0].quality.elements, r.report.regions[1].quality.elements};
  };
  const auto even = tets_of();
  o.size.named = {{"skin", 0.1}};
  const auto fine = tets_of();
  EXPECT_GT(fine[1], 5 * even[1]);
  EXPECT_LT(static_cast<double>(fine[0]) / fine[1], 0.8 * even[0] / even[1]) << "growing from what they share";
  o.size.named = {{"bone|skin", 0.1}};
  const auto between = tets_of();
  EXPECT_GT(between[0] + between[1], even[0] + even[1]);
  EXPECT_LT(between[1], fine[1]);
  o.size.named = {{"flesh", 0.1}};
  EXPECT_THROW(generate(two, o), OptionError);
}

TEST(Complex, TheSameBitsOnAnyNumberOfThreads) {
  const ComplexSample foam = samples().back();
  Options o;
  o.size.size = 0.08;
  RunContext context;
  context.threads = 1;
  const std::uint64_t one = generate(foam.complex, o, context).report.hash;
  context.threads = 3;
  EXPECT_EQ(generate(foam.complex, o, context).report.hash, one);
}

TEST(Complex, WhatIsNotCleanIsRefusedWithPlaces) {
  const SurfaceMesh good = samples()[0].complex;
  const auto words_of = [](const SurfaceMesh& bad) -> std::string {
    try {
      generate(bad, keeping(0.25));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  SurfaceMesh leaking = good;
  const auto inner = std::find_if(leaking.sides.begin(), leaking.sides.end(),
                                  [](const Sides& s) { return s[0] != kNone && s[1] != kNone; });
  const auto k = inner - leaking.sides.begin();
  leaking.sides.erase(inner);
  leaking.triangles.erase(leaking.triangles.begin() + k);
  EXPECT_NE(words_of(leaking).find("regions of the faces do not agree"), std::string::npos) << words_of(leaking);
  SurfaceMesh wrong = good;
  wrong.sides[0] = {5, 6};
  EXPECT_NE(words_of(wrong).find("regions of the faces do not agree"), std::string::npos) << words_of(wrong);
  SurfaceMesh floating = good;
  const SurfaceMesh ball = testing::transformed(testing::icosphere(1), 0.1, {0.25, 0.5, 0.5});
  const auto first = static_cast<VertexIndex>(floating.points.size());
  floating.points.insert(floating.points.end(), ball.points.begin(), ball.points.end());
  for (const Triangle& t : ball.triangles) {
    floating.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    floating.sides.push_back({kNone, 2});
  }
  EXPECT_NE(words_of(floating).find("in another region than"), std::string::npos) << words_of(floating);
  for (std::size_t t = good.sides.size(); t < floating.sides.size(); ++t) floating.sides[t] = {0, 2};
  EXPECT_EQ(words_of(floating), "");
}

/// Corners do not tell which lies in which: all corners of a part may be those of others.
TEST(Complex, PartsThatTouchOthersWithAllTheirCornersAreClean) {
  const SurfaceMesh walls = rough_walls(6, nearest_of(5, 4003), 4003);
  expect_complex(generate(walls, keeping(0.25)), walls);
}

double volume_of(const TetMesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c, d] : mesh.tets) {
    const Vec3 p = mesh.points[a];
    six += dot(mesh.points[b] - p, cross(mesh.points[c] - p, mesh.points[d] - p));
  }
  return six / 6;
}

/// Turned about no axis of the grid, and scaled.
SurfaceMesh turned_and_scaled(SurfaceMesh surface, double scale) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  for (Vec3& p : surface.points) {
    p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    p = scale * Vec3{p.x, c * p.y - s * p.z, s * p.y + c * p.z};
  }
  return surface;
}

TEST(Complex, WhatTouchesItselfKeepsItsVolumeAndHasNoNamesOfItsOwn) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(seed);
    const double scale = seed == 3 ? 1e4 : 1;
    const SurfaceMesh walls = turned_and_scaled(
        testing::random_voxels(4, 0.3 * static_cast<double>(seed), 0, testing::Pinches::kKept, seed), scale);
    const auto complex = complex_of_walls(walls);
    ASSERT_TRUE(complex);
    for (const bool kept : {true, false}) {
      Options options;
      options.surface.keep = kept;
      if (!kept) options.size.size = scale;
      const Result r = generate(complex->surface, options);
      EXPECT_EQ(first_defect(r.mesh), std::nullopt);
      EXPECT_NEAR(volume_of(r.mesh) / enclosed_volume(walls), 1, 1e-9);
      EXPECT_EQ(r.report.regions.size(), 1U);
      for (const std::string& name : r.mesh.patch_names)
        EXPECT_NE(name, "body") << "of a plain body patches have no names";
    }
  }
}

/// A torus without a hole: its tube touches itself in the middle, where its inner ring is one vertex.
SurfaceMesh pinched_torus(std::uint32_t around, std::uint32_t along_tube) {
  SurfaceMesh torus;
  torus.points.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t k = 1; k < along_tube; ++k) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * k / along_tube;
      torus.points.push_back({(1 - std::cos(b)) * std::cos(a), (1 - std::cos(b)) * std::sin(a), -std::sin(b)});
    }
  const auto at = [&](std::uint32_t i, std::uint32_t k) {
    return k % along_tube == 0 ? 0 : 1 + (i % around) * (along_tube - 1) + k - 1;
  };
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t k = 0; k < along_tube; ++k) {
      const VertexIndex a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
      if (k > 0) torus.triangles.push_back({a, b, c});
      if (k + 1 < along_tube) torus.triangles.push_back({a, c, d});
    }
  return torus;
}

TEST(Complex, ATorusThatIsPinchedInAVertexIsMeshedAsItIs) {
  const SurfaceMesh torus = pinched_torus(24, 16);
  const auto complex = complex_of_walls(torus);
  ASSERT_TRUE(complex);
  for (const bool kept : {true, false}) {
    Options options;
    options.surface.keep = kept;
    options.size.size = 0.25;
    const Result r = generate(complex->surface, options);
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    EXPECT_NEAR(volume_of(r.mesh) / enclosed_volume(torus), 1, kept ? 1e-9 : 0.01);
    EXPECT_EQ(r.report.regions.size(), 1U);
    EXPECT_GT(r.report.quality.dihedral_min, kept ? 2 : 15);
  }
}

TEST(Complex, OtherMethodsSayThatTheyFillOneRegion) {
  for (const Method method : {Method::kAft, Method::kOctree}) {
    Options o;
    o.method = method;
    EXPECT_THROW(generate(samples()[0].complex, o), OptionError);
  }
}

TEST(Complex, SecondOrderKeepsEveryRegion) {
  Options o = keeping(0.25);
  o.order = 2;
  for (const ComplexSample& s : samples()) {
    SCOPED_TRACE(s.name);
    EXPECT_EQ(first_defect(generate(s.complex, o).mesh), std::nullopt);
  }
}

}  // namespace
}  // namespace octafront
