// MEDIT's files: numbers as they are, what is required, both byte orders.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/named_groups.h>
#include <octafront/validity.h>

#include "formats/cube_text.h"
#include "formats/small_files.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::kCubeNodes;
using testing::kCubeTets;
using testing::says;
using testing::sets_of;

/// The cube with these references of its first three tetrahedra and of the others, of its two faces at z = 0 and a
/// further section.
std::string cube(std::int64_t first, std::int64_t others, std::int64_t face, const std::string& more = {},
                 const std::string& vertex = "0") {
  std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices\n8\n";
  for (const Vec3& p : kCubeNodes) text += fmt::format("{} {} {} {}\n", p.x, p.y, p.z, vertex);
  text += fmt::format("Edges\n1\n1 2 {0}\nTriangles\n2\n1 3 2 {0}\n1 4 3 {0}\nTetrahedra\n6\n", face);
  for (std::size_t i = 0; i < kCubeTets.size(); ++i)
    text += fmt::format("{} {} {} {} {}\n", kCubeTets[i][0], kCubeTets[i][1], kCubeTets[i][2], kCubeTets[i][3],
                        i < 3 ? first : others);
  return text + more + "End\n";
}

/// The references in a section of a file.
std::vector<std::string> references(const std::string& text, const std::string& section) {
  std::vector<std::string> refs;
  std::size_t at = text.find("\n" + section + "\n");
  at = text.find('\n', text.find('\n', at + 1) + 1) + 1;
  for (; at < text.size() && text[at] != '\n'; at = text.find('\n', at) + 1) {
    const std::string line = text.substr(at, text.find('\n', at) - at);
    const std::string ref = line.substr(line.rfind(' ') + 1);
    if (std::find(refs.begin(), refs.end(), ref) == refs.end()) refs.push_back(ref);
  }
  return refs;
}

TEST(ReadMedit, NumbersAreWrittenAsTheyWere) {
  const testing::TemporaryFolder folder;
  struct Refs {
    std::int64_t first, others, face;
  };
  for (const auto& [first, others, face] : {Refs{0, 5, 0}, Refs{0, 1, 0}, Refs{2, 5, -3}, Refs{7, 2000001, 3000000},
                                            Refs{-4, -9, 1}, Refs{3, 3, 20}, Refs{0, 0, 0}}) {
    SCOPED_TRACE(fmt::format("{} {} {}", first, others, face));
    testing::write_bytes(folder / "a.mesh", cube(first, others, face));
    for (const char* name : {"b.mesh", "b.meshb"}) {
      write_mesh(folder / name, read_mesh(folder / "a.mesh"));
      write_mesh(folder / "c.mesh", read_mesh(folder / name));
      const std::string text = testing::file_bytes(folder / "c.mesh");
      std::vector<std::string> wanted{std::to_string(first)};
      if (others != first) wanted.push_back(std::to_string(others));
      EXPECT_EQ(references(text, "Tetrahedra"), wanted) << name;
      EXPECT_EQ(references(text, "Triangles")[0], std::to_string(face)) << name;
      EXPECT_EQ(references(text, "Edges"), std::vector<std::string>{std::to_string(face)}) << name;
    }
  }
}

TEST(ReadMedit, OtherFormatsSayWhichNumbersTheyChange) {
  const testing::TemporaryFolder folder;
  testing::write_bytes(folder / "a.mesh", cube(0, 5, -3));
  const TetMesh mesh = read_mesh(folder / "a.mesh");
  const auto notes = write_mesh(folder / "a.msh", mesh);
  EXPECT_TRUE(says(notes, "other numbers of regions: 1 for 0, 2 for 5")) << notes.size();
  EXPECT_TRUE(says(notes, "other numbers of patches: 1 for -3"));
  // Numbers that other formats can hold stay.
  testing::write_bytes(folder / "b.mesh", cube(7, 2000001, 3000000));
  write_mesh(folder / "b.msh", read_mesh(folder / "b.mesh"));
  write_mesh(folder / "c.mesh", read_mesh(folder / "b.msh"));
  EXPECT_EQ(references(testing::file_bytes(folder / "c.mesh"), "Tetrahedra"),
            (std::vector<std::string>{"7", "2000001"}));
  // VTU has numbers of regions beside.
  write_mesh(folder / "d.vtu", mesh);
  write_mesh(folder / "d.mesh", read_mesh(folder / "d.vtu"));
  EXPECT_EQ(references(testing::file_bytes(folder / "d.mesh"), "Tetrahedra"), (std::vector<std::string>{"0", "5"}));
}

const std::string kRequired =
    "Corners\n2\n1\n2\nRequiredVertices\n1\n7\nRidges\n1\n1\nRequiredEdges\n1\n1\nRequiredTriangles\n1\n2\n"
    "RequiredTetrahedra\n2\n1\n6\n";

TEST(ReadMedit, WhatIsRequiredIsKeptByEveryFormat) {
  const testing::TemporaryFolder folder;
  testing::write_bytes(folder / "a.mesh", cube(1, 1, 1, kRequired));
  const MeshFile file = read_mesh_file(folder / "a.mesh");
  const std::string all =
      "Corners 2, Ridges 1, RequiredEdges 1, RequiredTriangles 1, RequiredTetrahedra 2, RequiredVertices 1";
  const auto sorted = [](const TetMesh& mesh) {
    std::vector<std::string> names;
    for (const NamedSet& set : mesh.sets)
      names.push_back(fmt::format("{} {} {}", set.name, static_cast<int>(set.kind), set.members.size()));
    std::sort(names.begin(), names.end());
    return names;
  };
  EXPECT_EQ(sorted(file.mesh).size(), 6U) << sets_of(file.mesh);
  EXPECT_TRUE(file.notes.empty() || !says(file.notes, "Required"));
  for (const char* name : {"b.mesh", "b.meshb", "b.vtu", "b.msh"}) {
    const auto notes = write_mesh(folder / name, file.mesh);
    EXPECT_FALSE(says(notes, "Required")) << name;
    EXPECT_EQ(sorted(read_mesh(folder / name)), sorted(file.mesh)) << name;
  }
  const std::string text = testing::file_bytes(folder / "b.mesh");
  EXPECT_NE(text.find("\nRequiredTriangles\n1\n2\n"), std::string::npos);
  EXPECT_NE(text.find("\nRequiredVertices\n1\n7\n"), std::string::npos);
}

