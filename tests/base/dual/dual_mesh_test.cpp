// The dual of tetrahedral meshes: sound, in the same space, with the patches, regions and layers of the mesh.

#include <octafront/poly_mesh.h>
#include <octafront/run_context.h>

#include "base/dual/poly_faults.h"
#include "base/dual/poly_measures.h"
#include "base/geometry/measures.h"
#include "base/mesh/adjacency.h"
#include "support/mixed_mesh.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

double volume_of(const TetMesh& mesh, std::uint32_t region) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    if ((mesh.region.empty() ? 0 : mesh.region[t]) == region)
      sum += signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  }
  return sum;
}

double volume_of(const PolyMesh& mesh, std::uint32_t region) {
  const std::vector<double> volumes = cell_volumes(mesh);
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cells(); ++c)
    if (mesh.region[c] == region) sum += volumes[c];
  return sum;
}

/// Of all patches, boundary and interfaces.
std::map<std::uint32_t, double> areas_of(const TetMesh& mesh) {
  std::map<std::uint32_t, double> areas;
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f)
    areas[mesh.patch[f]] += triangle_area(mesh.points, mesh.boundary[f]);
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f)
    areas[mesh.interface_patch[f]] += triangle_area(mesh.points, mesh.interfaces[f]);
  return areas;
}

std::map<std::uint32_t, double> areas_of(const PolyMesh& mesh) {
  std::map<std::uint32_t, double> areas;
  for (std::size_t f = 0; f < mesh.faces(); ++f)
    if (mesh.patch[f] != kNone) areas[mesh.patch[f]] += length(dual::measure(mesh, f).area);
  return areas;
}

/// Cubes of a lattice as six tetrahedra each, those for which `is_in`.
TetMesh cubes(int n, const std::function<bool(int, int, int)>& is_in) {
  TetMesh mesh = testing::rich_mesh(n);
  TetMesh some;
  for (const Tet& t : mesh.tets) {
    Vec3 middle;
    for (const VertexIndex v : t) middle += mesh.points[v] / 4;
    if (is_in(static_cast<int>(middle.x), static_cast<int>(middle.y), static_cast<int>(middle.z)))
      some.tets.push_back(t);
  }
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  for (Tet& t : some.tets)
    for (VertexIndex& v : t) {
      if (number[v] == kNone) {
        number[v] = static_cast<VertexIndex>(some.points.size());
        some.points.push_back(mesh.points[v]);
      }
      v = number[v];
    }
  some.boundary = boundary_triangles(some.tets, half_face_neighbors(some.tets, some.points.size()));
  return some;
}

TEST(DualMesh, IsSoundAndKeepsVolumesRegionsAndPatches) {
  const TetMesh mesh = testing::rich_mesh(4);
  const PolyMesh dual = dual_mesh(mesh);
  EXPECT_EQ(first_defect(dual), std::nullopt);
  for (const std::uint32_t region : {0U, 1U}) EXPECT_NEAR(volume_of(dual, region), volume_of(mesh, region), 1e-12);
  const auto expected = areas_of(mesh), found = areas_of(dual);
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [patch, area] : expected) EXPECT_NEAR(found.at(patch), area, 1e-12) << patch;
  EXPECT_TRUE(dual::faults_of(dual).cells.empty());
}

TEST(DualMesh, HasACellForEachVertexAndEachRegionAtIt) {
  const TetMesh mesh = testing::rich_mesh(4);
  std::set<std::pair<VertexIndex, std::uint32_t>> expected, found;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const VertexIndex v : mesh.tets[t]) expected.emplace(v, mesh.region[t]);
  const PolyMesh dual = dual_mesh(mesh);
  for (std::size_t c = 0; c < dual.cells(); ++c) found.emplace(dual.vertex[c], dual.region[c]);
  EXPECT_EQ(found, expected);
  EXPECT_EQ(dual.cells(), expected.size());
}

