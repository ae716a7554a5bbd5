// CAD files on the way in and as meshes: the samples, which the program beside these tests makes anew.

#include <octafront/cad.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/named_groups.h>
#include <octafront/validity.h>

#include "support/test_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

const std::string kBracket = OCTAFRONT_SAMPLES "/bracket.step", kAssembly = OCTAFRONT_SAMPLES "/assembly.step";

/// Of what the bracket is made: two legs, the bend, less four holes.
double volume_of_bracket() {
  constexpr double kPi = std::numbers::pi;
  return 40 * (46 * 6 + 36 * 6 + kPi / 4 * (14 * 14 - 8 * 8)) - 4 * kPi * 4 * 4 * 6;
}

class CadFiles : public testing::InItsFolder {
 protected:
  void SetUp() override {
    InItsFolder::SetUp();
    setenv("OCTAFRONT_CAD", OCTAFRONT_CAD_PROGRAM, 1);
  }

  static Result meshed(const std::string& file, const Options& options, const IntakeOptions& intake = {}) {
    return generate(open_domain(file, intake_for(options, intake)), options);
  }
  static Options of_size(double size) {
    Options options;
    options.size.size = size;
    return options;
  }
};

const NamedSet* set_named(const TetMesh& mesh, const std::string& name) {
  const auto found =
      std::find_if(mesh.sets.begin(), mesh.sets.end(), [&](const NamedSet& s) { return s.name == name; });
  return found == mesh.sets.end() ? nullptr : &*found;
}

/// How many faces of the boundary have this patch.
std::size_t faces_of_patch(const TetMesh& mesh, const std::string& name) {
  std::size_t count = 0;
  for (const std::uint32_t p : mesh.patch) count += mesh.patch_names[p] == name;
  return count;
}

TEST_F(CadFiles, TheSamplesSayWhatTheyAre) {
  const CadInfo info = read_cad_info(kAssembly);
  std::vector<std::string> solids;
  for (const CadInfo::Solid& solid : info.solids) solids.push_back(solid.name);
  EXPECT_EQ(solids, (std::vector<std::string>{"plate", "bracket", "bolt", "bolt#2"}));
  EXPECT_NEAR(info.solids[1].volume, volume_of_bracket(), 1e-6 * volume_of_bracket());
  EXPECT_EQ(info.named_faces, 6u);
  std::vector<std::string> groups;
  for (const CadInfo::Group& group : info.groups) groups.push_back(group.name);
  EXPECT_EQ(groups,
            (std::vector<std::string>{"color #d03030", "layer mounting", "plate|bracket", "solids of color #4078c0",
                                      "solids of color #b0b8c0", "solids of color #f09020"}));
  EXPECT_EQ(info.groups.back().solids, 2u);
}

TEST_F(CadFiles, TheSamplesSayWhatTouches) {
  const CadInfo info = read_cad_info(kAssembly);
  EXPECT_EQ(info.solids[2].product, "bolt");
  EXPECT_EQ(info.solids[3].product, "bolt");
  EXPECT_EQ(info.solids[3].color, "#f09020");
  std::vector<std::string> contacts;
  for (const CadInfo::Contact& contact : info.contacts) {
    contacts.push_back(contact.patch + ": " + contact.shape);
    EXPECT_EQ(contact.gap, 0);
    EXPECT_EQ(contact.overlap, 0);
  }
  EXPECT_EQ(contacts, (std::vector<std::string>{"seat: plane", "plate|bolt: cylinder of radius 4",
                                                "plate|bolt#2: cylinder of radius 4",
                                                "bolt hole 1: cylinder of radius 4", "bracket|bolt: plane",
                                                "bolt hole 2: cylinder of radius 4", "bracket|bolt#2: plane"}));
  EXPECT_NEAR(info.contacts[1].area, 2 * std::numbers::pi * 4 * 8, 1e-6);
  EXPECT_EQ(info.contacts[1].solids, (std::array<std::string, 2>{"plate", "bolt"}));
}

TEST_F(CadFiles, AMeshHasThePatchesAndCurvesThatTheFileIsSaidToHave) {
  const CadInfo info = read_cad_info(kAssembly);
  const PlaceNames made = place_names(meshed(kAssembly, of_size(5)).mesh);
  std::set<std::string> patches;
  for (const CadInfo::Patch& patch : info.patches) patches.insert(patch.name);
  EXPECT_EQ(std::set<std::string>(made.patches.begin(), made.patches.end()), patches);
  EXPECT_EQ(std::set<std::string>(made.curves.begin(), made.curves.end()),
            std::set<std::string>(info.edges.begin(), info.edges.end()));
}

