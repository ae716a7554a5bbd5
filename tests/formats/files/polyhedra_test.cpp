// The dual in files: which formats have it, what they say, and what stands in them. What others make of the files is
// judged by tests/formats/poly_judges.py.

#include <octafront/error.h>
#include <octafront/field_files.h>
#include <octafront/io.h>
#include <octafront/poly_mesh.h>

#include "formats/small_files.h"
#include "support/mixed_mesh.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::TemporaryFolder;

std::string content_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

bool any_has(const std::vector<std::string>& notes, const std::string& words) {
  return std::ranges::any_of(notes, [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(Polyhedra, OtherFormatsRefuseThemAndNameThoseThatHaveThem) {
  const TemporaryFolder folder;
  for (const FormatInfo& info : known_formats()) {
    if (!info.writes_mesh) continue;
    const WriteOptions options{.format = std::string(info.name), .polyhedral = true};
    if (info.holds.polyhedra) {
      EXPECT_NO_THROW(check_mesh_target(folder / "polyMesh", options)) << info.name;
      continue;
    }
    try {
      check_mesh_target(folder / "mesh", options);
      FAIL() << info.name;
    } catch (const OptionError& error) {
      EXPECT_NE(std::string(error.what()).find("vtu, openfoam"), std::string::npos) << error.what();
    }
  }
}

TEST(Polyhedra, AreNotInPartsAndHaveFaces) {
  const TemporaryFolder folder;
  EXPECT_THROW(check_mesh_target(folder / "polyMesh", {.polyhedral = true, .parts = 2}), OptionError);
  EXPECT_THROW(check_mesh_target(folder / "a.vtu", {.cells_only = true, .polyhedral = true}), OptionError);
}

TEST(Polyhedra, FoamFilesHaveThemWithPatchesAndZones) {
  const TemporaryFolder folder;
  const TetMesh mesh = testing::mixed_mesh(2);
  const PolyMesh dual = dual_mesh(mesh);
  write_mesh(folder / "polyMesh", mesh, {}, {.polyhedral = true});
  const auto counts = [&](const std::string& file, std::size_t n) {
    return content_of(folder / ("polyMesh/" + file)).find("}\n\n" + std::to_string(n) + "\n(") != std::string::npos;
  };
  EXPECT_TRUE(counts("points", dual.points.size()));
  EXPECT_TRUE(counts("faces", dual.faces()));
  EXPECT_TRUE(counts("owner", dual.faces()));
  EXPECT_TRUE(counts("neighbour", dual.inner_faces()));
  const std::string boundary = content_of(folder / "polyMesh/boundary");
  EXPECT_NE(boundary.find("startFace " + std::to_string(dual.inner_faces())), std::string::npos);
  const std::string zones = content_of(folder / "polyMesh/cellZones");
  for (std::uint32_t region : {0U, 1U})
    EXPECT_NE(zones.find(mesh.region_names[region] + "\n{\n    type cellZone;\n    cellLabels List<label> " +
                         std::to_string(std::ranges::count(dual.region, region))),
              std::string::npos);
}

TEST(Polyhedra, CellsHaveTheValuesOfTheirVertices) {
  const TemporaryFolder folder;
  const TetMesh mesh = testing::rich_mesh(2);
  std::vector<MeshField> fields{{"number", false, 1, {}}, {"of elements", true, 1, {}}};
  for (std::size_t v = 0; v < mesh.points.size(); ++v) fields[0].values.push_back(static_cast<double>(v));
  fields[1].values.assign(mesh.tets.size(), 1);
  const auto notes = write_mesh(folder / "a.vtu", mesh, fields, {}, {.ascii = true, .polyhedral = true});
  EXPECT_TRUE(any_has(notes, "without the values of elements"));
  EXPECT_TRUE(any_has(notes, "VTU of polyhedra holds no curves"));
  const std::string text = content_of(folder / "a.vtu");
  EXPECT_EQ(text.find("of elements"), std::string::npos);
  std::istringstream values(text.substr(text.find('>', text.find("Name=\"number\"")) + 1));
  for (const VertexIndex v : dual_mesh(mesh).vertex) {
    double value = -1;
    values >> value;
    EXPECT_EQ(value, v);
  }
}

TEST(Polyhedra, OfAMeshWithoutElementsThereAreNone) {
  const TemporaryFolder folder;
  TetMesh surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  surface.boundary = {{0, 1, 2}};
  EXPECT_THROW(write_mesh(folder / "a.vtu", surface, {}, {.polyhedral = true}), OptionError);
}

}  // namespace
}  // namespace octafront
