// Bodies by formulas: their volumes, areas and faces.

#include <octafront/error.h>
#include <octafront/formula.h>
#include <octafront/generate.h>
#include <octafront/surface_mesh.h>
#include <octafront/validity.h>

#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

IntakeOptions in_box(Box3 box, std::uint32_t resolution, double cell = 1) {
  IntakeOptions options;
  options.box = fmt::format("{},{},{},{},{},{}", box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z);
  options.formula = {cell, resolution};
  return options;
}

const Box3 kAround{{-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}};

struct Measures {
  double volume, area;
};

Measures measured(const Domain& domain) {
  return {std::abs(enclosed_volume(domain.surface)), area(domain.surface)};
}

TEST(OpenFormula, ErrorsOfASphereFallWithTheSquareOfTheCells) {
  const double volume = 4 * std::numbers::pi / 3, whole = 4 * std::numbers::pi;
  Measures before{};
  for (const std::uint32_t n : {16u, 32u, 64u}) {
    const Measures m = measured(open_formula("hypot(x, y, z) - 1", in_box(kAround, n)));
    const Measures error{std::abs(m.volume - volume) / volume, std::abs(m.area - whole) / whole};
    if (n > 16) {
      EXPECT_NEAR(before.volume / error.volume, 4, 1) << n;
      EXPECT_NEAR(before.area / error.area, 4, 1) << n;
    }
    before = error;
  }
  EXPECT_LT(before.volume, 1.5e-3);
}

TEST(OpenFormula, SamplesComeAsNear) {
  for (const std::uint32_t n : {16u, 32u}) {
    SampledFunction samples{kAround, {n, n, n}, {}};
    const double h = 2.6 / n;
    for (std::uint32_t k = 0; k < n + 2; ++k)
      for (std::uint32_t j = 0; j < n + 2; ++j)
        for (std::uint32_t i = 0; i < n + 2; ++i) {
          const Vec3 p{-1.3 + (i - 0.5) * h, -1.3 + (j - 0.5) * h, -1.3 + (k - 0.5) * h};
          samples.values.push_back(length(p) - 1);
        }
    const Measures by_samples = measured(open_samples(samples));
    const Measures by_formula = measured(open_formula("hypot(x, y, z) - 1", in_box(kAround, n)));
    EXPECT_NEAR(by_samples.volume, by_formula.volume, 2e-3 * by_formula.volume);
    EXPECT_NEAR(by_samples.area, by_formula.area, 2e-3 * by_formula.area);
  }
}

