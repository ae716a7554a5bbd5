// Wedges, pyramids and quadrilaterals in files: written and read again, linear and of second order, and as others
// write them. What others make of the files is judged by tests/formats.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/validity.h>

#include "base/geometry/predicates.h"
#include "formats/small_files.h"
#include "support/mixed_mesh.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::mesh_of;
using testing::TemporaryFolder;

std::string file_of(const FormatInfo& info) {
  const std::string_view ending = info.endings.substr(0, info.endings.find(' '));
  return "mesh" + (ending.empty() ? ".mesh" : std::string(ending));
}

double volume_of(const TetMesh& mesh, std::uint32_t region) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const auto& p = mesh.points;
    if ((mesh.region.empty() ? 0 : mesh.region[t]) == region)
      sum += dot(cross(p[b] - p[a], p[c] - p[a]), p[d] - p[a]) / 6;
  }
  return sum;
}

/// Places of the corners of each wide cell, sorted: formats may number nodes anew.
std::multiset<std::vector<std::array<double, 3>>> placed_cells(const TetMesh& mesh) {
  std::multiset<std::vector<std::array<double, 3>>> all;
  for (const WideCell& cell : mesh.wide_cells) {
    std::vector<std::array<double, 3>> corners;
    for (std::size_t k = 0; k < cell.tet_count + 3; ++k) {
      const Vec3 p = mesh.points[cell.nodes[k]];
      corners.push_back({p.x, p.y, p.z});
    }
    std::sort(corners.begin(), corners.end());
    all.insert(corners);
  }
  return all;
}

/// Coordinates that all formats hold exactly.
TetMesh in_eighths(TetMesh mesh) {
  for (Vec3& p : mesh.points) p = p + Vec3{0.5 * p.z + 0.125, 0.25 * p.x, 0};
  return mesh;
}

TEST(MixedMesh, IsValid) {
  for (const bool second : {false, true}) {
    TetMesh mesh = testing::mixed_mesh(3);
    if (second) mesh = testing::bent_quadratically(testing::with_mid_nodes(std::move(mesh)));
    EXPECT_EQ(first_defect(mesh), std::nullopt);
    EXPECT_EQ(std::ranges::count(mesh.wide_cells, 2u, &WideCell::tet_count), 6);
    EXPECT_EQ(std::ranges::count(mesh.wide_cells, 3u, &WideCell::tet_count), 36);
    EXPECT_EQ(mesh.wide_faces.size(), 18u);
  }
}

class WideCells : public ::testing::TestWithParam<std::string> {};

TEST_P(WideCells, AreKept) {
  const auto all = known_formats();
  const auto info = std::find_if(all.begin(), all.end(), [](const FormatInfo& i) { return i.name == GetParam(); });
  for (const bool second : {false, true}) {
    if (second && !info->holds.curved_wide_cells) continue;
    SCOPED_TRACE(second ? "second order" : "linear");
    TetMesh mesh = in_eighths(testing::mixed_mesh(3));
    if (second) mesh = testing::with_mid_nodes(std::move(mesh));
    const TemporaryFolder folder;
    const WriteOptions options{.format = GetParam()};
    write_mesh(folder / file_of(*info), mesh, {}, options);
    const MeshFile once = read_mesh_file(folder / file_of(*info));
    EXPECT_EQ(once.turned, 0u);
    const TetMesh& back = once.mesh;
    EXPECT_EQ(first_defect(back), std::nullopt);
    EXPECT_EQ(back.points.size(), mesh.points.size());
    EXPECT_EQ(back.tets.size(), mesh.tets.size());
    EXPECT_EQ(back.is_second_order(), second);
    EXPECT_EQ(placed_cells(back), placed_cells(mesh));
    EXPECT_EQ(back.boundary.size(), mesh.boundary.size());
    EXPECT_EQ(back.wide_faces.size(), mesh.wide_faces.size());
    EXPECT_EQ(back.interfaces.size(), mesh.interfaces.size());
    for (const std::uint32_t region : {0u, 1u}) EXPECT_NEAR(volume_of(back, region), volume_of(mesh, region), 1e-9);
    if (info->holds.element_sets) {
      const auto same = std::ranges::find(back.sets, std::string("some_elements"), &NamedSet::name);
      ASSERT_NE(same, back.sets.end());
      EXPECT_EQ(same->members.size(), mesh.sets[2].members.size());
    }
    write_mesh(folder / "again.mesh", back, {}, options);
    const TetMesh twice = read_mesh(folder / "again.mesh");
    EXPECT_EQ(twice.points, back.points);
    EXPECT_EQ(twice.tets, back.tets);
    EXPECT_EQ(twice.mid_nodes, back.mid_nodes);
    EXPECT_EQ(twice.wide_cells, back.wide_cells);
    EXPECT_EQ(twice.wide_faces, back.wide_faces);
  }
}