TEST_F(CadFiles, WhatAMeshWillHaveIsKnownBefore) {
  Options options = of_size(5);
  options.groups = {"largest plane at z min=largest plane at z min", "smallest torus=smallest torus"};
  IntakeOptions intake;
  intake.contacts = "split";
  const PlaceNames expected = expected_place_names(open_domain({kAssembly}, intake_for(options, intake)), options),
                   made = place_names(meshed(kAssembly, options, intake).mesh);
  const auto expects = [](const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  EXPECT_EQ(expected.regions, made.regions);
  const auto in_order = [](const std::vector<std::string>& names) {
    return std::set<std::string>(names.begin(), names.end());
  };
  EXPECT_EQ(in_order(expected.sets), in_order(made.sets));
  EXPECT_EQ(in_order(expected.contacts), in_order(made.contacts));
  for (const std::string& patch : made.patches)
    EXPECT_TRUE(expects(expected.patches, patch) || expects(expected.contacts, patch)) << patch;
}

TEST_F(CadFiles, PartsThatComeApartKeepTheirVolumesNamesAndSets) {
  Options options = of_size(7);
  options.order = 2;
  options.size.named = {{"bolt", 3}, {"circles of radius 4 of bracket", 1}};
  options.groups = {"holes=cylinders of radius 4"};
  options.split = "seat";  // which is open already
  IntakeOptions intake;
  intake.contacts = "separate";
  const Result made = meshed(kAssembly, options, intake);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_EQ(made.mesh.region_names, (std::vector<std::string>{"plate", "bracket", "bolt", "bolt#2"}));
  ASSERT_EQ(made.report.regions.size(), 4U);
  for (const RegionSummary& region : made.report.regions)
    EXPECT_NEAR(region.volume / region.true_volume, 1, 1e-3) << region.name;
  ASSERT_EQ(made.report.contacts.size(), 7U);
  for (const ContactSummary& contact : made.report.contacts) {
    EXPECT_FALSE(contact.conforming);
    EXPECT_NEAR(contact.areas[0] / contact.areas[1], 1, 0.05) << contact.patches[0];
    EXPECT_GT(contact.triangles[0], 0U);
  }
  const NamedSet* holes = set_named(made.mesh, "holes");
  ASSERT_NE(holes, nullptr);
  std::size_t in_holes = 0;
  for (const char* patch : {"plate|bolt", "bolt|plate", "plate|bolt#2", "bolt#2|plate"})
    in_holes += faces_of_patch(made.mesh, patch);
  EXPECT_GE(holes->members.size(), in_holes);
  EXPECT_EQ(set_named(made.mesh, "cylinders of radius 4"), nullptr);
  for (const StageReport& stage : made.report.stages)
    for (const std::string& note : stage.notes) EXPECT_EQ(note.find("no elements of their own"), note.npos) << note;
}

TEST_F(CadFiles, GroupsAreAlsoOfWhatSomethingIsLike) {
  Options options = of_size(6);
  options.groups = {"holes=cylinders of radius 4",
                    "foot=largest plane at z min",
                    "rims=circles of radius 4 of plate",
                    "tips=points at z max",
                    "four=face 4",
                    "seat of both=bracket|plate",
                    "low=box:-99,-99,-99,99,99,-7",
                    "none=spheres"};
  const Result made = meshed(kAssembly, options);
  const TetMesh& mesh = made.mesh;
  const auto members = [&](const char* name) {
    return set_named(mesh, name) ? set_named(mesh, name)->members.size() : 0;
  };
  const auto on_patch = [&](const std::string& name) {
    std::size_t count = 0;
    for (const auto* list : {&mesh.patch, &mesh.interface_patch})
      for (const std::uint32_t p : *list) count += mesh.patch_names[p] == name;
    return count;
  };
  std::size_t in_holes = 0;
  for (const char* patch : {"bolt hole 1", "bolt hole 2", "plate|bolt", "plate|bolt#2"}) in_holes += on_patch(patch);
  EXPECT_GE(members("holes"), in_holes);
  EXPECT_EQ(members("foot"), on_patch("ground"));
  EXPECT_EQ(members("four"), on_patch("seat"));
  EXPECT_EQ(members("seat of both"), on_patch("seat"));
  EXPECT_EQ(members("tips"), 4U);
  EXPECT_GT(members("low"), 0U);
  for (const std::uint32_t v : set_named(mesh, "tips")->members) EXPECT_EQ(mesh.points[v].z, 50);
  const NamedSet* rims = set_named(mesh, "rims");
  ASSERT_TRUE(rims && rims->kind == NamedSet::Kind::kEdges);
  double length = 0;
  for (const std::uint32_t e : rims->members) {
    const auto [a, b] = mesh.curve_edges[e];
    length += distance(mesh.points[a], mesh.points[b]);
  }
  EXPECT_NEAR(length, 4 * 2 * std::numbers::pi * 4, 0.05 * length) << "two holes, above and below";
  EXPECT_FALSE(set_named(mesh, "none") || set_named(mesh, "cylinders of radius 4") || set_named(mesh, "face 4"));
  EXPECT_TRUE(set_named(mesh, "plate|bracket")) << "that the file has anyway";
  const auto says_so = [](const StageReport& stage) {
    return stage.name == "groups" && stage.notes.size() == 1 && stage.notes[0].find("\"none\"") != std::string::npos;
  };
  EXPECT_TRUE(std::ranges::any_of(made.report.stages, says_so));
  options.groups = {"g=patches:seat,no such patch"};
  EXPECT_THROW(meshed(kAssembly, options), OptionError);
}

TEST_F(CadFiles, SizesAndOpeningsAreAlsoOfWhatSomethingIsLike) {
  Options options = of_size(8);
  options.size.named = {{"cylinders of radius 4 of plate", 1}};
  options.size.near = {{"points at z max", {}, 1, 6}};
  options.split = "bolt|plate";
  const TetMesh mesh = meshed(kAssembly, options).mesh;
  EXPECT_GT(faces_of_patch(mesh, "bolt|plate_plus"), 600U) << "of both bolts";
  EXPECT_EQ(faces_of_patch(mesh, "bolt|plate_plus"), faces_of_patch(mesh, "bolt|plate_minus"));
  options.split = "planes at z min";
  EXPECT_THROW(meshed(kAssembly, options), OptionError) << "none of them lies inside";
  options.split.clear(), options.size.named = {{"cylinders of radius 7", 2}};
  EXPECT_THROW(meshed(kAssembly, options), OptionError);
}

TEST_F(CadFiles, TheSamplesAreMadeAnew) {
  ASSERT_EQ(std::system((OCTAFRONT_CAD_SAMPLES " " + folder_.path().string()).c_str()), 0);
  EXPECT_EQ(to_json(read_cad_info(folder_ / "bracket.step")), to_json(read_cad_info(kBracket)));
  EXPECT_EQ(to_json(read_cad_info(folder_ / "assembly.step")), to_json(read_cad_info(kAssembly)));
  EXPECT_EQ(to_json(read_cad_info(folder_ / "bend.step")), to_json(read_cad_info(OCTAFRONT_SAMPLES "/bend.step")));
}

TEST_F(CadFiles, NamesColoursAndLayersAreInTheMesh) {
  const Result made = meshed(kBracket, of_size(4));
  EXPECT_NEAR(made.report.volume, volume_of_bracket(), 0.01 * volume_of_bracket());
  EXPECT_NEAR(made.report.true_volume, volume_of_bracket(), 1e-6 * volume_of_bracket());
  std::size_t red = 0, mounting = 0;
  for (const char* hole : {"bolt hole 1", "bolt hole 2"}) red += faces_of_patch(made.mesh, hole);
  for (const char* face : {"seat", "wall"}) mounting += faces_of_patch(made.mesh, face);
  const NamedSet *colour = set_named(made.mesh, "color #d03030"), *layer = set_named(made.mesh, "layer mounting");
  ASSERT_TRUE(colour && layer);
  EXPECT_GT(red, 0u);
  EXPECT_EQ(colour->members.size(), red);
  EXPECT_EQ(layer->members.size(), mounting);
  for (const std::uint32_t f : colour->members)
    EXPECT_EQ(made.mesh.patch_names[made.mesh.patch[f]].rfind("bolt hole ", 0), 0u);
  ASSERT_TRUE(set_named(made.mesh, "solids of color #4078c0"));
  EXPECT_EQ(set_named(made.mesh, "solids of color #4078c0")->members.size(), made.mesh.tets.size());
}

TEST_F(CadFiles, SolidsShareFacesAndKeepTheirColours) {
  const TetMesh mesh = meshed(kAssembly, of_size(5)).mesh;
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"plate", "bracket", "bolt", "bolt#2"}));
  EXPECT_GT(mesh.interfaces.size(), 0u);
  const NamedSet* bolts = set_named(mesh, "solids of color #f09020");
  ASSERT_TRUE(bolts);
  std::set<std::uint32_t> regions;
  for (const std::uint32_t t : bolts->members) regions.insert(mesh.region[t]);
  EXPECT_EQ(regions, (std::set<std::uint32_t>{2, 3}));
}

