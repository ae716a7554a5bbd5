// What an input becomes on the way in, and what is said of it.

#include "doors/intake/intake.h"

#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/io.h>
#include <octafront/option_table.h>
#include <octafront/options.h>
#include <octafront/repair.h>
#include <octafront/units.h>

#include "support/named_surfaces.h"
#include "support/random.h"
#include "support/test_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::cube;
using testing::transformed;

SurfaceMesh without_triangle(SurfaceMesh surface, int t) {
  surface.triangles.erase(surface.triangles.begin() + t);
  if (!surface.patch.empty()) surface.patch.erase(surface.patch.begin() + t);
  return surface;
}

/// Whether a note of a stage has these words.
bool says(const Domain& domain, const std::string& stage, const std::string& words) {
  return std::any_of(domain.notes.begin(), domain.notes.end(),
                     [&](const IntakeNote& n) { return n.stage == stage && n.text.find(words) != std::string::npos; });
}

using Intake = testing::InItsFolder;

TEST_F(Intake, ACleanSurfaceStaysAsItIs) {
  const SurfaceMesh clean = testing::icosphere(2);
  const Domain domain = open_domain(clean);
  EXPECT_EQ(domain.surface.triangles, clean.triangles);
  EXPECT_TRUE(domain.bound.empty() && domain.notes.empty() && domain.volumes.empty());
  ASSERT_EQ(domain.repairs.size(), 1u);
  EXPECT_TRUE(domain.repairs[0].report.clean);
}

TEST_F(Intake, ASoupIsMendedUnlessItShallNotBe) {
  const SurfaceMesh open = without_triangle(cube(2), 5);
  const Domain mended = open_domain(open);
  EXPECT_NEAR(enclosed_volume(mended.surface), 1, 1e-12);
  EXPECT_TRUE(says(mended, "repair", "closed"));
  EXPECT_NE(to_json(mended).find("\"repair\":{\"clean\":false"), std::string::npos) << to_json(mended);
  const Domain again = open_domain(mended);
  EXPECT_EQ(again.surface.triangles, mended.surface.triangles);
  EXPECT_EQ(again.bound, mended.bound);
  IntakeOptions off;
  off.repair = IntakeOptions::Repair::kOff;
  EXPECT_EQ(open_domain(open, off).surface.triangles, open.triangles);
  IntakeOptions wrap;
  wrap.repair = IntakeOptions::Repair::kWrap;
  wrap.wrap_distance = 0.1;
  EXPECT_GT(enclosed_volume(open_domain(cube(2), wrap).surface), 1.3);
}

TEST_F(Intake, WhatOnlyNeedsTidyingIsLeftToTheMesherUnlessAskedFor) {
  SurfaceMesh turned = cube(1);
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  turned.patch.clear();
  EXPECT_EQ(open_domain(turned).surface.triangles, turned.triangles);
  IntakeOptions tidy;
  tidy.tidies = true;
  EXPECT_NEAR(enclosed_volume(open_domain(turned, tidy).surface), 1, 1e-12);
}

TEST_F(Intake, SeveralFilesAreBodiesNamedByThem) {
  const std::string plate = file("part.stl", cube(1)), pin = file("pin.ply", transformed(cube(1), 1, {1, 0, 0}));
  const Domain domain =
      open_domain({plate, pin, file("open.off", without_triangle(transformed(cube(2), 1, {2, 0, 0}), 0))});
  EXPECT_EQ(domain.surface.region_names, (std::vector<std::string>{"part", "pin", "open"}));
  ASSERT_EQ(domain.volumes.size(), 3u);
  for (const double volume : domain.volumes) EXPECT_NEAR(volume, 1, 1e-12);
  EXPECT_EQ(domain.format, "several files");
  ASSERT_EQ(domain.repairs.size(), 3u);
  EXPECT_EQ(domain.repairs[0].of, plate);
  EXPECT_FALSE(domain.repairs[2].report.clean);
  // Files of one name, and the same of arrays.
  EXPECT_EQ(open_domain({plate, file("part.off", transformed(cube(1), 1, {1, 0, 0}))}).surface.region_names[1],
            "part_2");
  const Domain arrays = open_domain(std::vector<Body>{{"a", cube(1)}, {"b", transformed(cube(1), 1, {1, 0, 0})}});
  EXPECT_EQ(arrays.surface.region_names, (std::vector<std::string>{"a", "b"}));
}

