// Bodies and images that go on at the other side of a cell.

#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/image.h>
#include <octafront/validity.h>

#include "support/complexes.h"
#include "support/named_surfaces.h"

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::testing::HasSubstr;

Body ball(const std::string& name, Vec3 center, double radius) {
  return {name, testing::transformed(testing::icosphere(3), radius, center)};
}

IntakeOptions unit_cell(const char* axes) {
  IntakeOptions options;
  options.box = "0,0,0,1,1,1";
  options.repeat = axes;
  return options;
}

Options with_periods(double h, const char* axes) {
  Options options;
  options.size.size = h;
  options.periodic = axes;
  return options;
}

/// Pairs along each axis, which all nodes of both of its faces have.
void expect_all_paired(const TetMesh& mesh) {
  const Box3 box = bounding_box(mesh.points);
  for (std::uint32_t k = 0; k < mesh.periods.size(); ++k) {
    const Vec3 period = mesh.periods[k];
    const int axis = period.x != 0 ? 0 : period.y != 0 ? 1 : 2;
    std::set<VertexIndex> low, high, originals, copies;
    for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
      if (mesh.points[v][axis] == box.lo[axis]) low.insert(v);
      if (mesh.points[v][axis] == box.hi[axis]) high.insert(v);
    }
    for (const auto& [number, copy, original] : mesh.periodic_nodes) {
      if (number != k) continue;
      EXPECT_EQ(mesh.points[original] + period, mesh.points[copy]);
      originals.insert(original), copies.insert(copy);
    }
    EXPECT_EQ(low, originals);
    EXPECT_EQ(high, copies);
  }
}

TEST(Cell, ABallAtACornerIsOneRegionOfEightPieces) {
  const Domain domain = open_domain({ball("ball", {0, 0, 0}, 0.3)}, unit_cell("xyz"));
  EXPECT_THAT(domain.surface.region_names, ::testing::ElementsAre("matrix", "ball"));
  const double volume = enclosed_volume(ball("", {}, 0.3).surface);
  EXPECT_NEAR(domain.volumes[1], volume, 1e-9);
  EXPECT_NEAR(domain.volumes[0], 1 - volume, 1e-9);
  for (const int order : {1, 2}) {
    Options options = with_periods(0.1, "xyz");
    options.order = order;
    const Result r = generate(domain, options);
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    EXPECT_EQ(r.mesh.periods.size(), 3u);
    expect_all_paired(r.mesh);
    EXPECT_EQ(r.report.regions.size(), 2u);
    EXPECT_NEAR(r.report.regions[0].volume + r.report.regions[1].volume, 1, 1e-9);
  }
}

TEST(Cell, BodiesCrossFacesEdgesAndCorners) {
  const std::vector<Body> bodies{ball("face", {0.5, 0.45, 0.02}, 0.15), ball("edge", {1.03, 0.5, 0.96}, 0.2),
                                 ball("corner", {-0.05, 0.98, 0.03}, 0.2), ball("inside", {0.4, 0.6, 0.5}, 0.12)};
  const Domain domain = open_domain(bodies, unit_cell("xyz"));
  ASSERT_EQ(domain.volumes.size(), 5u);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    EXPECT_NEAR(domain.volumes[b + 1], enclosed_volume(bodies[b].surface), 1e-9);
  const Result r = generate(domain, with_periods(0.06, "xyz"));
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  expect_all_paired(r.mesh);
}

TEST(Cell, CutsAlongAxesThatAreNotRepeated) {
  const Domain domain = open_domain({ball("ball", {0.5, 0.5, 0}, 0.3)}, unit_cell("x"));
  EXPECT_NEAR(domain.volumes[1], 0.5 * enclosed_volume(ball("", {}, 0.3).surface), 1e-4);
}

TEST(Cell, AFibreThatIsLongerGoesOnByItself) {
  Body fibre{"fibre", testing::transformed(testing::box(0.3, 0.4, 1.6), 1, {0.35, -0.2, -0.3})};
  std::vector<std::string> notes;
  IntakeOptions options = unit_cell("xyz");
  options.tell = [&](const IntakeNote& note) { notes.push_back(note.text); };
  const Domain domain = open_domain({fibre}, options);
  EXPECT_NEAR(domain.volumes[1], 0.12, 1e-9);
  EXPECT_THAT(notes, ::testing::Contains(HasSubstr("not repeated along z")));
  const Result r = generate(domain, with_periods(0.15, "xyz"));
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  expect_all_paired(r.mesh);
  // A slanted one is continued by its copies, beside which it lies.
  for (Vec3& p : fibre.surface.points) p.x += 0.5 * p.z;
  const Domain slanted = open_domain({fibre}, options);
  EXPECT_NEAR(slanted.volumes[1], 1.6 * 0.12, 1e-9);
}