TEST(DualMesh, KeepsCornersAndFeatureEdges) {
  const PolyMesh dual = dual_mesh(testing::rich_mesh(2));
  for (const Vec3 corner : {Vec3{0, 0, 0}, Vec3{2, 2, 2}, Vec3{2, 0, 1}, Vec3{2, 0, 0.5}})
    EXPECT_NE(std::ranges::find(dual.points, corner), dual.points.end()) << corner.x << corner.y << corner.z;
  // In the middle of a side faces go straight past the vertex.
  EXPECT_EQ(std::ranges::find(dual.points, Vec3{2, 1, 1}), dual.points.end());
}

TEST(DualMesh, DividesCellsWhereABodyBendsInward) {
  const TetMesh mesh = cubes(4, [](int x, int y, int) { return x < 2 || y < 2; });
  const PolyMesh dual = dual_mesh(mesh);
  std::map<VertexIndex, int> cells;
  for (const VertexIndex v : dual.vertex) ++cells[v];
  for (const auto& [v, count] : cells) {
    const bool is_at_ridge = mesh.points[v].x == 2 && mesh.points[v].y == 2;
    EXPECT_EQ(count, is_at_ridge ? 2 : 1) << v;
  }
  EXPECT_NEAR(volume_of(dual, 0), 48, 1e-12);
  EXPECT_TRUE(dual::faults_of(dual).cells.empty());
}

TEST(DualMesh, MakesACellOnEachSideWhereBodiesTouchInAVertexOrEdge) {
  for (const int z : {0, 1}) {
    const TetMesh mesh =
        cubes(2, [z](int x, int y, int k) { return (x == 0 && y == 0 && k == 0) || (x == 1 && y == 1 && k == z); });
    const PolyMesh dual = dual_mesh(mesh);
    EXPECT_EQ(dual.cells(), 16U) << z;
    EXPECT_NEAR(volume_of(dual, 0), 2, 1e-12);
  }
}

TEST(DualMesh, LayersBecomeColumnsOfPrismsAsHighAsTheyAre) {
  const int n = 3;
  const TetMesh mesh = testing::mixed_mesh(n);
  const PolyMesh dual = dual_mesh(mesh);
  const auto layers =
      static_cast<std::uint32_t>(std::ranges::find(mesh.region_names, "layers") - mesh.region_names.begin());
  const Groups<> faces = dual::faces_of_cells(dual);
  std::map<VertexIndex, int> cells;
  for (std::uint32_t c = 0; c < dual.cells(); ++c) {
    const Vec3 at = mesh.points[dual.vertex[c]];
    if (dual.region[c] != layers || at.x < 0.5) continue;
    ++cells[dual.vertex[c]];
    EXPECT_LT(at.z, 0.5) << "the vertices on top have cells above it alone";
    std::set<double> heights;
    int lying = 0;
    for (const std::uint32_t f : faces[c]) {
      for (const VertexIndex p : dual.face(f)) heights.insert(dual.points[p].z);
      const Vec3 normal = normalized(dual::measure(dual, f).area);
      lying += std::abs(normal.z) > 0.999;
      EXPECT_TRUE(std::abs(normal.z) > 0.999 || std::abs(normal.z) < 0.001) << normal.z;
    }
    EXPECT_EQ(heights, (std::set<double>{at.z, at.z + 0.25})) << c;
    EXPECT_EQ(lying, 2);
  }
  EXPECT_EQ(cells.size(), 2U * n * (n + 1)) << "two layers";
  EXPECT_NEAR(volume_of(dual, layers), volume_of(mesh, layers), 1e-12);
  EXPECT_NEAR(volume_of(dual, 1 - layers), volume_of(mesh, 1 - layers), 1e-12);
}

