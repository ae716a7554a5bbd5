#include "fill/lattice/stuff.h"

#include <octafront/error.h>
#include <octafront/quality.h>
#include <octafront/validity.h>

#include "base/geometry/measures.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/surface_topology.h"
#include "fill/lattice/manifold.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Defects = SurfaceDomain::Defects;

TetMesh stuffed(const SurfaceMesh& surface, double size, Defects defects = Defects::kClean) {
  StageReport report;
  return stuff_surface(surface, detect_features(surface, 40), defects, SizeField::uniform(size), {{}, report});
}

double volume_of(const TetMesh& mesh) {
  SurfaceMesh boundary;
  boundary.points = mesh.points;
  boundary.triangles = mesh.boundary;
  return enclosed_volume(boundary);
}

// Labelle & Shewchuk 2007 prove 10.7 to 164.8 degrees for any smooth boundary.
TEST(Stuffing, KeepsThePublishedAnglesOnSmoothSurfaces) {
  for (const double size : {0.21, 0.12, 0.07})
    for (const SurfaceMesh& s : {testing::icosphere(5), testing::torus(96, 48), testing::hollow_sphere(5)}) {
      const TetMesh mesh = stuffed(s, size);
      EXPECT_EQ(first_defect(mesh), std::nullopt);
      const QualitySummary q = summarize_quality(mesh);
      EXPECT_GE(q.dihedral_min, 10.7);
      EXPECT_LE(q.dihedral_max, 164.8);
      EXPECT_NEAR(volume_of(mesh) / enclosed_volume(s), 1, size * size);
    }
}

TEST(Stuffing, BoundaryVerticesLieOnASmoothSurface) {
  const SurfaceMesh sphere = testing::icosphere(5);
  const TriangleTree tree(sphere);
  const TetMesh mesh = stuffed(sphere, 0.1);
  for (const Triangle& t : mesh.boundary)
    for (const VertexIndex v : t) EXPECT_LE(tree.nearest(mesh.points[v]).squared_distance, 1e-20);
  EXPECT_TRUE(is_closed_manifold(mesh.boundary, mesh.points.size()));
}

TEST(Stuffing, SnapsToCornersAndCurves) {
  const SurfaceMesh cube = testing::cube(4);
  StageReport report;
  const TetMesh mesh =
      stuff_surface(cube, detect_features(cube, 40), Defects::kClean, SizeField::uniform(0.09), {{}, report});
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner{double(c & 1), double(c >> 1 & 1), double(c >> 2)};
    EXPECT_NE(std::find(mesh.points.begin(), mesh.points.end(), corner), mesh.points.end()) << c;
  }
  EXPECT_NEAR(volume_of(mesh), 1, 2e-3);  // bluntness costs a cube of this size .011
  EXPECT_GT(summarize_quality(mesh).beta_min, 0.1);
}

/// Corners of one body pull vertices of the other across a gap far below the element size.
TEST(Stuffing, SnapsNoPartOfTheBoundaryThroughAnother) {
  double undone = 0;
  for (const double gap : {0.003, 0.01, 0.03}) {
    const SurfaceMesh turned = testing::transformed(testing::cube(4), 0.7, {1 + gap, 0.11, 0.13});
    const SurfaceMesh two = testing::joined(testing::cube(4), turned);
    for (const double size : {0.13, 0.2, 0.29}) {
      StageReport report;
      const TetMesh mesh =
          stuff_surface(two, detect_features(two, 40), Defects::kClean, SizeField::uniform(size), {{}, report});
      EXPECT_EQ(first_defect(mesh), std::nullopt);
      EXPECT_TRUE(self_intersections(mesh.points, mesh.boundary).empty()) << gap << " " << size;
      for (const auto& [name, value] : report.counters)
        if (name == "snaps undone where the boundary met itself") undone += value;
    }
  }
  EXPECT_GT(undone, 0) << "the case does not test what it should";
}