TEST_F(CadFiles, AGapClosesWithinATolerance) {
  std::ifstream in(kAssembly);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string at = "(45.,10.,6.)";
  ASSERT_NE(text.find(at), std::string::npos);
  text.replace(text.find(at), at.size(), "(45.,10.,6.1)");  // one bolt, out of its seat
  std::ofstream("lifted.step") << text;
  const auto touching = [](double tolerance) {  // the area of the bracket on the bolt
    IntakeOptions intake;
    intake.complex.tolerance = tolerance;
    const SurfaceMesh surface = open_domain("lifted.step", intake_for(of_size(5), intake)).surface;
    double area = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& [a, b, c] = surface.triangles[t];
      const auto& p = surface.points;
      const auto [front, behind] = surface.sides[t];
      if (front + behind == 3 && front * behind == 2) area += length(cross(p[b] - p[a], p[c] - p[a])) / 2;
    }
    return area;
  };
  EXPECT_LT(touching(0.05), 155) << "the hole alone";
  EXPECT_GT(touching(0.15), 235);
}

TEST_F(CadFiles, SizesByColourAndByFace) {
  Options options = of_size(8);
  const std::size_t before = faces_of_patch(meshed(kBracket, options).mesh, "bolt hole 1");
  options.size.named = {{"color #d03030", 0.5}};
  EXPECT_GT(faces_of_patch(meshed(kBracket, options).mesh, "bolt hole 1"), 4 * before);
  // A face that is meshed as one with those beside it, whose name no patch has: of a size of its own.
  options.size.named = {{"fillet", 2}};
  const Domain domain = open_domain(kBracket, intake_for(options));
  EXPECT_EQ(std::count(domain.surface.patch_names.begin(), domain.surface.patch_names.end(), "fillet"), 1);
  EXPECT_NO_THROW(generate(domain, options));
  IntakeOptions coarse;
  coarse.cad.size = 30;
  const Domain as_one = open_domain(kBracket, coarse);
  EXPECT_EQ(std::count(as_one.surface.patch_names.begin(), as_one.surface.patch_names.end(), "fillet"), 0);
  EXPECT_NO_THROW(generate_sizes(as_one, options));
  options.size.named = {{"no such face", 2}};
  EXPECT_THROW(generate_sizes(domain, options), OptionError);
}

