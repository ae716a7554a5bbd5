#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/validity.h>

#include "formats/small_files.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::mesh_of;
using testing::TemporaryFolder;
using testing::two_tets;

/// n^3 cubes of six tetrahedra each around their diagonals, in slabs of regions, sides as patches.
TetMesh grid(int n) {
  TetMesh m;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  const auto at = [n](int i, int j, int k) { return static_cast<VertexIndex>((i * (n + 1) + j) * (n + 1) + k); };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) m.points.push_back({i + shift(random), j + shift(random), k + shift(random)});
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        for (int o = 0; o < 6; ++o) {
          std::array<int, 3> g{i, j, k};
          Tet t{at(i, j, k)};
          for (std::size_t s = 0; s < 3; ++s) {
            ++g[static_cast<std::size_t>(kOrders[o][s])];
            t[s + 1] = at(g[0], g[1], g[2]);
          }
          if (o == 1 || o == 2 || o == 5) std::swap(t[2], t[3]);
          m.tets.push_back(t);
          m.region.push_back(static_cast<std::uint32_t>(3 * i / n));
        }
      }
    }
  }
  return m;
}

/// The grid with its boundary, which the MEDIT reader makes.
TetMesh grid_with_patches(int n) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.mesh", grid(n));
  TetMesh m = read_mesh(folder / "a.mesh");
  for (const Triangle& t : m.boundary) {
    const Vec3 normal = cross(m.points[t[1]] - m.points[t[0]], m.points[t[2]] - m.points[t[0]]);
    int axis = 0;
    for (int a = 1; a < 3; ++a)
      if (std::abs(normal[a]) > std::abs(normal[axis])) axis = a;
    m.patch.push_back(static_cast<std::uint32_t>(2 * axis + (normal[axis] > 0)));
    m.source.push_back(m.source.size() % 3 == 0 ? kNone : static_cast<std::uint32_t>(m.source.size()));
  }
  m.patch_names = {"low x", "high \"x\"", "", "a<b & c>d", "z"};
  return m;
}

TEST(WriteMesh, VtuKeepsEverything) {
  const TemporaryFolder folder;
  const TetMesh m = grid_with_patches(9);
  write_mesh(folder / "a.vtu", m);
  const TetMesh back = read_mesh(folder / "a.vtu");
  EXPECT_EQ(back, m);
  EXPECT_EQ(first_defect(back), std::nullopt);
}

TEST(WriteMesh, MeditKeepsNumbersButNoNames) {
  const TemporaryFolder folder;
  TetMesh m = grid_with_patches(4);
  write_mesh(folder / "a.mesh", m);
  m.patch_names.clear();
  m.source.clear();
  EXPECT_EQ(read_mesh(folder / "a.mesh"), m);
}

TEST(WriteMesh, GmshKeepsGroupsAndNames) {
  const TemporaryFolder folder;
  const TetMesh m = grid_with_patches(4);
  write_mesh(folder / "a.msh", m);
  const TetMesh back = read_mesh(folder / "a.msh");
  // Nodes are grouped by entity: compared by place.
  ASSERT_EQ(back.points.size(), m.points.size());
  EXPECT_EQ(back.tets.size(), m.tets.size());
  EXPECT_EQ(back.patch_names, (std::vector<std::string>{"low x", "high _x_", "", "a<b & c>d", "z"}));
  std::vector<std::uint32_t> patches = m.patch, patches_back = back.patch, regions = m.region,
                             regions_back = back.region;
  for (auto* list : {&patches, &patches_back, &regions, &regions_back}) std::sort(list->begin(), list->end());
  EXPECT_EQ(patches_back, patches);
  EXPECT_EQ(regions_back, regions);
}

