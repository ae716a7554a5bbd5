// Decks as Abaqus/CAE and people write them: parts, instances, includes, systems of coordinates.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/surface_mesh.h>
#include <octafront/validity.h>

#include "formats/cube_text.h"
#include "formats/small_files.h"

#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::cube_nodes;
using testing::cube_tets;
using testing::says;
using testing::sets_of;
using testing::volume_of;

const std::string kNodes = "*Node\n" + cube_nodes(), kElements = "*Element, type=C3D4\n" + cube_tets();

MeshFile deck(const std::string& text) {
  return io::read_mesh_bytes({"x.inp", "*Heading\n" + text});
}
std::string box_of(const TetMesh& mesh) {
  const Box3 box = bounding_box(mesh.points);
  return fmt::format("{:g} {:g} {:g} to {:g} {:g} {:g}", box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z);
}

TEST(ReadAbaqus, PartsStandWhereTheirInstancesAre) {
  const MeshFile file =
      deck("*Part, name=P\n" + kNodes + kElements + "*Elset, elset=all, generate\n1, 6, 1\n*End Part\n" +
           "*Part, name=Q\n" + kNodes + kElements + "*Elset, elset=steel, generate\n1, 6, 1\n*End Part\n" +
           "*Assembly, name=A\n*Instance, name=P-1, part=p\n*End Instance\n*Instance, name=Q-1, "
           "part=Q\n1., 0., 0.\n*End Instance\n*Nset, nset=load, instance=Q-1\n2, 3, 6, 7\n"
           "*Elset, elset=_s_S1, internal, instance=P-1\n1, 2\n*Surface, type=ELEMENT, name=s\n_s_S1, "
           "S1\n*Nset, nset=both\nP-1.1, Q-1.2\n*End Assembly\n");
  EXPECT_EQ(file.mesh.tets.size(), 12U);
  EXPECT_NEAR(volume_of(file.mesh), 2, 1e-12);
  EXPECT_EQ(box_of(file.mesh), "0 0 0 to 2 1 1");
  EXPECT_EQ(file.mesh.region_names, (std::vector<std::string>{"P-1", "Q-1"}));
  EXPECT_EQ(file.mesh.patch_names, (std::vector<std::string>{"s"}));
  EXPECT_EQ(sets_of(file.mesh), "all 6, steel 6, load 4, both 2");
}

TEST(ReadAbaqus, InstancesAreShiftedThenTurned) {
  const std::string part = "*Part, name=P\n" + kNodes + kElements + "*Nset, nset=fix, generate\n1, 4, 1\n*End Part\n";
  const MeshFile one = deck(part +
                            "*Assembly, name=A\n*Instance, name=P-1, part=P\n100., 0., 0.\n100.,0.,0.,100.,0.,1.,90.\n"
                            "*End Instance\n*Nset, nset=load, instance=P-1\n5,6,7,8\n*End Assembly\n");
  EXPECT_EQ(box_of(one.mesh), "99 0 0 to 100 1 1");
  EXPECT_EQ(sets_of(one.mesh), "load 4, fix 4");
  const MeshFile two = deck(part +
                            "*Assembly, name=A\n*Instance, name=P-1, part=P\n*End Instance\n*Instance, name=P-2, "
                            "part=P\n0., 0., 5.\n*End Instance\n*End Assembly\n");
  EXPECT_EQ(box_of(two.mesh), "0 0 0 to 1 1 6");
  EXPECT_EQ(two.mesh.region_names, (std::vector<std::string>{"P-1", "P-2"}));
  EXPECT_EQ(sets_of(two.mesh), "P-1.fix 4, P-2.fix 4");
  EXPECT_EQ(first_defect(two.mesh), std::nullopt);
}

TEST(ReadAbaqus, SaysWhichPartsAreLeftOut) {
  const MeshFile file = deck("*Part, name=P\n" + kNodes + kElements + "*End Part\n*Part, name=spare\n" + kNodes +
                             "*End Part\n*Assembly, name=A\n*Instance, name=P-1, part=P\n*End Instance\n*Instance, "
                             "name=gone-1, part=gone\n*End Instance\n*End Assembly\n");
  EXPECT_TRUE(says(file.notes, "\"spare\" has no instance"));
  EXPECT_TRUE(says(file.notes, "no part \"gone\""));
}