std::vector<std::string> formats_with_wedges() {
  std::vector<std::string> names;
  for (const FormatInfo& info : known_formats())
    if (info.reads_mesh && info.writes_mesh && info.holds.wide_cells) names.emplace_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(, WideCells, ::testing::ValuesIn(formats_with_wedges()),
                         [](const auto& test) { return test.param; });

TEST(FaceLayers, AreKeptByVtk) {
  TetMesh mesh = testing::mixed_mesh(2);
  for (std::size_t f = 0; f < mesh.boundary.size() + mesh.interfaces.size(); ++f)
    mesh.face_layers.push_back(f < mesh.boundary.size() && mesh.patch[f] == 0 ? 2 : kNone);
  for (const auto& file : {"a.vtu", "a.vtk"}) {
    const TemporaryFolder folder;
    write_mesh(folder / file, mesh);
    const TetMesh back = read_mesh(folder / file);
    ASSERT_EQ(back.face_layers.size(), mesh.face_layers.size());
    EXPECT_EQ(std::ranges::count(back.face_layers, 2u), std::ranges::count(mesh.face_layers, 2u));
    for (std::size_t f = 0; f < back.boundary.size(); ++f) EXPECT_EQ(back.face_layers[f] == 2, back.patch[f] == 0);
  }
}

TEST(CurvedWideCells, HaveNoNodesOnDiagonalsInFiles) {
  const TemporaryFolder folder;
  const TetMesh mesh = testing::with_mid_nodes(testing::mixed_mesh(2));
  std::set<std::array<VertexIndex, 2>> diagonals;
  for (const WideCell& cell : mesh.wide_cells)
    for (TetIndex t = cell.first; t < cell.first + cell.tet_count; ++t)
      for (const auto& [i, j] : kTetEdges) {
        const auto place = [&](int k) {
          return std::find(cell.nodes.begin(), cell.nodes.end(), mesh.tets[t][static_cast<std::size_t>(k)]) -
                 cell.nodes.begin();
        };
        const auto [a, b] = std::minmax({place(i), place(j)});
        const bool is_wedge = cell.tet_count == 3;
        const bool is_own = is_wedge ? a / 3 == b / 3 || b - a == 3 : b == 4 || b - a != 2;
        if (is_own) continue;
        const VertexIndex u = mesh.tets[t][static_cast<std::size_t>(i)], v = mesh.tets[t][static_cast<std::size_t>(j)];
        diagonals.insert({std::min(u, v), std::max(u, v)});
      }
  write_mesh(folder / "a.vtu", mesh, {}, {.ascii = true});
  const std::string text = testing::file_bytes(folder / "a.vtu");
  EXPECT_FALSE(diagonals.empty());
  EXPECT_NE(text.find("NumberOfPoints=\"" + std::to_string(mesh.points.size() - diagonals.size()) + "\""),
            std::string::npos);
}

TEST(CurvedWideCells, GetTheirDiagonalsBack) {
  const TemporaryFolder folder;
  TetMesh mesh = testing::with_mid_nodes(testing::mixed_mesh(2));
  for (Vec3& p : mesh.points) p = p + Vec3{0, 0, 0.1 * p.x * p.x - 0.05 * p.y * p.y};
  write_mesh(folder / "a.vtu", mesh);
  const TetMesh back = read_mesh(folder / "a.vtu");
  std::map<std::array<VertexIndex, 2>, Vec3> middle;
  const auto for_each_edge = [](const TetMesh& of, const auto& visit) {
    for (std::size_t t = 0; t < of.tets.size(); ++t)
      for (std::size_t e = 0; e < 6; ++e) {
        const VertexIndex a = of.tets[t][static_cast<std::size_t>(kTetEdges[e][0])],
                          b = of.tets[t][static_cast<std::size_t>(kTetEdges[e][1])];
        visit(std::array{std::min(a, b), std::max(a, b)}, of.points[of.mid_nodes[t][e]]);
      }
  };
  for_each_edge(mesh, [&](const auto& edge, const Vec3& at) { middle[edge] = at; });
  double farthest = 0;
  std::size_t edges = 0;
  for_each_edge(back, [&](const auto& edge, const Vec3& at) {
    ++edges;
    ASSERT_TRUE(middle.contains(edge));
    farthest = std::max(farthest, length(at - middle[edge]));
  });
  EXPECT_EQ(edges, 6 * mesh.tets.size());
  EXPECT_LE(farthest, 1e-14);
}

TEST(ReadMesh, QuadrilateralsThatTheFileLacksAreMade) {
  const TetMesh mesh = mesh_of(
      "MeshVersionFormatted 2\nDimension 3\nVertices\n6\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n0 1 1 0\n"
      "Prisms\n1\n1 2 3 4 5 6 7\nEnd\n",
      "a.mesh");
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  ASSERT_EQ(mesh.wide_cells.size(), 1u);
  EXPECT_EQ(mesh.tets.size(), 3u);
  EXPECT_EQ(mesh.boundary.size(), 8u);
  EXPECT_EQ(mesh.wide_faces.size(), 3u);
}

TEST(ReadMesh, WedgesThatAllFaceTheOtherWayAreTurned) {
  const MeshFile file = io::read_mesh_bytes(
      {"a.mesh",
       "MeshVersionFormatted 2\nDimension 3\nVertices\n7\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n0 1 1 0\n"
       "0 0 2 0\nTetrahedra\n1\n4 5 6 7 1\nPrisms\n1\n1 3 2 4 6 5 7\nEnd\n"});
  EXPECT_EQ(first_defect(file.mesh), std::nullopt);
  EXPECT_EQ(file.turned, 0u);
  ASSERT_EQ(file.mesh.wide_cells.size(), 1u);
  const auto& w = file.mesh.wide_cells[0].nodes;
  const auto& p = file.mesh.points;
  EXPECT_GT(orient3d(p[w[0]], p[w[1]], p[w[2]], p[w[3]]), 0);
  EXPECT_EQ(file.notes.size(), 1u);
}

TEST(ReadMesh, OneInvertedWedgeIsADefect) {
  const MeshFile file = io::read_mesh_bytes(
      {"a.mesh",
       "MeshVersionFormatted 2\nDimension 3\nVertices\n9\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n0 1 1 0\n"
       "0 0 2 0\n1 0 2 0\n0 1 2 0\nPrisms\n2\n1 3 2 4 6 5 7\n4 5 6 7 8 9 7\nEnd\n"});
  EXPECT_EQ(first_defect(file.mesh), std::nullopt);
  EXPECT_EQ(first_wide_defect(file.mesh), std::nullopt);
  EXPECT_EQ(file.turned, 3u);
  EXPECT_EQ(file.turned_wide, 1u);
}

TEST(ReadMesh, DamagedFilesWithWedgesAreReadOrRefused) {
  std::mt19937 random(7);
  const TemporaryFolder folder;
  int read = 0, refused = 0;
  for (const FormatInfo& info : known_formats()) {
    const bool is_hdf5 = info.name == "med" || info.name == "xdmf";
    if (!info.reads_mesh || !info.holds.wide_cells || is_hdf5) continue;
    TetMesh mesh = testing::mixed_mesh(1);
    if (info.holds.curved_wide_cells) mesh = testing::with_mid_nodes(std::move(mesh));
    write_mesh(folder / file_of(info), mesh, {}, {.format = std::string(info.name), .ascii = info.also_text});
    const std::string whole = testing::file_bytes(folder / file_of(info));
    for (int i = 0; i < 200; ++i) {
      std::string bytes = whole;
      for (int k = 0; k < 1 + i % 3; ++k) bytes[random() % bytes.size()] = "0123456789 -.\n"[random() % 14];
      try {
        const TetMesh found = mesh_of(bytes, file_of(info));
        first_defect(found);
        first_wide_defect(found);
        write_mesh(folder / "again.vtu", found);
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 100);
}

constexpr const char* kDeck = R"(*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 0, 1, 0
4, 0, 0, 1
5, 1, 0, 1
6, 0, 1, 1
7, .5, -1, .5
8, .5, .5, 2
*ELEMENT, TYPE=C3D6, ELSET=LAYERS
10, 1, 2, 3, 4, 5, 6
*ELEMENT, TYPE=C3D5, ELSET=LAYERS
20, 1, 4, 5, 2, 7
*ELEMENT, TYPE=C3D4, ELSET=REST
30, 4, 5, 6, 8
*SURFACE, NAME=SIDE, TYPE=ELEMENT
10, S4
10, S1
20, S2
)";

TEST(ReadMesh, AbaqusHasWedgesAndPyramids) {
  const TetMesh mesh = mesh_of(kDeck, "a.inp");
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  ASSERT_EQ(mesh.wide_cells.size(), 2u);
  EXPECT_EQ(mesh.tets.size(), 6u);
  ASSERT_EQ(mesh.region_names, (std::vector<std::string>{"LAYERS", "REST"}));
  EXPECT_EQ(mesh.patch_names.at(0), "SIDE");
  // S4 is the quadrilateral 2 3 6 5, S1 of each the triangles 1 2 3 and 1 4 7.
  EXPECT_EQ(std::ranges::count(mesh.patch, 0u), 4);
  EXPECT_EQ(mesh.wide_faces.size(), 2u);  // that one, and 3 1 4 6
}

TEST(ReadMesh, WedgesWithAnEdgeOfNoLengthArePyramids) {
  std::string deck = kDeck;
  const std::string pyramid = "*ELEMENT, TYPE=C3D5, ELSET=LAYERS\n20, 1, 4, 5, 2, 7\n";
  deck.replace(deck.find(pyramid), pyramid.size(), "20, 2, 1, 7, 5, 4, 7\n");
  deck.replace(deck.find("20, S2"), 6, "20, S1");
  const TetMesh mesh = mesh_of(deck, "a.inp");
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  ASSERT_EQ(mesh.wide_cells.size(), 2u);
  EXPECT_EQ(mesh.wide_cells[1].tet_count, 2u);
  EXPECT_EQ(mesh.tets.size(), 6u);
  EXPECT_EQ(std::ranges::count(mesh.patch, 0u), 4);
}

/// Two cubes side by side as hexahedra, with a quadrilateral of the boundary, beside a tetrahedron on top of the first.
std::string hexahedra(const std::string& second) {
  return "MeshVersionFormatted 2\nDimension 3\nVertices\n13\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 "
         "1 "
         "0\n0 1 1 0\n2 0 0 0\n2 1 0 0\n2 0 1 0\n2 1 1 0\n.5 .5 2 0\nQuadrilaterals\n1\n1 4 3 2 4\nHexahedra\n2\n1 2 3 "
         "4 5 6 7 "
         "8 1\n" +
         second + "\nTetrahedra\n1\n5 6 7 13 1\nEnd\n";
}

TEST(ReadMesh, HexahedraAreDividedAlikeOnBothSides) {
  for (const char* second : {"2 9 10 3 6 11 12 7 2", "12 10 3 7 11 9 2 6 2", "7 12 11 6 3 10 9 2 2"}) {
    SCOPED_TRACE(second);
    const MeshFile file = io::read_mesh_bytes({"x", hexahedra(second)});
    EXPECT_EQ(file.mesh.tets.size(), 13U);
    EXPECT_EQ(file.mesh.boundary.size(), 22U);
    EXPECT_NEAR(volume_of(file.mesh, 1), 1, 1e-12);
    EXPECT_NEAR(volume_of(file.mesh, 0), 1 + 1.0 / 6, 1e-12);
    EXPECT_EQ(std::count(file.mesh.patch.begin(), file.mesh.patch.end(), 3U), 2);
  }
}

}  // namespace
}  // namespace octafront
