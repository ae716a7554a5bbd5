// Physical groups that overlap, and elements of no group, as Gmsh writes them.

#include <octafront/io.h>
#include <octafront/validity.h>

#include "formats/cube_text.h"
#include "formats/small_files.h"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::cube_nodes;
using testing::kCubeTets;
using testing::mesh_of;
using testing::sets_of;
using testing::volume_of;

/// "NAME 2" for each region or patch, in the order of their numbers.
std::string sizes(const std::vector<std::uint32_t>& numbers, const std::vector<std::string>& names) {
  std::map<std::uint32_t, int> count;
  for (const std::uint32_t n : numbers) ++count[n];
  std::string all;
  for (const auto& [n, size] : count)
    all += (all.empty() ? "" : ", ") + (n < names.size() ? names[n] : "") + " " + std::to_string(size);
  return all;
}

/// Entities of surfaces 1 and 2 are the faces at z = 0 and z = 1; that of x = 0, 3, is in no group.
const std::string kNames =
    "$MeshFormat\n{} 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n2 4 \"inlet\" lower_dimensional_block\n2 3 \"walls\"\n3 9 "
    "\"fluid\"\n3 8 "
    "\"half\"\n"
    "$EndPhysicalNames\n";
const std::string kBottom = "1 3 2;1 4 3", kTop = "5 6 7;5 7 8", kSide = "1 8 4;1 5 8";

std::string split_rows(const std::string& rows, const std::string& head, int& number) {
  std::string text;
  for (std::size_t at = 0; at < rows.size();) {
    const std::size_t end = std::min(rows.find(';', at), rows.size());
    text += fmt::format("{}{}{}\n", number++, head, rows.substr(at, end - at));
    at = end + 1;
  }
  return text;
}

TEST(ReadMsh, GroupsThatOverlapAreSetsWhole) {
  int number = 1;
  const std::string text =
      fmt::format(fmt::runtime(kNames), "4.1") +
      "$Entities\n0 0 3 1\n1 0 0 0 1 1 0 2 4 3 0\n2 0 0 1 1 1 1 1 4 0\n3 0 0 0 0 1 1 0 0\n1 0 0 0 1 1 1 1 9 0\n"
      "$EndEntities\n$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 "
      "1\n0 1 1\n$EndNodes\n$Elements\n4 12 1 12\n2 1 2 2\n" +
      split_rows(kBottom, " ", number) + "2 2 2 2\n" + split_rows(kTop, " ", number) + "2 3 2 2\n" +
      split_rows(kSide, " ", number) + "3 1 4 6\n" +
      [&] {
        std::string rows;
        for (const auto& t : kCubeTets) rows += fmt::format("{} {} {} {} {}\n", number++, t[0], t[1], t[2], t[3]);
        return rows;
      }() +
      "$EndElements\n";
  const TetMesh mesh = mesh_of(text);
  // What is in no group is apart, whatever the tag of its entity is: 3 is a group, too.
  EXPECT_EQ(sizes(mesh.patch, mesh.patch_names), " 2, walls 2,  2,  6");
  EXPECT_EQ(sets_of(mesh), "inlet 4");
  EXPECT_EQ(mesh.region_names.back(), "fluid");
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(ReadMsh, VersionTwoListsElementsOnceForEachGroup) {
  int number = 1;
  std::string rows;
  rows += split_rows(kBottom, " 2 2 3 1 ", number) + split_rows(kBottom, " 2 2 4 1 ", number) +
          split_rows(kTop, " 2 2 4 2 ", number);
  for (const auto& t : kCubeTets) rows += fmt::format("{} 4 2 9 1 {} {} {} {}\n", number++, t[0], t[1], t[2], t[3]);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& t = kCubeTets[i];
    rows += fmt::format("{} 4 2 8 1 {} {} {} {}\n", number++, t[0], t[1], t[2], t[3]);
  }
  const std::string text = fmt::format(fmt::runtime(kNames), "2.2") + "$Nodes\n8\n" + cube_nodes(" ") +
                           fmt::format("$EndNodes\n$Elements\n{}\n{}$EndElements\n", number - 1, rows);
  const TetMesh mesh = mesh_of(text);
  EXPECT_EQ(mesh.tets.size(), 6U);
  EXPECT_NEAR(volume_of(mesh), 1, 1e-12);
  EXPECT_EQ(sizes(mesh.region, mesh.region_names), " 4, half 2");
  EXPECT_EQ(sets_of(mesh), "inlet 4, fluid 6");
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

/// One tetrahedron of Gmsh's type, all nodes but its corners beside each other.
MeshFile one_element(int type, int count) {
  std::string nodes, corners;
  int n = 0;
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{3, 0, 0}, Vec3{0, 3, 0}, Vec3{0, 0, 3}})
    nodes += fmt::format("{} {} {} {}\n", ++n, p.x, p.y, p.z);
  while (n < count) nodes += fmt::format("{0} {0} .1 .1\n", ++n);
  for (int v = 1; v <= count; ++v) corners += fmt::format(" {}", v);
  return io::read_mesh_bytes(
      {"x", fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n1\n1 {} 2 1 1{}\n"
                        "$EndElements\n",
                        count, nodes, type, corners)});
}

TEST(ReadMsh, ElementsOfOrder3And4KeepTheirNodes) {
  for (const auto& [type, count, order] : {std::array{29, 20, 3}, std::array{30, 35, 4}}) {
    const MeshFile file = one_element(type, count);
    EXPECT_EQ(file.mesh.order(), order);
    EXPECT_EQ(file.mesh.points.size(), static_cast<std::size_t>(count));
    // Of the edge from corner 0 to corner 1; Gmsh's fourth edge leads from corner 3 to corner 0, ours the other way.
    EXPECT_EQ(file.mesh.points[file.mesh.high_nodes[0]].x, 5);
    const std::size_t inside = static_cast<std::size_t>(order) - 1;
    EXPECT_EQ(file.mesh.points[file.mesh.high_nodes[2 * inside]].x, 4 + 4 * static_cast<double>(inside));
  }
}

TEST(ReadMsh, ElementsOfHigherOrderAreTakenAsLinear) {
  const MeshFile file = one_element(31, 56);
  EXPECT_EQ(file.mesh.points.size(), 4U);
  EXPECT_EQ(volume_of(file.mesh), 4.5);
  EXPECT_TRUE(testing::says(file.notes, "1 elements of order 3"));
}

}  // namespace
}  // namespace octafront