TEST(Cell, MayBeTheFirstBody) {
  IntakeOptions options = unit_cell("xyz");
  options.box = "first";
  const Domain domain = open_domain({{"resin", testing::cube(2)}, ball("fibre", {0, 0.5, 0.5}, 0.2)}, options);
  EXPECT_THAT(domain.surface.region_names, ::testing::ElementsAre("resin", "fibre"));
  EXPECT_NEAR(domain.volumes[1], enclosed_volume(ball("", {}, 0.2).surface), 1e-9);
}

TEST(Cell, RefusesWhatIsNone) {
  const auto opened = [](const Body& body, const char* box) {
    IntakeOptions options = unit_cell("xyz");
    options.box = box;
    return open_domain({body}, options);
  };
  const Body body = ball("ball", {0.5, 0.5, 0.5}, 0.2);
  for (const char* box : {"0,0,0,1,1", "0,0,0,1,1,0", "a,b,c,d,e,f", "0,0,0,1,1,1,2"})
    EXPECT_THROW(opened(body, box), OptionError) << box;
  IntakeOptions fixed;
  fixed.box = "0,0,0,1,1,1";
  try {
    open_domain({ball("far", {9, 9, 9}, 0.2)}, fixed);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("far: lies outside of the cell"));
  }
}

/// A ball of label 1, and a slab of label 2, in voxels that go on periodically.
Image wrapped_image(std::uint32_t n, Vec3 center, double radius) {
  Image image;
  image.grid.size = {n, n, n};
  std::vector<std::uint8_t> values;
  const auto nearest = [&](double d) { return d - n * std::round(d / n); };
  for (std::uint32_t k = 0; k < n; ++k)
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const Vec3 d{nearest(i - center.x), nearest(j - center.y), nearest(k - center.z)};
        values.push_back(length(d) < radius ? 1 : 2);
      }
  image.values = values;
  return image;
}

TEST(Cell, ImagesGoOnAtTheOtherSide) {
  for (const Vec3 center : {Vec3{0, 0, 0}, {7.5, 0.3, 11.2}}) {
    const Image image = wrapped_image(16, center, 5);
    IntakeOptions intake;
    intake.repeat = "xyz";
    const Domain domain = open_domain(image, intake);
    ASSERT_EQ(domain.volumes.size(), 2u);
    EXPECT_NEAR(domain.volumes[0] + domain.volumes[1], 16 * 16 * 16, 1e-6);
    EXPECT_NEAR(domain.volumes[0], 4.0 / 3 * 3.14159 * 125, 40);
    EXPECT_EQ(domain.surface.region_labels, (std::vector<std::int64_t>{1, 2}));
    const Result r = generate(domain, with_periods(2, "xyz"));
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    expect_all_paired(r.mesh);
    // Surfaces leave the faces of the cell at no narrow angles.
    EXPECT_GT(r.report.quality.dihedral_min, 15);
    EXPECT_GT(r.report.quality.beta_min, 0.3);
  }
}

TEST(Cell, VoxelsByChanceTouchThemselvesAndLeaveHoles) {
  Image image;
  image.grid.size = {9, 8, 7};
  std::vector<std::uint8_t> values;
  unsigned state = 7;
  for (int i = 0; i < 9 * 8 * 7; ++i) {
    state = state * 1664525u + 1013904223u;
    const unsigned r = state >> 16 & 0xff;
    values.push_back(r < 120 ? 0 : r < 190 ? 1 : 2);
  }
  image.values = values;
  for (const char* axes : {"xyz", "y"}) {
    SCOPED_TRACE(axes);
    IntakeOptions intake;
    intake.repeat = axes;
    intake.image.regions.kind = ImageRegions::Kind::kLabels;
    for (const double size : {1.5, 2.5}) {
      const Domain domain = open_domain(image, intake_for(with_periods(size, axes), intake));
      const Result r = generate(domain, with_periods(size, axes));
      EXPECT_EQ(first_defect(r.mesh), std::nullopt);
      expect_all_paired(r.mesh);
    }
  }
}

TEST(Cell, GreyValuesGoOnAtTheOtherSide) {
  constexpr int n = 16;
  Image image;
  image.grid.size = {n, n, n};
  image.grid.axes = {{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}};
  std::vector<float> values;
  const auto angle = [](int i) { return 2 * 3.14159265358979 * i / n; };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        values.push_back(static_cast<float>(std::sin(angle(i)) * std::cos(angle(j)) +
                                            std::sin(angle(j)) * std::cos(angle(k)) +
                                            std::sin(angle(k)) * std::cos(angle(i))));
  image.values = values;
  IntakeOptions intake;
  intake.repeat = "xyz";
  intake.image.regions.bands = {{-0.2, HUGE_VAL, "body"}};
  const Domain domain = open_domain(image, intake);
  const Result r = generate(domain, with_periods(0.8, "xyz"));
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  expect_all_paired(r.mesh);
  // What is above -0.2 of a Gyroid: half of space and .2 of its slope there.
  EXPECT_NEAR(r.report.volume / 512, 0.567, 0.02);
}

}  // namespace
}  // namespace octafront