TEST(DualMesh, WedgesThatStandAgainstEachOtherAreTakenAsTetrahedra) {
  TetMesh mesh = testing::mixed_mesh(3);
  auto& n = std::ranges::find(mesh.wide_cells, 3U, &WideCell::tet_count)->nodes;
  n = {n[3], n[5], n[4], n[0], n[2], n[1]};
  const PolyMesh dual = dual_mesh(mesh);
  EXPECT_EQ(first_defect(dual), std::nullopt);
  const std::vector<double> volumes = cell_volumes(dual);
  EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0), volume_of(mesh, 0) + volume_of(mesh, 1), 1e-12);
}

TEST(DualMesh, IsTheSameForAnyNumberOfThreadsAndOrders) {
  const TetMesh mesh = testing::mixed_mesh(6);
  RunContext one, several;
  one.threads = 1;
  several.threads = 4;
  const PolyMesh dual = dual_mesh(mesh, one);
  EXPECT_EQ(dual_mesh(mesh, several), dual);
  const PolyMesh linear = dual_mesh(testing::rich_mesh(4));
  EXPECT_EQ(dual_mesh(testing::with_mid_nodes(testing::rich_mesh(4))), linear) << "mid-side nodes are not looked at";
}

TEST(DualMesh, CurvedSurfacesLoseAboutAsMuchAsTheTetrahedra) {
  // A lattice bent onto a ball: the boundary's vertices lie on the sphere.
  TetMesh mesh = cubes(6, [](int, int, int) { return true; });
  for (Vec3& p : mesh.points) {
    const Vec3 q = p - Vec3{3, 3, 3};
    const double r = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    p = r == 0 ? q : q * (r / length(q));
  }
  const double ball = 4.0 / 3.0 * 3.14159265358979 * 27;
  const PolyMesh dual = dual_mesh(mesh);
  // Faces between middles of triangles alone would lose twice as much.
  EXPECT_LT(ball - volume_of(dual, 0), 1.2 * (ball - volume_of(mesh, 0)));
}

class BrokenDual : public ::testing::Test {
 protected:
  PolyMesh mesh = dual_mesh(testing::rich_mesh(2));
  std::string defect() const { return first_defect(mesh).value_or("none"); }
};

TEST_F(BrokenDual, AFaceLessIsFound) {
  const auto n = mesh.face(mesh.faces() - 1).size();
  mesh.face_begin.pop_back(), mesh.owner.pop_back(), mesh.patch.pop_back();
  mesh.face_points.resize(mesh.face_points.size() - n);
  EXPECT_NE(defect().find("is not closed"), std::string::npos) << defect();
}

TEST_F(BrokenDual, ATurnedFaceIsFound) {
  std::reverse(mesh.face_points.begin() + static_cast<std::ptrdiff_t>(mesh.face_begin[5]),
               mesh.face_points.begin() + static_cast<std::ptrdiff_t>(mesh.face_begin[6]));
  EXPECT_NE(defect().find("is not closed"), std::string::npos) << defect();
}

TEST_F(BrokenDual, CellsInsideOutAreFound) {
  for (Vec3& p : mesh.points) p.x = -p.x;
  EXPECT_NE(defect().find("has the volume -"), std::string::npos) << defect();
}

TEST_F(BrokenDual, WrongIndicesAndOrderAreFound) {
  PolyMesh whole = mesh;
  mesh.face_points[7] = static_cast<VertexIndex>(mesh.points.size());
  EXPECT_EQ(defect(), "a face names a point that is not there");
  mesh = whole;
  mesh.owner[3] = static_cast<std::uint32_t>(mesh.cells());
  EXPECT_EQ(defect(), "a face names a cell that is not there");
  mesh = whole;
  std::swap(mesh.owner[0], mesh.neighbour[0]);
  EXPECT_NE(defect().find("cells out of order"), std::string::npos) << defect();
  mesh = whole;
  mesh.points.push_back({});
  EXPECT_NE(defect().find("is in no face"), std::string::npos) << defect();
}

}  // namespace
}  // namespace octafront