TEST_F(Intake, WallsMakeRegionsAndPartsMayKeepTheirNames) {
  SurfaceMesh walls = testing::joined(cube(1), transformed(cube(1), 1, {1, 0, 0}));
  walls.patch.clear();
  IntakeOptions seeded;
  seeded.complex.regions = {{"left", {0.5, 0.5, 0.5}}};
  const Domain cells = open_domain(walls, seeded);
  EXPECT_EQ(std::count(cells.surface.region_names.begin(), cells.surface.region_names.end(), "left"), 1);
  IntakeOptions apart;
  apart.complex.overlap = ComplexOptions::Overlap::kLater;
  EXPECT_THROW(open_domain(walls, apart), InputError) << "parts without names";
  walls.patch.assign(12, 0);
  walls.patch.insert(walls.patch.end(), 12, 1);
  walls.patch_names = {"one", "two"};
  EXPECT_EQ(open_domain(walls, apart).surface.region_names, walls.patch_names);
}

TEST_F(Intake, AnImageIsOneOfItsRegionsAndKnowsItsVoxels) {
  Image image;
  image.grid.size = {12, 10, 8};
  image.grid.axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 0.5}}};
  std::vector<std::uint8_t> values(image.grid.voxels(), 0);
  for (std::uint32_t k = 2; k < 6; ++k)
    for (std::uint32_t j = 2; j < 8; ++j)
      for (std::uint32_t i = 2; i < 10; ++i) values[i + 12 * (j + 10 * k)] = i < 6 ? 1 : 3;
  image.values = values;
  image.notes = {"of a reader"};
  IntakeOptions options;
  options.image.regions.labels.names = {{3, "right"}};
  const Domain domain = open_domain(image, options);
  EXPECT_EQ(domain.surface.region_names, (std::vector<std::string>{"label 1", "right"}));
  EXPECT_EQ(domain.voxel_spacing, 0.5);
  EXPECT_EQ(domain.found_clean, fingerprint(domain.surface));
  EXPECT_TRUE(find_defects(repair_surface(domain.surface)).clean());
  EXPECT_TRUE(says(domain, "reading", "of a reader"));
  options.image.crop[0].last = 5;
  options.image.resample = {1};
  const Domain part = open_domain(image, options);
  EXPECT_EQ(part.voxels, (std::array<std::uint32_t, 3>{6, 10, 4}));
  EXPECT_EQ(part.voxel_spacing, 1);
  EXPECT_EQ(part.volumes.size(), 1u);
  double cut = 0;  // 6 x 4 voxels of 1 x .5
  for (std::size_t t = 0; t < part.surface.triangles.size(); ++t) {
    const auto& [a, b, c] = part.surface.triangles[t];
    const auto& p = part.surface.points;
    if (part.surface.patch_names[part.surface.patch[t]] == "box_i1") cut += length(cross(p[b] - p[a], p[c] - p[a])) / 2;
  }
  EXPECT_NEAR(cut, 6 * 4 * .5, 2);  // smoothed
  EXPECT_EQ(part.surface.patch_names, (std::vector<std::string>{"label 1", "box_i1"}));
  EXPECT_TRUE(domain.surface.patch.empty());  // nothing reaches the edge
  options.image.resample = {1, 2};
  EXPECT_THROW(open_domain(image, options), OptionError);
}

/// Values from 0 to 99 that say nothing of their neighbours; or a ramp along i.
Image grey_cube(std::uint32_t n, bool is_noise) {
  Image image;
  image.grid.size = {n, n, n};
  std::vector<float> values;
  testing::Random random(7);
  for (std::uint32_t v = 0; v < n * n * n; ++v)
    values.push_back(static_cast<float>(is_noise ? 100 * random.unit() : 100.0 * (v % n) / n));
  image.values = values;
  return image;
}