TEST(Stuffing, NamesPatchSourceAndRegion) {
  const SurfaceMesh two = testing::joined(testing::cube(3), testing::transformed(testing::cube(3), 1, {2, 0, 0}));
  const TetMesh mesh = stuffed(two, 0.15);
  ASSERT_EQ(mesh.source.size(), mesh.boundary.size());
  ASSERT_EQ(mesh.patch.size(), mesh.boundary.size());
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) EXPECT_EQ(mesh.patch[f], two.patch[mesh.source[f]]);
  ASSERT_EQ(mesh.region.size(), mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    EXPECT_EQ(mesh.region[t] == mesh.region[0],
              (mesh.points[mesh.tets[t][0]].x > 1.5) == (mesh.points[mesh.tets[0][0]].x > 1.5));
}

TEST(Stuffing, ClosesHoles) {
  SurfaceMesh sphere = testing::icosphere(4);
  std::erase_if(sphere.triangles, [&](const Triangle& t) { return sphere.points[t[0]].z > 0.9; });
  const TetMesh mesh = stuffed(sphere, 0.12, Defects::kOpen);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_TRUE(is_closed_manifold(mesh.boundary, mesh.points.size()));
  EXPECT_NEAR(volume_of(mesh) / (4 * std::numbers::pi / 3), 1, 0.03);
}

TEST(Stuffing, UnitesOverlappingShells) {
  const SurfaceMesh two =
      testing::joined(testing::icosphere(4), testing::transformed(testing::icosphere(4), 1, {0.8, 0, 0}));
  const TetMesh mesh = stuffed(two, 0.12, Defects::kClosed);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_TRUE(mesh.region.empty());
  // Two unit spheres at distance d: 8 pi / 3 less the lens pi (4 + d) (2 - d)^2 / 12.
  const double lens = std::numbers::pi * (4 + 0.8) * (1.2 * 1.2) / 12;
  EXPECT_NEAR(volume_of(mesh) / (8 * std::numbers::pi / 3 - lens), 1, 0.02);
}

TEST(Stuffing, IsValidWhereSizesChangeAlongTheSurface) {
  const auto sizes = SizeField::from_function(
      [](Vec3 p) {
        return 0.04 + 0.15 * length(p - Vec3{1, 0, 0});
      },
      0.04, 0.4);
  const SurfaceMesh sphere = testing::icosphere(5);
  StageReport report;
  const TetMesh mesh = stuff_surface(sphere, {}, Defects::kClean, sizes, {{}, report});
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_NEAR(volume_of(mesh) / enclosed_volume(sphere), 1, 0.02);
}

// Two tetrahedra of different size that touch in an edge, and one that touches them in a point.
TEST(Stuffing, DropsWhatTouchesInAnEdgeOrAPoint) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0},   {0, 0, 1},     {0, -1, 0},
                 {0, 0, -1}, {0, -2, 0}, {-1, -1, 0}, {-1, -1, 0.5}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 9}, {0, 1, 4, 5}, {4, 6, 7, 8}};
  for (Tet& t : mesh.tets)
    if (signed_volume(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) < 0)
      std::swap(t[0], t[1]);
  mesh.boundary = boundary_triangles(mesh.tets, half_face_neighbors(mesh.tets, mesh.points.size()));
  ASSERT_FALSE(is_closed_manifold(mesh.boundary, mesh.points.size()));
  EXPECT_EQ(make_boundary_manifold(mesh, {}), 1u);  // the one below: what it held together falls apart
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_TRUE(is_closed_manifold(mesh.boundary, mesh.points.size()));
  EXPECT_EQ(mesh.tets.size(), 3u);
}

TEST(Stuffing, BoundaryIsAManifoldWhereWallsAreAsThinAsElements) {
  for (const double size : {0.2, 0.24, 0.28, 0.33}) {
    const SurfaceMesh s = testing::hollow_sphere(4, 1, 0.75);
    const TetMesh mesh = stuffed(s, size);
    EXPECT_EQ(first_defect(mesh), std::nullopt);
    EXPECT_TRUE(is_closed_manifold(mesh.boundary, mesh.points.size())) << size;
  }
}

TEST(Stuffing, RefusesWhatIsThinnerThanAnElement) {
  EXPECT_THROW(stuffed(testing::transformed(testing::icosphere(3), 0.01, {0.003, 0.002, 0.001}), 0.9), MeshingError);
}

}  // namespace
}  // namespace octafront
