#include <octafront/error.h>
#include <octafront/field_files.h>

#include "support/mixed_mesh.h"
#include "support/rich_mesh.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Two tetrahedra on both sides of a triangle, in two regions.
TetMesh pair_of_tets() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  mesh.region = {0, 1};
  mesh.boundary = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}, {2, 3, 4}, {1, 4, 3}};
  mesh.patch = {0, 0, 0, 1, 1, 1};
  mesh.sets.push_back({"one", NamedSet::Kind::kElements, {1}});
  return mesh;
}

std::vector<MeshField> some_fields() {
  return {{"T", false, 1, {1, 2, 0.1, 4, 1e-300}},
          {"u v", false, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}},
          {"rho", true, 1, {0.25, -3}}};
}

/// Some formats need HDF5.
bool is_known(std::string_view format) {
  for (const FormatInfo& info : known_formats())
    if (info.name == format && info.writes_mesh) return true;
  return false;
}

class FieldFiles : public ::testing::Test {
 protected:
  std::string path_of(const std::string& name) const { return (folder_ / name).string(); }

  const testing::TemporaryFolder folder_;
};

TEST_F(FieldFiles, WhatIsWrittenIsReadAgain) {
  struct Case {
    std::string name, format;
    bool ascii;
    std::size_t fields;  // the readers of MSH and XDMF take single numbers
  };
  for (const Case& c : {Case{"a.vtu", "", false, 3}, Case{"t.vtu", "", true, 3}, Case{"a.vtk", "", false, 3},
                        Case{"t.vtk", "", true, 3}, Case{"a.msh", "", false, 2}, Case{"t.msh", "", true, 2},
                        Case{"b.msh", "msh22", false, 2}, Case{"c.msh", "msh22", true, 2}, Case{"a.xdmf", "", false, 2},
                        Case{"a.med", "", false, 3}}) {
    if (c.name.ends_with("xdmf") && !is_known("xdmf")) continue;
    if (c.name.ends_with("med") && !is_known("med")) continue;
    SCOPED_TRACE(c.name + " " + c.format);
    const std::vector<MeshField> fields = some_fields();
    write_mesh(path_of(c.name), pair_of_tets(), fields, {}, {.format = c.format, .ascii = c.ascii});
    const TetMesh mesh = read_mesh(path_of(c.name));
    const FieldsOfFile read = read_fields(path_of(c.name), mesh);
    EXPECT_EQ(read.notes.size(), c.name.ends_with("xdmf") ? 1u : 0u);  // which says so of vectors
    ASSERT_EQ(read.fields.size(), c.fields);
    for (const MeshField& field : read.fields) {
      bool found = false;
      for (const MeshField& was : fields)
        if (was.name == field.name) {
          found = true;
          EXPECT_EQ(was.of_elements, field.of_elements);
          EXPECT_EQ(was.components, field.components);
          EXPECT_EQ(was.values, field.values);
        }
      EXPECT_TRUE(found) << field.name;
    }
  }
}

TEST_F(FieldFiles, NamedOnesAlone) {
  write_mesh(path_of("a.vtu"), pair_of_tets(), some_fields());
  const TetMesh mesh = read_mesh(path_of("a.vtu"));
  const FieldsOfFile read = read_fields(path_of("a.vtu"), mesh, {"rho"});
  ASSERT_EQ(read.fields.size(), 1u);
  EXPECT_EQ(read.fields[0].name, "rho");
  try {
    read_fields(path_of("a.vtu"), mesh, {"p"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no field \"p\"; there are"), std::string::npos) << error.what();
  }
}

TEST_F(FieldFiles, WhatIsNotFiniteIsLeftOutOrRefused) {
  std::vector<MeshField> fields = some_fields();
  fields[0].values[2] = std::nan("");
  write_mesh(path_of("a.vtu"), pair_of_tets(), fields);
  const TetMesh mesh = read_mesh(path_of("a.vtu"));
  const FieldsOfFile read = read_fields(path_of("a.vtu"), mesh);
  EXPECT_EQ(read.fields.size(), 2u);
  ASSERT_EQ(read.notes.size(), 1u);
  EXPECT_NE(read.notes[0].find("\"T\" is left out: it has values that are not finite"), std::string::npos);
  EXPECT_THROW(read_fields(path_of("a.vtu"), mesh, {"T"}), InputError);
}

