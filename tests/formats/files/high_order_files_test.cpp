// Orders 3 and 4: written and read again by every format that holds them, bit for bit, but for Netgen, which has
// coefficients instead of nodes; what others say so.

#include <octafront/io.h>
#include <octafront/validity.h>

#include "formats/small_files.h"
#include "support/mixed_mesh.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::TemporaryFolder;

/// All nodes, so that their order shows.
TetMesh bent_a_little(TetMesh mesh) {
  for (Vec3& p : mesh.points) p = p + Vec3{.03 * std::sin(p.y + .3), .02 * std::cos(p.z), .03 * std::sin(p.x + p.y)};
  return mesh;
}

class OfHighOrder : public ::testing::TestWithParam<std::string> {};

TEST_P(OfHighOrder, ComesBackAsItWas) {
  for (const int order : {3, 4}) {
    SCOPED_TRACE(order);
    const TemporaryFolder folder;
    const TetMesh mesh = bent_a_little(testing::with_high_nodes(testing::rich_mesh(2), order));
    ASSERT_EQ(first_defect(mesh), std::nullopt);
    const auto notes = write_mesh(folder / "mesh", mesh, {}, {.format = GetParam()});
    const bool is_netgen = GetParam() == "netgen";
    EXPECT_EQ(std::ranges::any_of(notes, [](const auto& n) { return n.find("order") != std::string::npos; }),
              is_netgen);
    const TetMesh back = read_mesh(folder / "mesh");
    ASSERT_EQ(back.order(), order);
    ASSERT_EQ(back.points.size(), mesh.points.size());
    EXPECT_EQ(back.tets, mesh.tets);
    EXPECT_EQ(back.region, mesh.region);
    EXPECT_EQ(back.boundary.size(), mesh.boundary.size());
    EXPECT_EQ(back.interfaces.size(), mesh.interfaces.size());
    // Formats may number nodes in another order.
    const std::size_t each = mesh.high_nodes_per_tet();
    for (std::size_t k = 0; k < mesh.high_nodes.size(); ++k) {
      const double off = length(back.points[back.high_nodes[k]] - mesh.points[mesh.high_nodes[k]]);
      const bool is_inner = order == 4 && k % each == each - 1;
      ASSERT_LE(off, !is_netgen ? 0 : is_inner ? 1e-4 : 1e-14) << k;
    }
    EXPECT_EQ(first_defect(back), std::nullopt);
  }
}

std::vector<std::string> formats_of_high_order() {
  std::vector<std::string> names;
  for (const FormatInfo& info : known_formats())
    if (info.holds.high_order && info.reads_mesh && info.writes_mesh) names.emplace_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(, OfHighOrder, ::testing::ValuesIn(formats_of_high_order()),
                         [](const auto& test) { return test.param; });

TEST(HighOrder, IsHeldBySixFormatsThatAreRead) {
  EXPECT_EQ(formats_of_high_order().size(), 6U);  // vtu, vtk, msh, msh22, mfem, netgen
}

TEST(HighOrder, OthersSayWhoHoldsIt) {
  const TemporaryFolder folder;
  const TetMesh mesh = testing::with_high_nodes(testing::rich_mesh(2), 3);
  const auto notes = write_mesh(folder / "mesh.unv", mesh);
  EXPECT_TRUE(std::ranges::any_of(notes, [](const std::string& note) {
    return note.starts_with("I-deas universal holds no elements of order 3") && note.find("mfem") != std::string::npos;
  }));
  EXPECT_EQ(read_mesh(folder / "mesh.unv").order(), 1);
}

TEST(WriteNetgen, SaysWhereNodesInsideElementsGo) {
  const TemporaryFolder folder;
  const TetMesh straight = testing::with_high_nodes(testing::rich_mesh(2), 4);
  const auto said = [&](const TetMesh& mesh) {
    for (const std::string& note : write_mesh(folder / "mesh.vol", mesh))
      if (note.starts_with("Netgen keeps no nodes inside")) return note;
    return std::string();
  };
  EXPECT_NE(said(bent_a_little(straight)).find("48 have the one of order 4 elsewhere, 0 of them are not proven valid"),
            std::string::npos);
  EXPECT_EQ(said(straight), "");
}

TEST(WriteMfem, HasWedgesWhereTheyAreLinear) {
  const TemporaryFolder folder;
  const TetMesh mesh = testing::mixed_mesh(2);
  write_mesh(folder / "linear", mesh, {}, {.format = "mfem"});
  EXPECT_EQ(read_mesh(folder / "linear").wide_cells.size(), mesh.wide_cells.size());
  const auto notes = write_mesh(folder / "second", testing::with_mid_nodes(mesh), {}, {.format = "mfem"});
  EXPECT_TRUE(std::ranges::any_of(notes, [](const std::string& note) {
    return note.find("no wedges and pyramids of order 2") != std::string::npos;
  }));
  EXPECT_EQ(read_mesh(folder / "second").tets.size(), mesh.tets.size());
}

TEST(WriteMfem, IsOfTheVersionThatAllReadWhereNothingHasAName) {
  const TemporaryFolder folder;
  TetMesh mesh = testing::two_tets();
  write_mesh(folder / "named", mesh, {}, {.format = "mfem"});
  EXPECT_TRUE(testing::file_bytes(folder / "named").starts_with("MFEM mesh v1.3\n"));
  mesh.patch_names.clear();
  write_mesh(folder / "unnamed", mesh, {}, {.format = "mfem"});
  EXPECT_TRUE(testing::file_bytes(folder / "unnamed").starts_with("MFEM mesh v1.0\n"));
}

}  // namespace
}  // namespace octafront
