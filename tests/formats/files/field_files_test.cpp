#include <octafront/error.h>
#include <octafront/field_files.h>

#include <cmath>
#include <filesystem>
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
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("octafront_fields_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(FieldFiles, WhatIsWrittenIsReadAgain) {
  struct Case {
    std::string name, format;
    bool ascii;
    std::size_t fields;  // the readers of MSH and XDMF take single numbers
  };
  for (const Case& c :
       {Case{"a.vtu", "", false, 3}, Case{"t.vtu", "", true, 3}, Case{"a.vtk", "", false, 3},
        Case{"t.vtk", "", true, 3}, Case{"a.msh", "", false, 2}, Case{"t.msh", "", true, 2},
        Case{"b.msh", "msh22", false, 2}, Case{"c.msh", "msh22", true, 2}, Case{"a.xdmf", "", false, 2}}) {
    if (c.name.ends_with("xdmf") && !is_known("xdmf")) continue;
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
  EXPECT_NE(notes[0].find("without the fields"), std::string::npos) << notes[0];
  const std::vector<MeshField> pair{{"pair", false, 2, std::vector<double>(10, 1)}};
  const auto of_gmsh = write_mesh(path_of("a.msh"), pair_of_tets(), pair);
  ASSERT_FALSE(of_gmsh.empty());
  EXPECT_NE(of_gmsh[0].find("1, 3 or 9 numbers"), std::string::npos) << of_gmsh[0];
  const std::vector<MeshField> few{{"few", false, 1, {1, 2}}};
  EXPECT_THROW(write_mesh(path_of("few.vtu"), pair_of_tets(), few), OutputError);
  EXPECT_FALSE(std::filesystem::exists(path_of("few.vtu")));
}

TEST_F(FieldFiles, FieldsOfAnotherMeshAreRefused) {
  write_mesh(path_of("a.vtu"), pair_of_tets(), some_fields());
  TetMesh moved = pair_of_tets();
  moved.points[4].x = 2;
  EXPECT_THROW(read_fields(path_of("a.vtu"), moved), InputError);
}

}  // namespace
}  // namespace octafront