TEST_F(Intake, BandsOfNoiseThatNoBudgetHoldsComeFromCoarserVoxels) {
  IntakeOptions options;
  options.image.regions.bands = {{0, 40, "low"}, {40, HUGE_VAL, "high"}};
  options.image.most_elements = 20000;
  const Domain domain = open_domain(grey_cube(24, true), options);
  EXPECT_LT(domain.voxels[0], 24u);
  EXPECT_LT(domain.surface.triangles.size(), 8000u);
  EXPECT_TRUE(says(domain, "resampling", "a voxel thick")) << "with the volume that changed most";
  EXPECT_TRUE(says(domain, "resampling", "That changes the volume of \"low\" by -"));
  EXPECT_EQ(open_domain(grey_cube(24, false), options).voxels[0], 24u) << "not thin";
  options.image.resample = {1};
  EXPECT_EQ(open_domain(grey_cube(24, true), options).voxels[0], 24u) << "asked for";
}

TEST_F(Intake, BandsOfNoiseComeFromVoxelsNoLargerThanTheSizeThatIsGiven) {
  IntakeOptions options;
  options.image.regions.bands = {{0, 40, "low"}, {40, HUGE_VAL, "high"}};
  options.image.size = 3;
  const Domain domain = open_domain(grey_cube(24, true), options);
  EXPECT_LT(domain.voxels[0], 24u);
  EXPECT_GE(domain.voxels[0], 8u);
  EXPECT_TRUE(says(domain, "resampling", "the size asks for"));
  EXPECT_EQ(open_domain(grey_cube(24, false), options).voxels[0], 24u) << "not thin";
  options.image.size = 0.9;
  EXPECT_EQ(open_domain(grey_cube(24, true), options).voxels[0], 24u) << "smaller than voxels";
}

TEST_F(Intake, SpecksOfBandsGoWhereASizeIsGiven) {
  Image image = grey_cube(24, false);  // a ramp
  auto& values = std::get<std::vector<float>>(image.values);
  const std::size_t in_low = 6 + 24 * (12 + 24 * 12);
  values[in_low] = 90;
  IntakeOptions options;
  options.image.regions.bands = {{-HUGE_VAL, 60, "low"}, {60, HUGE_VAL, "high"}};
  EXPECT_FALSE(says(open_domain(image, options), "regions", "specks"));
  options.image.size = 4;
  EXPECT_TRUE(says(open_domain(image, options), "regions", "\"high\" 1 (1 voxel)"));
  options.image.specks = 0;
  EXPECT_FALSE(says(open_domain(image, options), "regions", "specks"));
}

TEST_F(Intake, ANetOfNoiseIsKeptBeforeAnyRoundWhereTheBudgetIsSpent) {
  Options options;
  options.size.automatic_factor = 4;
  IntakeOptions all;
  all.image.regions.bands = {{40, HUGE_VAL, "high"}};
  all.image.resample = {1};
  const Domain domain = open_domain(grey_cube(24, true), intake_for(options, all));
  const SurfaceResult result = generate_surface(domain, options);
  const std::vector<std::string>& notes = result.report.stages.back().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& n) {
    return n.find("no triangles but its own follow such noise") != std::string::npos;
  }));
  EXPECT_EQ(result.surface.triangles.size(), domain.surface.triangles.size());
  const auto& counters = result.report.stages.back().counters;
  EXPECT_TRUE(std::none_of(counters.begin(), counters.end(),
                           [](const auto& c) { return c.first == "rounds" && c.second > 0; }));
}

TEST_F(Intake, OnlyAutomaticSizesHaveABudgetForVoxels) {
  Options options;
  EXPECT_EQ(intake_for(options).image.most_elements, 1.5e6);
  options.surface.max_deviation = 0.1;
  EXPECT_EQ(intake_for(options).image.most_elements, HUGE_VAL);
  options.surface.max_deviation.reset();
  options.size.size = 1;
  EXPECT_EQ(intake_for(options).image.most_elements, HUGE_VAL);
}