TEST(ReadAbaqus, KeywordsComeInAnyOrderAndGoOnInTheNextLine) {
  EXPECT_NEAR(volume_of(deck(kElements + kNodes).mesh), 1, 1e-12);
  const MeshFile file = deck(kNodes + "*ELEMENT,\nTYPE=C3D4,\n ELSET=E\n" + cube_tets());
  EXPECT_EQ(file.mesh.region_names, (std::vector<std::string>{"E"}));
  EXPECT_EQ(file.mesh.tets.size(), 6U);
}

TEST(ReadAbaqus, SystemsOfCoordinates) {
  EXPECT_EQ(box_of(deck("*SYSTEM\n10.,0.,0.,11.,0.,0.\n10.,1.,0.\n" + kNodes + kElements).mesh), "10 0 0 to 11 1 1");
  EXPECT_EQ(box_of(deck("*SYSTEM\n10.,0.,0.,10.,1.,0.\n9.,0.,0.\n" + kNodes + kElements).mesh), "9 0 0 to 10 1 1");
  EXPECT_EQ(box_of(deck("*SYSTEM\n0.,0.,7.\n" + kNodes + kElements).mesh), "0 0 7 to 1 1 8");
  const std::string tet = "*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n";
  const TetMesh round = deck("*NODE, SYSTEM=C\n1, 0,0,0\n2,1,0,0\n3,1,90,0\n4,0,0,1\n" + tet).mesh;
  EXPECT_EQ(volume_of(round), 1.0 / 6);
  const TetMesh ball = deck("*NODE, SYSTEM=S\n1, 0,0,0\n2,1,0,0\n3,1,90,0\n4,1,0,90\n" + tet).mesh;
  EXPECT_EQ(volume_of(ball), 1.0 / 6);
}

TEST(ReadAbaqus, FilesBesideTheDeckAreRead) {
  const testing::TemporaryFolder folder;
  testing::write_bytes(folder / "nodes.inp", "*NODE, NSET=N\n" + cube_nodes());
  testing::write_bytes(folder / "rows.csv", cube_nodes());
  testing::write_bytes(folder / "a.inp", "*HEADING\n*INCLUDE, INPUT=nodes.inp\n" + kElements);
  testing::write_bytes(folder / "b.inp", "*HEADING\n*NODE, INPUT=rows.csv\n" + kElements);
  for (const char* name : {"a.inp", "b.inp"}) EXPECT_NEAR(volume_of(read_mesh(folder / name)), 1, 1e-12) << name;
  testing::write_bytes(folder / "itself.inp", "*HEADING\n*INCLUDE, INPUT=itself.inp\n" + kNodes + kElements);
  EXPECT_NE(testing::input_error([&] { read_mesh(folder / "itself.inp"); }).find("includes too many"),
            std::string::npos);
}

TEST(ReadAbaqus, SaysWhichFilesAreNotRead) {
  const testing::TemporaryFolder folder;
  testing::write_bytes(folder / "a.inp",
                       kNodes + kElements + "*INCLUDE, INPUT=steel.inp\n*INCLUDE, INPUT=/etc/hosts\n");
  const MeshFile file = read_mesh_file(folder / "a.inp");
  EXPECT_TRUE(says(file.notes, "\"steel.inp\""));
  EXPECT_TRUE(says(file.notes, "\"/etc/hosts\""));
  testing::write_bytes(folder / "b.inp", "*NODE, INPUT=rows.csv\n" + kElements);
  EXPECT_NE(testing::input_error([&] { read_mesh(folder / "b.inp"); }).find("rows.csv"), std::string::npos);
}

TEST(ReadAbaqus, SurfacesOfFreeSidesShellsAndNodes) {
  const MeshFile file =
      deck(kNodes + kElements + "*ELEMENT, TYPE=S3, ELSET=skin\n11, 1, 3, 2\n*ELSET, ELSET=E\n1, 2\n" +
           "*SURFACE, NAME=free\nE\n*SURFACE, NAME=shell\nskin, SPOS\n*NSET, NSET=N\n1, 2\n" +
           "*SURFACE, NAME=nodes, TYPE=NODE\nN\n");
  EXPECT_EQ(sets_of(file.mesh), "free 4, shell 1, nodes 2, N 2");
}

TEST(ReadAbaqus, NodesThatAreGeneratedAreNamed) {
  EXPECT_TRUE(says(deck(kNodes + kElements + "*NGEN\n1, 4, 1\n").notes, "*NGEN"));
}

}  // namespace
}  // namespace octafront