TEST_F(FieldFiles, WhatAFormatCannotHoldIsSaid) {
  const std::vector<MeshField> fields = some_fields();
  EXPECT_TRUE(format_for("a.vtu").holds.fields);
  EXPECT_FALSE(format_for("a.inp").holds.fields);
  const auto notes = write_mesh(path_of("a.inp"), pair_of_tets(), fields);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("holds no fields: left out are \"T\", \"u v\", \"rho\"; fields are held by vtu, msh"),
            std::string::npos)
      << notes[0];
  const std::vector<MeshField> pair{{"pair", false, 2, std::vector<double>(10, 1)}};
  const auto of_gmsh = write_mesh(path_of("a.msh"), pair_of_tets(), pair);
  ASSERT_FALSE(of_gmsh.empty());
  EXPECT_NE(of_gmsh[0].find("1, 3 or 9 numbers"), std::string::npos) << of_gmsh[0];
  const std::vector<MeshField> few{{"few", false, 1, {1, 2}}};
  EXPECT_THROW(write_mesh(path_of("few.vtu"), pair_of_tets(), few), OutputError);
  EXPECT_FALSE(std::filesystem::exists(path_of("few.vtu")));
}

/// The middle of the corners of the element that a tetrahedron is, or is a part of.
Vec3 middle_of(const TetMesh& mesh, TetIndex t) {
  std::vector<VertexIndex> corners(mesh.tets[t].begin(), mesh.tets[t].end());
  for (const WideCell& cell : mesh.wide_cells)
    if (t >= cell.first && t < cell.first + cell.tet_count)
      corners.assign(cell.nodes.begin(), cell.nodes.begin() + cell.tet_count + 3);
  Vec3 middle{};
  for (const VertexIndex v : corners) middle = middle + mesh.points[v] / static_cast<double>(corners.size());
  return middle;
}

double value_at(const Vec3& p) {
  return 1 + p.x - 3 * p.y + 5 * p.z;
}

/// One name, at points and in elements.
std::vector<MeshField> fields_by_place(const TetMesh& mesh) {
  std::vector<MeshField> fields{{"T", false, 1, {}}, {"T", true, 1, {}}};
  for (const Vec3& p : mesh.points) fields[0].values.push_back(value_at(p));
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) fields[1].values.push_back(value_at(middle_of(mesh, t)));
  return fields;
}

TEST_F(FieldFiles, MedKeepsThemOfSecondOrderAndInWedges) {
  if (!is_known("med")) GTEST_SKIP();
  for (const TetMesh& mesh : {testing::with_mid_nodes(testing::rich_mesh(3)), testing::mixed_mesh(3)}) {
    EXPECT_TRUE(write_mesh(path_of("a.med"), mesh, fields_by_place(mesh)).empty());
    const TetMesh again = read_mesh(path_of("a.med"));
    ASSERT_EQ(again.wide_cells.size(), mesh.wide_cells.size());
    const FieldsOfFile read = read_fields(path_of("a.med"), again);
    ASSERT_EQ(read.fields.size(), 2u);
    const std::vector<MeshField> right = fields_by_place(again);
    for (std::size_t f = 0; f < 2; ++f) {
      EXPECT_EQ(read.fields[f].of_elements, right[f].of_elements);
      ASSERT_EQ(read.fields[f].values.size(), right[f].values.size());
      for (std::size_t i = 0; i < right[f].values.size(); ++i)
        ASSERT_NEAR(read.fields[f].values[i], right[f].values[i], 1e-12);
    }
  }
}

TEST_F(FieldFiles, NamesAreMadeLegalOnce) {
  const TetMesh mesh = pair_of_tets();
  std::vector<MeshField> fields{{"a/b", false, 1, std::vector<double>(5, 1)}, {"a/b", true, 1, {1, 2}}};
  for (const char* name : {"a.med", "a.cgns"}) {
    if (!is_known(std::string_view(name).substr(2))) continue;
    const auto notes = write_mesh(path_of(name), mesh, fields);
    EXPECT_EQ(std::ranges::count_if(notes, [](const std::string& n) { return n.ends_with("\"a/b\" is a_b"); }), 1);
  }
  // A tail of components stays whole behind a name that is cut.
  fields = {{std::string(300, 'n'), false, 3, std::vector<double>(15, 1)}};
  write_mesh(path_of("a.exo"), mesh, fields);
  std::ifstream file(path_of("a.exo"), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(bytes.find(std::string(200, 'n') + "_z"), std::string::npos);
}

TEST_F(FieldFiles, FieldsOfAnotherMeshAreRefused) {
  write_mesh(path_of("a.vtu"), pair_of_tets(), some_fields());
  TetMesh moved = pair_of_tets();
  moved.points[4].x = 2;
  EXPECT_THROW(read_fields(path_of("a.vtu"), moved), InputError);
}

}  // namespace
}  // namespace octafront