TEST(OpenFormula, VerticesLieOnTheSurfaceOrOnTheBoxExactly) {
  const Domain domain = open_formula("gyroid - 0.3", in_box({{0, 0, 0}, {2, 2, 2}}, 40, 2));
  const Formula f("gyroid - 0.3", 2);
  std::set<std::uint32_t> patches;
  std::size_t on = 0, off = 0;
  for (std::size_t t = 0; t < domain.surface.triangles.size(); ++t) {
    const std::uint32_t patch = domain.surface.patch_of(t);
    patches.insert(patch);
    for (const VertexIndex v : domain.surface.triangles[t]) {
      const Vec3 p = domain.surface.points[v];
      if (patch == 0) {
        const bool is_on_box = std::min({p.x, p.y, p.z}) == 0 || std::max({p.x, p.y, p.z}) == 2;
        if (!is_on_box) ++(std::abs(f.at(p)) < 1e-9 ? on : off);
      } else {
        EXPECT_EQ(p[static_cast<int>((patch - 1) / 2)], patch % 2 == 1 ? 0 : 2);
      }
    }
  }
  EXPECT_GT(on, 10'000u);
  // Where triangles would have crossed or met in sharp wedges some stay beside it until the mesh is made.
  EXPECT_LT(off, on / 5);
  EXPECT_EQ(patches.size(), 7u);
  EXPECT_EQ(domain.surface.patch_names.at(0), "surface");
  EXPECT_EQ(domain.surface.patch_names.at(6), "z_max");
}

TEST(OpenFormula, KnownPartsOfTheCellAreFilled) {
  // By symmetry the Gyroid and Schwarz' P and D halve their cells.
  for (const char* half : {"gyroid", "schwarz_p", "diamond"})
    EXPECT_NEAR(measured(open_formula(half, in_box({{0, 0, 0}, {1, 1, 1}}, 48))).volume, 0.5, 1e-3) << half;
  // The torus: 2 pi^2 R r^2.
  const double torus = 2 * std::numbers::pi * std::numbers::pi * 0.8 * 0.09;
  EXPECT_NEAR(measured(open_formula("hypot(hypot(x, y) - .8, z) - .3", in_box(kAround, 80))).volume, torus,
              4e-3 * torus);
  // A box by its distances: flat sides of any direction are exact, edges are not.
  EXPECT_NEAR(measured(open_formula("max(abs(x), abs(y), abs(z)) - 1", in_box(kAround, 52))).volume, 8, 0.05);
  // A half space; where it ends at the box the surface lies within half a cell.
  EXPECT_NEAR(measured(open_formula("x + y < .2", in_box({{0, 0, 0}, {1, 1, 1}}, 20))).volume, 0.02, 1.5e-3);
}

TEST(OpenFormula, IsMeshedWithItsNodesOnTheSurface) {
  const Domain domain = open_formula("gyroid - 0.3", in_box({{0, 0, 0}, {1, 1, 1}}, 32));
  Options options;
  options.size.size = 0.08;
  const Result made = generate(domain, options);
  EXPECT_FALSE(first_defect(made.mesh));
  const Formula f("gyroid - 0.3");
  std::size_t on = 0, off = 0;
  for (std::size_t t = 0; t < made.mesh.boundary.size(); ++t)
    if (made.mesh.patch[t] == 0)
      for (const VertexIndex v : made.mesh.boundary[t]) (std::abs(f.at(made.mesh.points[v])) < 1e-9 ? on : off) += 1;
  EXPECT_GT(on, 1000u);
  EXPECT_LT(off, on / 100);
}

TEST(OpenFormula, OnePeriodOfEachNamedSurfaceMeshesPeriodically) {
  IntakeOptions options;
  options.formula.resolution = 24;
  options.repeat = "xyz";
  Options how;
  how.size.size = 0.12;
  how.periodic = "xyz";
  for (const char* formula : {"gyroid", "abs(gyroid) < 0.5", "schwarz_p", "diamond", "iwp(x,y,z) - 0.5", "neovius"}) {
    SCOPED_TRACE(formula);
    const TetMesh mesh = generate(open_formula(formula, options), how).mesh;
    EXPECT_EQ(first_defect(mesh), std::nullopt);
    ASSERT_EQ(mesh.periods.size(), 3u);
    std::array<std::size_t, 3> pairs{};
    for (const auto& [period, copy, original] : mesh.periodic_nodes) {
      EXPECT_EQ(mesh.points[copy], mesh.points[original] + mesh.periods[period]);
      ++pairs[period];
    }
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(pairs[static_cast<std::size_t>(axis)],
                static_cast<std::size_t>(
                    std::count_if(mesh.points.begin(), mesh.points.end(), [&](Vec3 p) { return p[axis] == 1; })));
  }
}

TEST(OpenFormula, APeriodThatTheFormulaHasNotIsRefused) {
  IntakeOptions options = in_box({{0, 0, 0}, {1, 1.5, 1}}, 24);
  options.repeat = "y";
  EXPECT_THROW(open_formula("gyroid", options), InputError);
}

TEST(OpenFormula, RefusesWhatIsNoBody) {
  const Box3 unit{{0, 0, 0}, {1, 1, 1}};
  const auto message = [](const auto& work) -> std::string {
    try {
      work();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([&] { open_formula("x + 1", in_box(unit, 16)); }).find("nowhere below 0"), std::string::npos);
  EXPECT_NE(message([&] { open_formula("sqrt(x - .5)", in_box(unit, 16)); }).find("no value at"), std::string::npos);
  EXPECT_NE(message([&] { open_formula("x - .5"); }).find("`box`"), std::string::npos);
  EXPECT_NE(message([&] {
              open_formula("x - .5", in_box({{0, 0, 0}, {1, 0, 1}}, 16));
            }).find("`box`"),
            std::string::npos);
  EXPECT_NE(message([&] {
              open_formula("gyroid", in_box({{0, 0, 0}, {1, 1, 1}}, 2));
            }).find("resolution"),
            std::string::npos);
  EXPECT_NE(message([&] {
              open_formula("gyroid", in_box({{0, 0, 0}, {1, 1, 1}}, 100'000));
            }).find("`resolution`"),
            std::string::npos);
  EXPECT_NE(message([&] { open_domain("no_such.stl", in_box(unit, 16)); }).find("`cell`"), std::string::npos);
  SampledFunction few{unit, {8, 8, 8}, std::vector<double>(7)};
  EXPECT_NE(message([&] { open_samples(few); }).find("samples"), std::string::npos);
}

}  // namespace
}  // namespace octafront
