// Cohesive elements, beams and names in Abaqus files; files for SimNIBS.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/split.h>

#include "formats/small_files.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// The lines under a keyword, up to the next one.
std::vector<std::string> lines_under(const std::string& file, const std::string& keyword) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  bool on = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('*'))
      on = line == keyword;
    else if (on)
      lines.push_back(line);
  }
  return lines;
}

std::vector<std::size_t> numbers_of(const std::string& line) {
  std::vector<std::size_t> numbers;
  std::istringstream in(line);
  for (std::string word; std::getline(in, word, ',');) numbers.push_back(std::stoul(word));
  return numbers;
}

TEST(SplitFiles, CohesiveElementsJoinTheTwoSides) {
  const testing::TemporaryFolder folder;
  TetMesh mesh = testing::rich_mesh(2);
  mesh.sets.clear();
  split_patches(mesh, {"glue"});
  const std::string file = (folder / "split.inp").string();
  write_mesh(file, mesh, {}, {.cohesive = true});
  const auto lines = lines_under(file, "*ELEMENT, TYPE=COH3D6, ELSET=glue_cohesive");
  ASSERT_EQ(lines.size(), 8u);
  for (const std::string& line : lines) {
    const auto n = numbers_of(line);
    ASSERT_EQ(n.size(), 7u);
    EXPECT_GT(n[0], mesh.tets.size());
    for (std::size_t i = 1; i <= 3; ++i) {
      EXPECT_NE(n[i], n[i + 3]);
      EXPECT_EQ(mesh.points[n[i] - 1], mesh.points[n[i + 3] - 1]);
    }
  }
  write_mesh((folder / "plain.inp").string(), mesh);
  EXPECT_TRUE(lines_under((folder / "plain.inp").string(), "*ELEMENT, TYPE=COH3D6, ELSET=glue_cohesive").empty());
  EXPECT_EQ(write_mesh((folder / "split.msh").string(), mesh, {}, {.cohesive = true}).back(),
            "Gmsh MSH 4.1 is given no cohesive elements and beams: they are for Abaqus");
}

TEST(SplitFiles, CurvesAreBeamsWhereAsked) {
  const testing::TemporaryFolder folder;
  TetMesh mesh = testing::rich_mesh(2);
  mesh.curve_names.assign(12, "");
  mesh.curve_names[0] = "rod";
  const std::string file = (folder / "beams.inp").string();
  write_mesh(file, mesh, {}, {.beams = "rod"});
  EXPECT_EQ(lines_under(file, "*ELEMENT, TYPE=B31, ELSET=rod_beams").size(), 2u);
  write_mesh(file, testing::with_mid_nodes(mesh), {}, {.beams = "rod"});
  const auto curved = lines_under(file, "*ELEMENT, TYPE=B32, ELSET=rod_beams");
  ASSERT_EQ(curved.size(), 2u);
  EXPECT_EQ(numbers_of(curved[0]).size(), 4u);
  EXPECT_THROW(write_mesh(file, mesh, {}, {.beams = "rope"}), OptionError);
}

TEST(Simnibs, TrianglesBoundTissuesAndComeFirst) {
  const testing::TemporaryFolder folder;
  TetMesh mesh = testing::rich_mesh(2);
  mesh.region_labels = {5, 2};
  const std::string file = (folder / "head.msh").string();
  write_mesh(file, mesh, {}, {.format = "simnibs", .ascii = true});
  std::ifstream in(file);
  std::string word;
  while (in >> word && word != "$Elements") {
  }
  std::size_t count = 0, number = 0, type = 0, tags = 0, physical = 0, geometrical = 0;
  in >> count;
  EXPECT_EQ(count, mesh.boundary.size() + mesh.interfaces.size() + mesh.tets.size());
  std::vector<std::size_t> of_tag(2000, 0);
  double volume = 0;  // 3 V is the sum over triangles that face out of tissue 2
  for (std::size_t i = 1; i <= count; ++i) {
    in >> number >> type >> tags >> physical >> geometrical;
    EXPECT_EQ(number, i);
    EXPECT_EQ(type, i <= count - mesh.tets.size() ? 2u : 4u);
    EXPECT_EQ(tags, 2u);
    EXPECT_EQ(physical, geometrical);
    ++of_tag[physical];
    std::vector<std::size_t> v(type == 2 ? 3 : 4);
    for (std::size_t& node : v) in >> node;
    const auto& p = mesh.points;
    if (physical == 1002) volume += dot(p[v[0] - 1], cross(p[v[1] - 1], p[v[2] - 1])) / 6;
  }
  EXPECT_EQ(of_tag[5] + of_tag[2], mesh.tets.size());
  EXPECT_EQ(of_tag[5], of_tag[2]);
  // The half of the cube of tissue 2 has the faces between both.
  EXPECT_EQ(of_tag[1002], of_tag[1005] + mesh.interfaces.size());
  EXPECT_NEAR(volume, 2. * 2 * 1, 1e-12);
  mesh.region_labels = {5, 1000};
  EXPECT_THROW(write_mesh(file, mesh, {}, {.format = "simnibs"}), OutputError);
}

TEST(AbaqusNames, SurfacesAndElementsShareNone) {
  const testing::TemporaryFolder folder;
  TetMesh mesh = testing::rich_mesh(2);
  mesh.region_names = {"bone", "Marrow"};
  mesh.patch_names.assign(7, "bone");
  mesh.patch_names[1] = "marrow";
  mesh.patch_names[2] = "bone_surface";
  mesh.sets = {{"skin", NamedSet::Kind::kElements, {0, 1}}, {"skin", NamedSet::Kind::kFaces, {0}}};
  const std::string file = (folder / "names.inp").string();
  write_mesh(file, mesh, {}, {.materials = {{"skin", "E", 12.5}}, .poissons_ratio = .25});
  std::ifstream in(file);
  std::vector<std::string> surfaces;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("*SURFACE")) surfaces.push_back(line.substr(15, line.find(", TYPE") - 15));
  EXPECT_EQ(surfaces, (std::vector<std::string>{"bone_surface", "marrow_surface", "bone_surface_2", "bone_surface_3",
                                                "bone_surface_4", "bone_surface_5", "bone_surface_6", "skin_surface"}));
  EXPECT_EQ(lines_under(file, "*ELASTIC"), (std::vector<std::string>{"12.5, 0.25"}));
  EXPECT_EQ(read_mesh(file).patch_names[1], "marrow");
}

}  // namespace
}  // namespace octafront