TEST(WriteMesh, ExactDoubles) {
  const TemporaryFolder folder;
  TetMesh m = two_tets();
  m.points[1] = {1.0 / 3, std::nextafter(0.0, 1.0), -0.0};
  m.points[4] = {1e17 / 3, 0.1, 1 + 1e-16};
  for (const char* name : {"a.vtu", "a.msh", "a.mesh"}) {
    SCOPED_TRACE(name);
    write_mesh(folder / name, m);
    const TetMesh back = read_mesh(folder / name);
    ASSERT_EQ(back.points.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_NE(std::find(back.points.begin(), back.points.end(), m.points[i]), back.points.end());
  }
}

TEST(WriteMesh, WithoutRegionsPatchesAndNames) {
  const TemporaryFolder folder;
  TetMesh m = two_tets();
  m.region.clear();
  m.patch.clear();
  m.patch_names.clear();
  for (const char* name : {"a.vtu", "a.msh", "a.mesh"}) {
    SCOPED_TRACE(name);
    write_mesh(folder / name, m);
    EXPECT_EQ(read_mesh(folder / name), m);
  }
}

TEST(ReadMesh, EveryVariantYieldsTheSame) {
  for (const auto& [name, bytes] : testing::small_mesh_files()) {
    SCOPED_TRACE(name);
    const TetMesh m = mesh_of(bytes, "anything");
    const TetMesh wanted = two_tets();
    EXPECT_EQ(m.points, wanted.points);
    EXPECT_EQ(m.tets, wanted.tets);
    EXPECT_EQ(m.region, wanted.region);
    EXPECT_EQ(m.boundary, wanted.boundary);
    EXPECT_EQ(m.patch, wanted.patch);
    EXPECT_EQ(first_defect(m), std::nullopt);
  }
}

TEST(ReadMesh, OtherFormatsYieldTheSame) {
  const TetMesh wanted = two_tets();
  for (const auto& [name, bytes] : testing::more_mesh_files()) {
    SCOPED_TRACE(name);
    const TetMesh m = mesh_of(bytes, name);
    EXPECT_EQ(m.points, wanted.points);
    EXPECT_EQ(m.tets, wanted.tets);
    EXPECT_EQ(m.region, wanted.region);
    EXPECT_EQ(m.patch, wanted.patch);
    EXPECT_EQ(first_defect(m), std::nullopt);
  }
}

TEST(ReadMesh, AbaqusSetsAreFollowed) {
  const auto files = testing::more_mesh_files();
  const auto other = std::find_if(files.begin(), files.end(), [](const auto& f) { return f.name == "other.inp"; });
  const MeshFile file = io::read_mesh_bytes({"a.inp", other->bytes});
  EXPECT_EQ(file.mesh.region_names, (std::vector<std::string>{"left", "Right part"}));
  EXPECT_EQ(file.mesh.patch_names, (std::vector<std::string>{"in", "out"}));
  std::vector<std::string> sets;
  for (const NamedSet& set : file.mesh.sets) sets.push_back(set.name + " " + std::to_string(set.members.size()));
  EXPECT_EQ(sets, (std::vector<std::string>{"S_1 1", "outer 1", "ALL 5", "some 3"}));
}

TEST(ReadMesh, MissingBoundaryIsAdded) {
  const std::string head = "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  const std::string tail = "Tetrahedra 1\n1 2 3 4 -7\nEnd\n";
  const TetMesh none = mesh_of(head + tail);
  EXPECT_EQ(none.boundary.size(), 4U);
  EXPECT_TRUE(none.patch.empty());
  EXPECT_EQ(first_defect(none), std::nullopt);
  // One given, inside out, twice; one that bounds nothing.
  const TetMesh some = mesh_of(head + "Triangles 3\n1 2 3 1\n1 2 3 1\n1 1 2 1\n" + tail);
  EXPECT_EQ(some.boundary[0], (Triangle{0, 2, 1}));
  EXPECT_EQ(some.patch, (std::vector<std::uint32_t>{0, 1, 1, 1}));
  EXPECT_EQ(first_defect(some), std::nullopt);
}

TEST(ReadMesh, OddReferencesAreLabels) {
  const TetMesh m = mesh_of(
      "MeshVersionFormatted 2\nDimension 3\nVertices 5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 0\n"
      "Tetrahedra 2\n1 2 3 4 2000000000\n2 3 4 5 -1\nEnd\n");
  EXPECT_EQ(m.region, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(m.region_labels, (std::vector<std::int64_t>{-1, 2000000000}));
}

}  // namespace
}  // namespace octafront
