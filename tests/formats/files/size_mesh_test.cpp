// Meshes with a field of sizes, in each format that has fields.

#include <octafront/error.h>
#include <octafront/io.h>

#include "support/test_folder.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

class SizeMeshFiles : public testing::InItsFolder {
 protected:
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// The size at each point, by its place.
  static void expect_at_points(const SizeMesh& mesh) {
    ASSERT_EQ(mesh.tets.size(), 1u);
    ASSERT_EQ(mesh.points.size(), 4u);
    ASSERT_EQ(mesh.point_sizes.size(), 4u);
    for (std::size_t v = 0; v < 4; ++v)
      EXPECT_EQ(mesh.point_sizes[v], 1 + mesh.points[v].x + 2 * mesh.points[v].y + 4 * mesh.points[v].z);
  }

  std::string refusal(const std::string& named) const {
    try {
      SizeOptions options;
      read_sizes_into(options, named);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

// Tags out of order, so that values have to follow their nodes.
const char* const kSizedMsh41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 9\n3 1 0 4\n9\n2\n5\n1\n0 0 1\n1 0 0\n0 1 0\n0 0 "
    "0\n$EndNodes\n"
    "$Elements\n1 1 7 7\n3 1 4 1\n7 1 2 5 9\n$EndElements\n"
    "$NodeData\n1\n\"other\"\n1\n0\n3\n0\n3\n1\n1 7 7 7\n$EndNodeData\n"
    "$NodeData\n1\n\"the size\"\n1\n0.0\n3\n0\n1\n4\n1 1\n2 2\n5 3\n9 5\n$EndNodeData\n"
    "$ElementData\n1\n\"e\"\n1\n0\n3\n0\n1\n1\n7 2.5\n$EndElementData\n";
const char* const kSizedMsh22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n9 0 0 1\n2 1 0 0\n5 0 1 0\n1 0 0 0\n$EndNodes\n"
    "$Elements\n1\n7 4 2 1 1 1 2 5 9\n$EndElements\n"
    "$NodeData\n1\n\"h\"\n1\n0.0\n3\n0\n1\n4\n1 1\n2 2\n5 3\n9 5\n$EndNodeData\n";
const char* const kSizedVtk =
    "# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\n"
    "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nCELL_DATA 1\nSCALARS of_cell double 1\nLOOKUP_TABLE default\n2.5\n"
    "POINT_DATA 4\nSCALARS h float 1\nLOOKUP_TABLE default\n1 2 3 5\nVECTORS u double\n0 0 0 0 0 0 0 0 0 0 0 0\n";
const char* const kSizedVtu =
    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">"
    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
    "1</DataArray></Points>"
    "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells>"
    "<PointData><DataArray type=\"Float64\" Name=\"h\" format=\"ascii\">1 2 3 5</DataArray></PointData>"
    "<CellData><DataArray type=\"Float64\" Name=\"c\" format=\"ascii\">2.5</DataArray>"
    "<DataArray type=\"Int32\" Name=\"region\" format=\"ascii\">0</DataArray></CellData>"
    "</Piece></UnstructuredGrid></VTKFile>";
const char* const kSizedMedit =
    "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\nTetrahedra 1\n1 2 3 4 "
    "1\nEnd\n";
const char* const kSizesOfMedit =
    "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n4\n2 2 1\n9 9 9 1\n9 9 9 2\n9 9 9 3\n9 9 9 5\nEnd\n";

TEST_F(SizeMeshFiles, FieldsAtPointsFollowTheirPoints) {
  expect_at_points(*read_size_mesh(file("a.msh", kSizedMsh41), "the size"));
  expect_at_points(*read_size_mesh(file("b.msh", kSizedMsh22)));
  expect_at_points(*read_size_mesh(file("c.vtk", kSizedVtk), "h"));
  expect_at_points(*read_size_mesh(file("d.vtu", kSizedVtu), "h"));
  const std::string mesh = file("e.mesh", kSizedMedit);
  file("e.sol", kSizesOfMedit);
  expect_at_points(*read_size_mesh(mesh, "solution_2"));
  const std::string nodes = file("f.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
  file("f.ele", "1 4 0\n1 1 2 3 4\n");
  file("f.mtr", "4 1\n1\n2\n3\n5\n");
  expect_at_points(*read_size_mesh(nodes));
}

TEST_F(SizeMeshFiles, FieldsOfElementsAreThoseOfTheElements) {
  const std::vector<std::pair<std::string, std::string>> files{
      {file("a.msh", kSizedMsh41), "e"}, {file("c.vtk", kSizedVtk), "of_cell"}, {file("d.vtu", kSizedVtu), "c"}};
  for (const auto& [name, field] : files) {
    const auto mesh = read_size_mesh(name, field);
    EXPECT_TRUE(mesh->point_sizes.empty()) << name;
    EXPECT_EQ(mesh->element_sizes, std::vector<double>{2.5}) << name;
  }
}

TEST_F(SizeMeshFiles, AreNamedWithTheirFields) {
  const std::string name = file("d.vtu", kSizedVtu);
  SizeOptions options;
  read_sizes_into(options, name + ":h");
  ASSERT_TRUE(options.mesh);
  EXPECT_EQ(options.mesh->name, name + ":h");
  EXPECT_FALSE(options.field);
  const std::string refused = refusal(name);
  EXPECT_NE(refused.find("\"h\""), std::string::npos) << refused;
  EXPECT_NE(refused.find("\"c\""), std::string::npos) << refused;
  EXPECT_NE(refusal(name + ":nothing").find("no field \"nothing\""), std::string::npos);
  EXPECT_NE(refusal(file("x.mesh", kSizedMedit)).find("has no field"), std::string::npos);
  EXPECT_NE(refusal(folder_ / "missing.vtu").find("missing.vtu"), std::string::npos);
}

TEST_F(SizeMeshFiles, RefuseSizesThatAreNone) {
  std::string text = kSizedVtk;
  text.replace(text.find("1 2 3 5"), 7, "1 2 0 5");
  EXPECT_NE(refusal(file("zero.vtk", text) + ":h").find("point 2 has size 0"), std::string::npos);
  const std::string mesh = file("e.mesh", kSizedMedit);
  file("e.sol", "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n3\n1 1\n1\n1\n1\nEnd\n");
  EXPECT_NE(refusal(mesh).find("belongs to another mesh"), std::string::npos);
}

TEST_F(SizeMeshFiles, EndWithinAFieldIsSaid) {
  const std::string whole = kSizedMsh22;
  for (const std::size_t end : {whole.find("$NodeData") + 12, whole.find("5 3\n9"), whole.find("$EndNodeData") + 3})
    EXPECT_NE(refusal(file("cut.msh", whole.substr(0, end))), "") << end;
}

}  // namespace
}  // namespace octafront