TEST(ReadMedit, OfASurfaceTheyHavePlaces) {
  const std::string text = cube(1, 1, 1, kRequired);
  const std::string surface =
      text.substr(0, text.find("Tetrahedra\n")) + "RequiredTriangles\n1\n2\nCorners\n1\n3\nEnd\n";
  const SurfaceFile file = testing::surface_of(surface);
  ASSERT_EQ(file.sets.size(), 2U);
  EXPECT_EQ(file.sets[0].places, (std::vector<Vec3>{{1, 1, 0}}));
  EXPECT_EQ(file.sets[1].places, (std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(testing::surface_of(text).sets.size(), 5U) << "but for tetrahedra";
}

TEST(PlacedSets, AreFoundByTheirPlaces) {
  TetMesh mesh = testing::mesh_of(cube(1, 1, 1));
  mesh.curve_edges.clear(), mesh.curve.clear();
  const std::vector<PlacedSet> sets{{"RequiredVertices", NamedSet::Kind::kNodes, {{1, 1, 1}, {9, 9, 9}}},
                                    {"RequiredEdges", NamedSet::Kind::kEdges, {{0, 0, 0}, {1, 0, 0}}},
                                    {"RequiredTriangles", NamedSet::Kind::kFaces, {{1, 1, 0}, {0, 0, 0}, {0, 1, 0}}},
                                    {"mine", NamedSet::Kind::kNodes, {{0, 0, 0}, {.5, 0, 0}}}};
  const std::string missing = add_placed_sets(mesh, sets);
  EXPECT_EQ(sets_of(mesh), "RequiredVertices 1, RequiredEdges 1, RequiredTriangles 1");
  EXPECT_NE(missing.find("\"RequiredVertices\" (1 of 2 nodes missing), \"mine\" (1 of 2"), std::string::npos)
      << missing;
  EXPECT_EQ(mesh.curve_edges.size(), 1U);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(ReadMedit, SaysWhatIsLeftOut) {
  const MeshFile file = io::read_mesh_bytes({"x", cube(1, 1, 1, "Normals\n1\n0 0 1\nRequiredEdges\n1\n9\n", "12")});
  EXPECT_TRUE(says(file.notes, "8 vertices have reference numbers (12 to 12)"));
  EXPECT_TRUE(says(file.notes, "sections left out: Normals"));
  EXPECT_TRUE(says(file.notes, "1 of RequiredEdges name none of the 1 Edges"));
}

TEST(MeditBinary, IsVersionTwoAndReadInEitherByteOrder) {
  const testing::TemporaryFolder folder;
  const TetMesh mesh = testing::mesh_of(cube(2, 5, -3, kRequired));
  write_mesh(folder / "a.meshb", mesh);
  std::string bytes = testing::file_bytes(folder / "a.meshb");
  EXPECT_EQ(bytes.substr(0, 8), std::string("\1\0\0\0\2\0\0\0", 8));
  // All words are of four bytes but coordinates, which are those of vertices.
  std::string swapped;
  const std::size_t first = 8 + 12 + 12, last = first + 28 * mesh.points.size();
  for (std::size_t at = 0; at < bytes.size();) {
    const bool is_real = at >= first && at < last && (at - first) % 28 < 24;
    const std::size_t size = is_real ? 8 : 4;
    swapped.append(bytes.rbegin() + static_cast<std::ptrdiff_t>(bytes.size() - at - size),
                   bytes.rbegin() + static_cast<std::ptrdiff_t>(bytes.size() - at));
    at += size;
  }
  EXPECT_EQ(testing::mesh_of(swapped), testing::mesh_of(bytes));
}

TEST(ReadMedit, WallsBetweenRegionsThatTheFileLacksAreMade) {
  const SurfaceFile file = testing::surface_of(cube(0, 5, -3));
  EXPECT_TRUE(says(file.notes, "2 faces between regions"));
  EXPECT_EQ(file.surface.region_labels, (std::vector<std::int64_t>{0, 5}));
  EXPECT_EQ(std::count(file.surface.sides.begin(), file.surface.sides.end(), Sides{0, 1}) +
                std::count(file.surface.sides.begin(), file.surface.sides.end(), Sides{1, 0}),
            2);
  EXPECT_EQ(file.surface.patch_labels[0], -3);
  // Of one region alone a plain surface, with its number.
  const SurfaceFile one = testing::surface_of(cube(7, 7, 1));
  EXPECT_TRUE(one.surface.sides.empty());
  EXPECT_EQ(one.surface.region_labels, (std::vector<std::int64_t>{7}));
}

TEST(ReadMedit, EndMayBeMissing) {
  const std::string text = cube(1, 2, 3);
  const MeshFile file = io::read_mesh_bytes({"x", text.substr(0, text.size() - 4)});
  EXPECT_EQ(file.mesh.tets.size(), 6U);
  EXPECT_TRUE(says(file.notes, "no End"));
}

}  // namespace
}  // namespace octafront
