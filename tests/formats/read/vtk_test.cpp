// Cell arrays by which other programs tell materials, and a byte order mark.

#include <octafront/io.h>

#include "formats/cube_text.h"
#include "formats/small_files.h"

#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::says;

std::string vtu(const std::string& cell_data) {
  std::string points, corners;
  for (const Vec3& p : testing::kCubeNodes) points += fmt::format("{} {} {} ", p.x, p.y, p.z);
  for (const auto& t : testing::kCubeTets)
    for (const int v : t) corners += std::to_string(v - 1) + " ";
  const auto array = [](const char* type, const char* name, const std::string& values) {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">{}</DataArray>",
                       type, name, std::string(name) == "Points" ? 3 : 1, values);
  };
  return "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">"
         "<UnstructuredGrid><Piece NumberOfPoints=\"8\" NumberOfCells=\"6\"><CellData>" +
         cell_data + "</CellData><Points>" + array("Float32", "Points", points) + "</Points><Cells>" +
         array("Int64", "connectivity", corners) + array("Int64", "offsets", "4 8 12 16 20 24") +
         array("UInt8", "types", "10 10 10 10 10 10") + "</Cells></Piece></UnstructuredGrid></VTKFile>";
}
std::string cells(const std::string& name, const std::string& values) {
  return "<DataArray type=\"Int32\" Name=\"" + name + "\" format=\"ascii\">" + values + "</DataArray>";
}

TEST(ReadVtu, MaterialsByAnyName) {
  for (const std::string name : {"MaterialID", "material", "cell_tags", "whatever"}) {
    SCOPED_TRACE(name);
    const MeshFile file =
        io::read_mesh_bytes({"x", vtu(cells("GlobalElementId", "1 2 3 4 5 6") + cells(name, "3 3 3 7 7 7"))});
    EXPECT_EQ(file.mesh.region, (std::vector<std::uint32_t>{2, 2, 2, 6, 6, 6}));
    EXPECT_TRUE(says(file.notes, "\"" + name + "\" tells regions"));
    EXPECT_TRUE(says(file.notes, "left out: \"GlobalElementId\""));
  }
}

TEST(ReadVtu, OfSeveralArraysThatWhichIsCalledSo) {
  const std::string other = cells("a", "1 1 2 2 2 2");
  const MeshFile known = io::read_mesh_bytes({"x", vtu(other + cells("MaterialID", "0 0 0 0 0 5"))});
  EXPECT_EQ(known.mesh.region_labels, (std::vector<std::int64_t>{0, 5}));
  const MeshFile unknown = io::read_mesh_bytes({"x", vtu(other + cells("b", "1 1 1 1 1 2"))});
  EXPECT_TRUE(unknown.mesh.region.empty());
  EXPECT_TRUE(says(unknown.notes, "left out: \"a\", \"b\""));
}

TEST(ReadVtk, MaterialsByAnyName) {
  std::string text = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
  for (const Vec3& p : testing::kCubeNodes) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  text += "CELLS 6 30\n";
  for (const auto& t : testing::kCubeTets)
    text += fmt::format("4 {} {} {} {}\n", t[0] - 1, t[1] - 1, t[2] - 1, t[3] - 1);
  text +=
      "CELL_TYPES 6\n10\n10\n10\n10\n10\n10\nCELL_DATA 6\nSCALARS mat_id int 1\nLOOKUP_TABLE default\n4 4 4 4 2 2\n";
  const MeshFile file = io::read_mesh_bytes({"x", text});
  EXPECT_EQ(file.mesh.region, (std::vector<std::uint32_t>{3, 3, 3, 3, 1, 1}));
}

TEST(ReadText, WithAByteOrderMark) {
  const testing::TemporaryFolder folder;
  const std::string mark = "\xef\xbb\xbf";
  testing::write_bytes(folder / "a.vtu", mark + vtu(""));
  EXPECT_EQ(read_mesh(folder / "a.vtu").tets.size(), 6U);
  testing::write_bytes(
      folder / "a.stl",
      mark +
          "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
          "endfacet\nendsolid x\n");
  EXPECT_EQ(read_surface(folder / "a.stl").surface.triangles.size(), 1U);
}

}  // namespace
}  // namespace octafront
