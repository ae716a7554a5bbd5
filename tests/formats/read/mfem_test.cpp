// MFEM's files: one that MFEM 4.9.1 saved (tests/corpus/mesh/mfem_order4.mesh), whose nodes lie at Gauss and Lobatto's
// points of a curved map; other kinds of nodes, names, and what is refused.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/validity.h>

#include "base/geometry/tet_lattice.h"
#include "formats/cube_text.h"
#include "formats/small_files.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::input_error;
using testing::says;

/// Of degree 4 in x alone: where it leads from is known.
Vec3 on_map(const Vec3& p) {
  return {p.x + 0.2 * p.y * p.y * p.z * p.z, p.y, p.z};
}
Vec3 before_map(const Vec3& p) {
  return {p.x - 0.2 * p.y * p.y * p.z * p.z, p.y, p.z};
}

/// How far the farthest node lies from where the map has it.
double farthest_from_map(const TetMesh& mesh) {
  const TetLattice& lattice = tet_lattice(mesh.order());
  double farthest = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t k = 4; k < lattice.size(); ++k) {
      Vec3 place;
      for (std::size_t c = 0; c < 4; ++c)
        place += before_map(mesh.points[mesh.tets[t][c]]) * (static_cast<double>(lattice.weights(k)[c]) / mesh.order());
      const Vec3 node = mesh.order() == 2 ? mesh.points[mesh.mid_nodes[t][k - 4]]
                                          : mesh.points[mesh.high_nodes[t * mesh.high_nodes_per_tet() + k - 4]];
      farthest = std::max(farthest, length(node - on_map(place)));
    }
  return farthest;
}

