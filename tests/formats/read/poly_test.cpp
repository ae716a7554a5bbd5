#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/read/readers.h"
#include "formats/small_files.h"
#include "support/complexes.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::TemporaryFolder;

SurfaceFile poly(const std::string& text) {
  return io::read_poly({"a.poly", text}, false, nullptr);
}

const std::string kSquare =
    "# nodes\n8 3 0 1\n0 0 0 0 1\n1 4 0 0 1\n2 4 4 0 1\n3 0 4 0 1\n"
    "4 1 1 0 1\n5 2 1 0 1\n6 2 2 0 1\n7 1 2 0 1\n";

double area_of(const SurfaceFile& file) {
  return area(file.surface);
}

TEST(ReadPoly, AFacetMayHaveHolesLinesAndPoints) {
  EXPECT_DOUBLE_EQ(area_of(poly(kSquare + "1 1\n1 0 5\n4 0 1 2 3\n0\n0\n")), 16);
  const SurfaceFile hole = poly(kSquare + "1 1\n2 1 5\n4 0 1 2 3\n4 4 5 6 7\n1 1.5 1.5 0\n0\n0\n");
  EXPECT_DOUBLE_EQ(area_of(hole), 15);
  // Without the point the inner polygon divides the facet; so do lines, and points become vertices.
  const SurfaceFile divided = poly(kSquare + "1 1\n2 0 5\n4 0 1 2 3\n4 4 5 6 7\n0\n0\n");
  EXPECT_DOUBLE_EQ(area_of(divided), 16);
  const SurfaceFile lines = poly(kSquare + "1 1\n3 0 5\n4 0 1 2 3\n2 4 6\n1 5\n0\n0\n");
  EXPECT_DOUBLE_EQ(area_of(lines), 16);
  const auto uses = [&](VertexIndex v) {
    for (const Triangle& t : lines.surface.triangles)
      if (std::find(t.begin(), t.end(), v) != t.end()) return true;
    return false;
  };
  for (const VertexIndex v : {4u, 5u, 6u}) EXPECT_TRUE(uses(v));
  EXPECT_FALSE(uses(7));
}

TEST(ReadPoly, MarkersRegionsAndHoles) {
  const SurfaceFile file = poly(kSquare +
                                "2 1\n1 0 5\n4 0 1 2 3\n1 0 -2\n4 4 5 6 7\n"
                                "1\n1 .5 .5 .5\n2\n1 1 2 3 7\n2 4 5 6 2.5 0.01\n");
  EXPECT_EQ(file.surface.patch, (std::vector<std::uint32_t>{0, 0, 1, 1}));
  EXPECT_EQ(file.surface.patch_names, (std::vector<std::string>{"marker_5", "marker_-2"}));
  ASSERT_EQ(file.voids.size(), 1U);
  EXPECT_EQ(file.voids[0], (Vec3{.5, .5, .5}));
  ASSERT_EQ(file.regions.size(), 2U);
  EXPECT_EQ(file.regions[0].name, "region_7");
  EXPECT_EQ(file.regions[1].name, "region_2.5");
  EXPECT_EQ(file.regions[1].at, (Vec3{4, 5, 6}));
  EXPECT_EQ(file.notes.size(), 2U) << "polygons divided; volumes not taken over";
}

TEST(ReadPoly, SmeshAndNodesBeside) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.node") << kSquare;
  std::ofstream(folder / "a.smesh") << "0 3 0 0\n2 1\n4 0 1 2 3 7\n4 4 5\n 6 7 9\n0\n0\n";
  const SurfaceFile file = read_surface(folder / "a.smesh");
  EXPECT_DOUBLE_EQ(area_of(file), 17);
  EXPECT_EQ(file.surface.patch_names, (std::vector<std::string>{"marker_7", "marker_9"}));
}

TEST(ReadPoly, SaysWhatIsWrongAndWhere) {
  const auto message = [](const std::string& text) {
    try {
      poly(text);
      return std::string("it was read");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(message(kSquare + "1 1\n1 0 5\n4 0 1 2 8\n0\n0\n").find("there is no node 8"), std::string::npos);
  EXPECT_NE(message("0 3 0 0\n").find("no file .node"), std::string::npos);
  EXPECT_NE(message(kSquare + "9999999 1\n").find("truncated"), std::string::npos);
  EXPECT_NE(message("2 3 0 0\n5 0 0 0\n").find("expected node"), std::string::npos);
  EXPECT_NE(message(kSquare + "1 1\n1 0 5\n2 0 1\n0\n0\n").find("no triangles"), std::string::npos);
}

TEST(ReadSurface, TrianglesOfMeshFiles) {
  const SurfaceFile medit = testing::surface_of(
      "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
      "Triangles 4\n2 3 4 1\n1 4 3 2\n1 2 4 2\n1 3 2 2\nEnd\n",
      "a.mesh");
  EXPECT_EQ(medit.surface.triangles.size(), 4U);
  EXPECT_EQ(medit.surface.patch, (std::vector<std::uint32_t>{0, 1, 1, 1}));
  const SurfaceFile msh = testing::surface_of(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 3 \"inlet\"\n2 4 \"wall\"\n$EndPhysicalNames\n"
      "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
      "$Elements\n4\n1 2 2 3 1 2 3 4\n2 2 2 4 2 1 4 3\n3 2 2 4 2 1 2 4\n4 2 2 4 2 1 3 2\n$EndElements\n",
      "a.msh");
  ASSERT_EQ(msh.surface.triangles.size(), 4U);
  EXPECT_EQ(msh.surface.patch_names.at(msh.surface.patch_of(0)), "inlet");
  EXPECT_EQ(msh.surface.patch_names.at(msh.surface.patch_of(3)), "wall");
  EXPECT_TRUE(msh.surface.sides.empty());
}

TEST(ReadSurface, OfAMeshTheWallsBetweenItsRegions) {
  const TemporaryFolder folder;
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.boundary = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {2, 1, 4}, {0, 4, 1}, {0, 2, 4}};
  mesh.interfaces = {{0, 1, 2}};
  mesh.interface_patch = {1};
  mesh.patch.assign(6, 0);
  mesh.patch_names = {"skin", "between"};
  mesh.region = {0, 1};
  mesh.region_names = {"upper", "lower"};
  for (const char* name : {"a.msh", "a.mesh"}) {
    SCOPED_TRACE(name);
    write_mesh(folder / name, mesh);
    EXPECT_TRUE(holds_tetrahedra(folder / name));
    const SurfaceMesh walls = read_surface(folder / name).surface;
    ASSERT_EQ(walls.triangles.size(), 7U);
    const std::vector<double> volumes = testing::region_volumes(walls);
    ASSERT_EQ(volumes.size(), 2U);
    EXPECT_DOUBLE_EQ(volumes[0], 1.0 / 6);
    EXPECT_DOUBLE_EQ(volumes[1], 1.0 / 6);
  }
}

}  // namespace
}  // namespace octafront
