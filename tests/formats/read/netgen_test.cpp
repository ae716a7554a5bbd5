// Netgen's curved elements: a file that Netgen of 2026 saved (tests/corpus/mesh/netgen_order3.vol), and what is not
// taken.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/validity.h>

#include "base/geometry/tet_lattice.h"
#include "formats/cube_text.h"
#include "formats/small_files.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::input_error;
using testing::says;

std::string saved_by_netgen() {
  return testing::file_bytes(std::filesystem::path(OCTAFRONT_CORPUS) / "mesh" / "netgen_order3.vol");
}

std::string with(std::string text, const std::string& what, const std::string& other) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), other);
}

MeshFile netgen_file(const std::string& text) {
  return io::read_mesh_bytes({"x.vol", text});
}

TEST(ReadNetgen, TakesCurvesOfOrder3ThatNetgenSaved) {
  const TetMesh mesh = netgen_file(saved_by_netgen()).mesh;
  ASSERT_EQ(mesh.order(), 3);
  EXPECT_EQ(mesh.points.size(), 30U);
  // x + y^2 z / 5 of the two straight elements.
  const auto added = [](const Vec3& p) { return 0.2 * p.y * p.y * p.z; };
  const TetLattice& lattice = tet_lattice(3);
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 4; k < lattice.size(); ++k) {
      Vec3 place;
      for (std::size_t c = 0; c < 4; ++c) {
        const Vec3 corner = mesh.points[mesh.tets[t][c]];
        place += (corner - Vec3{added(corner), 0, 0}) * (static_cast<double>(lattice.weights(k)[c]) / 3);
      }
      const Vec3 node = mesh.points[mesh.high_nodes[t * mesh.high_nodes_per_tet() + k - 4]];
      EXPECT_LT(length(node - place - Vec3{added(place), 0, 0}), 1e-15);
    }
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(ReadNetgen, TakesElementsAsStraightWhereCurvesAreNotKnown) {
  const std::string text = saved_by_netgen(), end = "0\n3\nf\nt\n";
  for (const std::string& other : {with(text, end, "0\n2\nt\nt\n"), with(text, end, "0\n5\nf\nt\n"),
                                   with(text, "10\n0\n0\n0\n0", "10\n0\n0\n0\n-1"),
                                   with(text, "8\n0\n0\n0\n1\n2\n3\n4\n5\n6\n", "8\n0\n0\n0\n1\n2\n3\n9\n5\n6\n"),
                                   with(text, "9\n1\n1\n1\n1\n1\n3\n", "9\n3\n1\n1\n1\n1\n4\n")}) {
    const MeshFile file = netgen_file(other);
    EXPECT_EQ(file.mesh.order(), 1);
    EXPECT_EQ(file.mesh.points.size(), 5U);
    EXPECT_TRUE(says(file.notes, "curved elements are taken as they are without"));
  }
}

TEST(ReadNetgen, TakesEdgesByTheirDescriptors) {
  std::string text = with(saved_by_netgen(), "edgesegmentsgi3\n0\n",
                          "edgesegmentsgi3\n3\n1 2 -1 -1 0 0 0\n2 3 -1 -1 0 0 1\n3 4 -1 -1 0 .5 2\n");
  text = with(text, "\nendmesh",
              "\nedgedescriptors\n3\n2 0 1 0.0 0.0 -1 0 -1 rim\n1 0 1 0.0 0.0 -1 0 -1 default\n2 0 1 0.0 0.0 -1 0 -1 "
              "rim\n\nendmesh");
  const TetMesh mesh = netgen_file(text).mesh;
  EXPECT_EQ(mesh.curve_edges.size(), 3U);
  EXPECT_EQ(mesh.curve, (std::vector<std::uint32_t>{1, 0, 1}));
  EXPECT_EQ(mesh.curve_names, (std::vector<std::string>{"", "rim"}));
  EXPECT_EQ(mesh.order(), 3);
}

TEST(ReadNetgen, RefusesCurvesThatEnd) {
  const std::string text = saved_by_netgen();
  const auto refused = [](const std::string& damaged) { return input_error([&] { netgen_file(damaged); }); };
  EXPECT_NE(refused(with(text, "curvedelements\n9\n", "curvedelements\n99999999\n")).find("edges"), std::string::npos);
  EXPECT_NE(refused(text.substr(0, text.find("-0.02500000"))), "");
}

}  // namespace
}  // namespace octafront