TEST_F(Intake, RefusalsSayWhatAndWhere) {
  const auto refusal = [](const std::vector<std::string>& files, const IntakeOptions& options) {
    try {
      open_domain(files, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  SurfaceMesh sheet = cube(1);
  sheet.triangles.resize(2), sheet.patch.clear();
  const std::string lone = file("sheet.off", sheet), whole = file("cube.off", cube(1));
  EXPECT_EQ(refusal({lone}, {}).find(lone + ": "), 0u);
  EXPECT_EQ(refusal({whole, lone}, {}).find(lone + ": "), 0u) << "the file at fault, not the first one";
  IntakeOptions banded;
  banded.image.regions.bands = {{0, 1, "low"}};
  EXPECT_NE(refusal({whole}, banded).find("`band` is for images, and " + whole), std::string::npos);
  EXPECT_THROW(open_domain(cube(1), banded), OptionError);
  EXPECT_THROW(open_domain(SurfaceMesh{}), InputError);
  EXPECT_THROW(open_domain(std::vector<std::string>{}), OptionError);
}

TEST_F(Intake, SizesOfTheMeshGoToTheWayInUnlessThatHasItsOwn) {
  Options options;
  options.size.size = 2;
  options.size.named = {{"fillet", 0.5}};
  EXPECT_EQ(intake_for(options).cad.size, 2);
  EXPECT_EQ(intake_for(options).cad.apart, std::vector<std::string>{"fillet"});
  options.size.elements = 1000;
  EXPECT_EQ(intake_for(options).cad.elements, 1000);
  EXPECT_FALSE(intake_for(options).cad.size) << "sizes are scaled to meet the number";
  IntakeOptions own;
  own.cad.size = 3;
  EXPECT_EQ(intake_for(options, own).cad.size, 3);
  EXPECT_FALSE(intake_for(options, own).cad.elements);
}

TEST_F(Intake, ContactsAreOfLabelsAndOfParts) {
  IntakeOptions options;
  options.contacts = "2.5,split";
  std::ofstream(folder_ / "rules.txt") << "# none\n\nlow=shared\n";
  options.contact = "a|b=c=separate;" + (folder_ / "rules.txt").string();
  const auto [of_labels, of_parts] = intake::contacts_asked(options);
  EXPECT_EQ(of_labels, "2.5");
  EXPECT_EQ(of_parts.all, ContactWay::kSplit);
  ASSERT_EQ(of_parts.rules.size(), 2U);
  EXPECT_EQ(of_parts.rules[0].contact, "a|b=c");
  EXPECT_EQ(of_parts.rules[0].way, ContactWay::kSeparate);
  EXPECT_EQ(of_parts.rules[1].contact, "low");
  options.contact = "a|b=glued";
  EXPECT_THROW(intake::contacts_asked(options), OptionError);
  options = {}, options.contacts = "keep";
  EXPECT_THROW(open_domain(cube(2), options), OptionError) << "of images only";
}

TEST_F(Intake, UnitsOfCadAreThoseOfLength) {
  std::size_t choices = 0;
  for (const OptionInfo& info : intake_table())
    if (info.name == "cad_unit") choices = info.choices.size();
  EXPECT_EQ(choices, length_units().size());
  IntakeOptions options;
  for (const LengthUnit& unit : length_units()) {
    set_option(options, "cad_unit", std::string(unit.name));
    EXPECT_EQ(options.cad.unit, unit.name);
  }
}

TEST_F(Intake, NotesAreToldAsTheyCome) {
  std::vector<std::string> told;
  IntakeOptions options;
  options.tell = [&](const IntakeNote& n) { told.push_back(n.stage + "|" + n.text); };
  const std::string open = file("open.off", without_triangle(cube(2), 5));
  const Domain domain = open_domain(open, options);
  ASSERT_EQ(told.size(), domain.notes.size());
  EXPECT_EQ(told[0], "|" + open + ": OFF, 47 triangles");
  EXPECT_EQ(told[1].find("repair|"), 0u) << told[1];
}

TEST(JoinedCad, KeepsThePatchesOfFacesThatMendingMade) {
  intake::CadTaken taken;
  taken.bodies.push_back({"solid", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {0}, {"face 1"}, {}}});
  Domain domain;
  domain.surface = taken.bodies[0].surface;
  domain.surface.patch_names = {"solid: closed by repair"};
  domain.surface.sides = {{kNone, 0}};
  domain.surface.source = {7};  // of none of the triangles that the solid had
  intake::finish_joined_cad(domain, taken, ComplexOptions::Overlap::kLater);
  EXPECT_EQ(domain.surface.patch_names[domain.surface.patch_of(0)], "solid: closed by repair");
  domain.surface.source = {0};
  intake::finish_joined_cad(domain, taken, ComplexOptions::Overlap::kLater);
  EXPECT_EQ(domain.surface.patch_names[domain.surface.patch_of(0)], "face 1");
}

TEST_F(Intake, WhatLiesInsideComesFromFiles) {
  SurfaceMesh sheet;
  sheet.points = {{-1, 0.25, 0.5}, {2, 0.25, 0.5}, {2, 0.75, 0.5}, {-1, 0.75, 0.5}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  write_surface("fault.off", sheet);
  write_text("rod.txt", "x y z\n.1 .1 .1\n.2 .1 .1\n\n.5 .5 .1\n.5 .5 .9\n");
  write_text("net.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nl 1 2 3\n");
  write_text("net.ply",
             "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
             "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n1 0\n");
  IntakeOptions options;
  options.inside.sheet_files = {"north=fault.off"};
  options.inside.wire_files = {"rod.txt", "net.obj", "ply=net.ply"};
  options.inside.point_files = {"gauges=rod.txt"};
  const Domain domain = open_domain(cube(2), options);
  EXPECT_TRUE(says(domain, "regions", "the sheet north: area 0.5 inside, 1 outside, cut off"));
  EXPECT_EQ(domain.surface.patch_names.back(), "north");
  ASSERT_EQ(domain.wires.size(), 3u);
  EXPECT_EQ(domain.wires[0].name, "rod");
  EXPECT_EQ(domain.wires[0].edges, (std::vector<Edge>{{0, 1}, {2, 3}}));
  EXPECT_EQ(domain.wires[1].edges, (std::vector<Edge>{{0, 1}, {1, 2}}));
  EXPECT_EQ(domain.wires[2].edges, (std::vector<Edge>{{1, 0}}));
  ASSERT_EQ(domain.points.size(), 1u);
  EXPECT_EQ(domain.points[0].points.size(), 4u);
}

TEST_F(Intake, FilesOfWhatLiesInsideAreRefusedWithThePlace) {
  const auto message = [](const std::string& text, const std::string& name) {
    write_text(name, text);
    try {
      read_lines(name);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message("1 2 3\n1 2\n", "short.txt").find("line 2"), std::string::npos);
  EXPECT_NE(message("1 2 3\n1 2 nan\n", "nan.csv").find("line 2"), std::string::npos);
  EXPECT_NE(message("v 0 0 0\nl 1 5\n", "far.obj").find("vertex 4"), std::string::npos);
  EXPECT_NE(message("\n", "empty.txt").find("no points"), std::string::npos);
  IntakeOptions twice;
  write_text("rod.txt", "0 0 0\n1 1 1\n");
  twice.inside.wire_files = {"rod.txt"};
  twice.inside.point_files = {"rod.txt"};
  EXPECT_THROW(open_domain(cube(2), twice), OptionError);
}

TEST_F(Intake, NumbersAndRequiredSetsOfAMeshFileComeOutAgain) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {3, 3, 3}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  mesh.region = {0, 1}, mesh.region_labels = {0, 5};
  mesh.boundary = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}};
  mesh.patch = {0, 0, 0, 1, 1, 1}, mesh.patch_labels = {-3, 2000001};
  mesh.sets = {{"RequiredVertices", NamedSet::Kind::kNodes, {4}}, {"RequiredTriangles", NamedSet::Kind::kFaces, {0}}};
  write_mesh("in.mesh", mesh);
  const Domain domain = open_domain("in.mesh");
  EXPECT_TRUE(says(domain, "reading", "1 faces between regions"));
  EXPECT_NE(to_json(domain).find("\"input_notes\""), std::string::npos);
  Options options;
  options.surface.keep = true;
  write_mesh("out.mesh", generate(domain, options).mesh);
  const TetMesh out = read_mesh("out.mesh");
  EXPECT_EQ(out.region_labels, (std::vector<std::int64_t>{0, 5}));
  std::vector<std::int64_t> labels;
  for (const std::uint32_t p : out.patch) labels.push_back(out.patch_labels[p]);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), -3), 3);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), 2000001), 3);
  std::string sets;
  for (const NamedSet& set : out.sets) sets += set.name + " " + std::to_string(set.members.size()) + " ";
  EXPECT_EQ(sets, "RequiredTriangles 1 RequiredVertices 1 ");
}

}  // namespace
}  // namespace octafront