TEST_F(CadFiles, ANumberOfElementsChoosesTheTriangles) {
  Options few, many;
  few.size.elements = 2000, many.size.elements = 200000;
  const auto triangles = [](const Options& o) { return open_domain(kBracket, intake_for(o)).surface.triangles.size(); };
  EXPECT_GT(triangles(many), triangles(few));
  const Result made = meshed(kBracket, many);
  EXPECT_NEAR(static_cast<double>(made.mesh.tets.size()), 200000, 30000);
}

TEST_F(CadFiles, MostlyFlatSolidsLetChordsLieDeeper) {
  const Domain domain = open_domain(kAssembly, intake_for(of_size(4), {}));
  const CadInfo info = read_cad_info(kAssembly);
  ASSERT_EQ(domain.chord_depths.size(), info.solids.size());
  const auto depth = [&](std::size_t s) {
    return domain.chord_depths[s] * info.solids[s].area / info.solids[s].volume;
  };
  EXPECT_NEAR(depth(0), 0.1, 1e-9) << "a plate with holes";
  EXPECT_LT(depth(2), 0.06) << "a bolt";
  EXPECT_GT(depth(2), 0.025);
}

TEST_F(CadFiles, UnitsScaleTheMesh) {
  IntakeOptions inches;
  inches.cad.unit = "in";
  const Result made = meshed(kBracket, of_size(5 / 25.4), inches);
  const double volume = volume_of_bracket() / (25.4 * 25.4 * 25.4);
  EXPECT_NEAR(made.report.volume, volume, 0.01 * volume);
  EXPECT_NEAR(made.report.true_volume, volume, 1e-6 * volume);
  // Vertices on the holes are on their cylinders.
  std::size_t looked_at = 0;
  for (std::size_t f = 0; f < made.mesh.boundary.size(); ++f) {
    if (made.mesh.patch_names[made.mesh.patch[f]] != "bolt hole 1") continue;
    for (const VertexIndex v : made.mesh.boundary[f]) {
      const Vec3 p = 25.4 * made.mesh.points[v];
      EXPECT_NEAR(std::hypot(p.x - 45, p.y - 10), 4, 1e-7);
      ++looked_at;
    }
  }
  EXPECT_GT(looked_at, 20u);
  IntakeOptions unknown;
  unknown.cad.unit = "cubit";
  EXPECT_THROW(open_domain(kBracket, unknown), OptionError);
}

}  // namespace
}  // namespace octafront
