// Bulk data as other programs write it: systems of coordinates, includes, fields that are left out.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/surface_mesh.h>

#include "formats/cube_text.h"
#include "formats/small_files.h"

#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::says;
using testing::volume_of;

const std::string kTet = "CTETRA,1,1,1,2,3,4\n";
/// Of a tetrahedron along the axes of the system.
std::string grids(int system) {
  return fmt::format("GRID,1,{0},0.,0.,0.\nGRID,2,{0},1.,0.,0.\nGRID,3,{0},0.,1.,0.\nGRID,4,{0},0.,0.,1.\n", system);
}
MeshFile bulk(const std::string& text) {
  return io::read_mesh_bytes({"x.bdf", "BEGIN BULK\n" + text + "ENDDATA\nGRID,1,,9.,9.,9.\n"});
}

TEST(ReadNastran, SystemsByPoints) {
  const TetMesh shifted = bulk("CORD2R,5,0,10.,0.,0.,10.,0.,1.\n,10.,1.,0.\n" + grids(5) + kTet).mesh;
  EXPECT_EQ(bounding_box(shifted.points).lo, (Vec3{9, 0, 0}));
  EXPECT_EQ(bounding_box(shifted.points).hi, (Vec3{10, 1, 1}));
  // One within another one.
  const TetMesh nested =
      bulk("CORD2R,6,5,0.,0.,2.,0.,0.,3.\n,1.,0.,2.\nCORD2R,5,0,10.,0.,0.,10.,0.,1.\n,11.,0.,0.\n" + grids(6) + kTet)
          .mesh;
  EXPECT_EQ(bounding_box(nested.points).lo, (Vec3{10, 0, 2}));
}

TEST(ReadNastran, RoundSystemsAndTheirDefault) {
  const std::string system = "CORD2C,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n";
  const std::string rows = "GRID,1,{0},0.,0.,0.\nGRID,2,{0},1.,0.,0.\nGRID,3,{0},1.,90.,0.\nGRID,4,{0},0.,0.,1.\n";
  EXPECT_EQ(volume_of(bulk(system + fmt::format(fmt::runtime(rows), "5") + kTet).mesh), 1.0 / 6);
  EXPECT_EQ(volume_of(bulk(system + "GRDSET,,5\n" + fmt::format(fmt::runtime(rows), "") + kTet).mesh), 1.0 / 6);
  const std::string ball =
      "CORD2S,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,5,0.,0.,0.\nGRID,2,5,1.,90.,0.\n"
      "GRID,3,5,1.,90.,90.\nGRID,4,5,1.,0.,0.\n";
  EXPECT_EQ(volume_of(bulk(ball + kTet).mesh), 1.0 / 6);
}

TEST(ReadNastran, SystemsByGridPoints) {
  const TetMesh mesh =
      bulk("GRID,11,,5.,0.,0.\nGRID,12,,5.,0.,1.\nGRID,13,,6.,0.,0.\nCORD1R,7,11,12,13\n" + grids(7) + kTet).mesh;
  EXPECT_EQ(bounding_box(mesh.points).lo, (Vec3{5, 0, 0}));
}

TEST(ReadNastran, SystemsThatAreNotThereOrGoInCircles) {
  EXPECT_NE(testing::input_error([] { bulk(grids(5) + kTet); }).find("system of coordinates 5"), std::string::npos);
  EXPECT_NE(
      testing::input_error([] {
        bulk("CORD2R,5,6,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,6,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n" + grids(5) + kTet);
      }).find("by itself"),
      std::string::npos);
}

TEST(ReadNastran, MidSideNodesThatAreLeftOutAreInTheMiddle) {
  const MeshFile file = bulk(grids(0) + "GRID,5,,.5,-.1,0.\nGRID,8,,0.,0.,.5\nCTETRA,1,1,1,2,3,4,5\n,,,8\n");
  ASSERT_TRUE(file.mesh.is_second_order());
  EXPECT_EQ(file.mesh.points.size(), 10U);
  EXPECT_TRUE(says(file.notes, "4 mid-side nodes"));
  const auto& mids = file.mesh.mid_nodes[0];
  EXPECT_EQ(file.mesh.points[mids[5]], (Vec3{0, .5, .5}));
  // Shared with a neighbour that has them.
  const MeshFile two = bulk(grids(0) +
                            "GRID,5,,1.,1.,1.\nGRID,6,,.6,.6,.1\nGRID,7,,1.,.5,.5\nCTETRA,1,1,1,2,3,4,,6\n"
                            "CTETRA,2,1,2,3,4,5,,\n,,7\n");
  ASSERT_TRUE(two.mesh.is_second_order());
  EXPECT_EQ(two.mesh.points.size(), 5U + 9U);
}

TEST(ReadNastran, FilesBesideAreRead) {
  const testing::TemporaryFolder folder;
  testing::write_bytes(folder / "part.bdf", grids(0) + kTet);
  testing::write_bytes(folder / "a.bdf", "SOL 101\nCEND\nBEGIN BULK\nINCLUDE 'part.bdf'\nENDDATA\n");
  EXPECT_EQ(volume_of(read_mesh(folder / "a.bdf")), 1.0 / 6);
  testing::write_bytes(folder / "b.bdf", "BEGIN BULK\nINCLUDE 'gone.bdf'\n" + grids(0) + kTet + "ENDDATA\n");
  EXPECT_TRUE(says(read_mesh_file(folder / "b.bdf").notes, "\"gone.bdf\""));
}

TEST(ReadNastran, TabsLeadToTheNextField) {
  const TetMesh mesh =
      bulk(
          "GRID\t1\t\t0.\t0.\t0.\nGRID\t2\t\t1.\t0.\t0.\nGRID\t3\t\t0.\t1.\t0.\nGRID\t4\t\t0.\t0.\t1.\n"
          "CTETRA\t1\t1\t1\t2\t3\t4\n")
          .mesh;
  EXPECT_EQ(volume_of(mesh), 1.0 / 6);
}

}  // namespace
}  // namespace octafront