TEST(ReadMfem, TakesNodesOfOrder4ThatMfemSaved) {
  const MeshFile file = read_mesh_file(std::filesystem::path(OCTAFRONT_CORPUS) / "mesh" / "mfem_order4.mesh");
  EXPECT_EQ(file.format, "MFEM");
  EXPECT_EQ(file.mesh.order(), 4);
  EXPECT_EQ(file.mesh.points.size(), 55U);
  EXPECT_EQ(file.mesh.region, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(file.mesh.patch_names, (std::vector<std::string>{"in & out", "walls"}));
  EXPECT_EQ(file.mesh.boundary.size(), 6U);
  EXPECT_LT(farthest_from_map(file.mesh), 4e-15);
  EXPECT_EQ(first_defect(file.mesh), std::nullopt);
}

/// One element, with this head, nodes and end.
std::string one_tet(const std::string& nodes, const std::string& version = "v1.0", const std::string& sets = {}) {
  return fmt::format(
      "MFEM mesh {}\n# a comment\ndimension\n3\nelements\n1\n7 4 0 1 2 3\n{}boundary\n0\n{}vertices\n4\n{}", version,
      sets.empty() ? "" : "attribute_sets\n" + sets, sets.empty() ? "" : "bdr_attribute_sets\n0\n", nodes);
}
std::string space(const std::string& collection, int ordering, const std::string& values) {
  return fmt::format("nodes\nFiniteElementSpace\nFiniteElementCollection: {}\nVDim: 3\nOrdering: {}\n\n{}", collection,
                     ordering, values);
}

/// The nodes of the unit tetrahedron of order 2, in the order and at the places of a space.
const std::string kContinuous = "0 0 0 1 0 0 0 1 0 0 0 1 .5 0 0 0 .5 0 0 0 .5 .5 .5 0 .5 0 .5 0 .5 .5";
const std::string kByX = "0 1 0 0 .5 0 0 .5 .5 0  0 0 1 0 0 .5 0 .5 0 .5  0 0 0 1 0 0 .5 0 .5 .5";
const std::string kDiscontinuous = "0 0 0 .5 0 0 1 0 0 0 .5 0 .5 .5 0 0 1 0 0 0 .5 .5 0 .5 0 .5 .5 0 0 1";

TEST(ReadMfem, TakesContinuousAndDiscontinuousNodesInEitherOrder) {
  for (const std::string& nodes :
       {space("Quadratic", 1, kContinuous), space("H1_3D_P2", 0, kByX), space("H1@U_3D_P2", 1, kContinuous),
        space("H1Pos_3D_P2", 1, kContinuous), space("L2_T4_3D_P2", 1, kDiscontinuous),
        space("L2_T1_3D_P2", 1, kDiscontinuous), space("L2_T2_3D_P2", 1, kDiscontinuous)}) {
    SCOPED_TRACE(nodes);
    const TetMesh mesh = testing::mesh_of(one_tet(nodes));
    ASSERT_EQ(mesh.points.size(), 10U);
    EXPECT_EQ(mesh.points[mesh.mid_nodes[0][4]], (Vec3{.5, 0, .5}));
    for (std::size_t e = 0; e < 6; ++e) {
      const Vec3 a = mesh.points[mesh.tets[0][static_cast<std::size_t>(kTetEdges[e][0])]],
                 b = mesh.points[mesh.tets[0][static_cast<std::size_t>(kTetEdges[e][1])]];
      EXPECT_EQ(mesh.points[mesh.mid_nodes[0][e]], (a + b) / 2);
    }
  }
}

TEST(ReadMfem, PutsInnerPointsOfGaussAndLegendreOnTheEdges) {
  // Two points of four inside: values of a linear function at other places are its own.
  std::string values;
  const double near = 0.5 - std::sqrt(1.0 / 12), far = 1 - near, sum = 3 * near + far;
  for (const int corner : {-1, 0, 1, 2})
    for (int axis = 0; axis < 3; ++axis) values += fmt::format(" {}", (axis == corner ? far : near) / sum);
  const TetMesh mesh = testing::mesh_of(one_tet(space("L2_3D_P1", 1, values)));
  ASSERT_EQ(mesh.points.size(), 4U);
  EXPECT_LT(length(mesh.points[0]), 1e-15);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(mesh.points[static_cast<std::size_t>(axis) + 1][axis], 1, 1e-15);
}

TEST(ReadMfem, NamesAreSetsOfOneAttributeOthersAreSets) {
  const std::string vertices = "3\n0 0 0 1 0 0 0 1 0 0 0 1\n";
  const MeshFile file = io::read_mesh_bytes(
      {"x", one_tet(vertices, "v1.3", "3\n\"the \\\"best\\\" # part\"\n1\n7\nall\n2\n7 8\nnobody\n0\n")});
  EXPECT_EQ(file.mesh.region_names.back(), "the \"best\" # part");
  ASSERT_EQ(file.mesh.sets.size(), 1U);
  EXPECT_EQ(file.mesh.sets[0].name, "all");
  EXPECT_EQ(file.mesh.sets[0].members, std::vector<std::uint32_t>{0});
}

TEST(ReadMfem, SaysWhatItDoesNotTake) {
  const auto message = [](const std::string& bytes) { return input_error([&] { testing::mesh_of(bytes); }); };
  const auto expect = [&](const std::string& bytes, const std::string& part) {
    EXPECT_NE(message(bytes).find(part), std::string::npos) << message(bytes);
  };
  expect("MFEM NC mesh v1.0\n", "no conforming mesh");
  expect("MFEM INLINE mesh v1.0\n", "where MFEM saves it");
  expect("MFEM mesh v1.0\ndimension\n2\n", "line 3: the mesh is of dimension 2");
  expect(one_tet(space("NURBS2", 1, "")), "\"NURBS2\" are not read");
  expect(one_tet(space("H1_3D_P3", 1, kContinuous)), "has 10 nodes, not 20");
  expect(one_tet(space("L2_T1_3D_P5", 1, "")), "order 1 to 4");
  expect(one_tet("3\n0 0 0 1 0 0 0 1 0"), "vertices");
  expect("MFEM mesh v1.0\ndimension\n3\nelements\n99999999999\n", "elements");
  expect("MFEM mesh v1.0\ndimension\n3\nelements\n1\n1 9 0 1 2 3\n", "no kind of element 9");
  expect("MFEM mesh v1.0\ndimension\n3\nelements\n1\n1 4 0 1 2 5\nboundary\n0\nvertices\n4\n3\n", "vertex 5");
  expect("MFEM mesh v1.3\ndimension\n3\nelements\n1\n1 4 0 1 2 3\nattribute_sets\n1\n\"open", "does not end");
}

TEST(ReadMfem, RefusesNeighboursThatLieApart) {
  const std::string two =
      "MFEM mesh v1.0\ndimension\n3\nelements\n2\n1 4 0 1 2 3\n1 4 1 2 3 4\nboundary\n0\nvertices\n5\n" +
      space("L2_T1_3D_P1", 1, "0 0 0 1 0 0 0 1 0 0 0 1  1 0 0 0 1 0 0 0 1.1 1 1 1");
  EXPECT_NE(input_error([&] { testing::mesh_of(two); }).find("periodic"), std::string::npos);
}

TEST(ReadMfem, TakesElementsOfHigherOrderAsLinear) {
  std::string values = kContinuous;
  for (int k = 10; k < 56; ++k) values += " .1 .1 .1";
  const MeshFile file = io::read_mesh_bytes({"x", one_tet(space("H1_3D_P5", 1, values))});
  EXPECT_EQ(file.mesh.order(), 1);
  EXPECT_EQ(file.mesh.points.size(), 4U);
  EXPECT_TRUE(says(file.notes, "order 5 are taken as linear"));
}

}  // namespace
}  // namespace octafront
