// Layers of elements through thin walls: as many as asked, the same body, good angles.

#include "layers/through.h"

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/quality.h>
#include <octafront/validity.h>

#include "base/geometry/measures.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;
using testing::hollow_sphere;

Result shelled(const SurfaceMesh& surface, double size, std::uint32_t shell, int threads = 0) {
  Options options;
  options.size.size = size;
  options.volume.shell = shell;
  RunContext context;
  context.threads = threads;
  return generate(surface, options, context);
}

double volume_inside(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    sum += signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  return sum;
}

/// The fewest edges from a vertex with z = 0 to one with z = top.
int fewest_edges_through(const TetMesh& mesh, double top) {
  std::vector<std::set<VertexIndex>> beside(mesh.points.size());
  for (const Tet& tet : mesh.tets)
    for (const VertexIndex u : tet)
      for (const VertexIndex v : tet)
        if (u != v) beside[u].insert(v);
  std::vector<int> steps(mesh.points.size(), -1);
  std::queue<VertexIndex> front;
  for (VertexIndex v = 0; v < mesh.points.size(); ++v)
    if (mesh.points[v].z == 0) steps[v] = 0, front.push(v);
  while (!front.empty()) {
    const VertexIndex v = front.front();
    front.pop();
    if (mesh.points[v].z == top) return steps[v];
    for (const VertexIndex u : beside[v])
      if (steps[u] < 0) steps[u] = steps[v] + 1, front.push(u);
  }
  return -1;
}

TEST(LayersThroughWalls, AreAsManyAsAsked) {
  const SurfaceMesh plate = box(20, 20, 1);
  const Result one = shelled(plate, 5, 0);
  EXPECT_EQ(fewest_edges_through(one.mesh, 1), 1);
  for (const std::uint32_t n : {2u, 3u, 5u}) {
    const Result made = shelled(plate, 5, n);
    EXPECT_EQ(fewest_edges_through(made.mesh, 1), static_cast<int>(n));
    EXPECT_FALSE(first_defect(made.mesh)) << n;
    EXPECT_NEAR(volume_inside(made.mesh), 400, 1e-9);
    EXPECT_TRUE(layers::spans_through_walls(made.mesh, RunContext{}).empty());
  }
}

TEST(LayersThroughWalls, OfAPlateAreFewAndGood) {
  const SurfaceMesh plate = box(100, 100, 1);
  const Result one = shelled(plate, 5, 0), two = shelled(plate, 5, 2);
  EXPECT_LE(two.mesh.tets.size(), 5 * one.mesh.tets.size());
  EXPECT_GE(two.report.quality.dihedral_min, 8);
  EXPECT_LE(two.report.quality.dihedral_max, 172);
  EXPECT_NEAR(volume_inside(two.mesh), 1e4, 1e-7);
}

TEST(LayersThroughWalls, GoAroundShells) {
  const SurfaceMesh shell = hollow_sphere(3, 1, 0.93);
  const Result one = shelled(shell, 0.2, 0), two = shelled(shell, 0.2, 2);
  EXPECT_FALSE(layers::spans_through_walls(one.mesh, RunContext{}).empty());
  EXPECT_TRUE(layers::spans_through_walls(two.mesh, RunContext{}).empty());
  EXPECT_FALSE(first_defect(two.mesh));
  EXPECT_EQ(one.mesh.boundary.size(), two.mesh.boundary.size());
  EXPECT_NEAR(volume_inside(two.mesh), volume_inside(one.mesh), 1e-9);
}

TEST(LayersThroughWalls, LeaveThickBodiesAsTheyAre) {
  const SurfaceMesh cube = box(1, 1, 1);
  const Result plain = shelled(cube, 0.2, 0), asked = shelled(cube, 0.2, 2);
  EXPECT_EQ(plain.mesh, asked.mesh);
}

TEST(LayersThroughWalls, AreTheSameOnAnyNumberOfThreads) {
  const SurfaceMesh plate = box(20, 20, 1);
  EXPECT_EQ(shelled(plate, 4, 2, 1).mesh, shelled(plate, 4, 2, 2).mesh);
}

TEST(LayersThroughWalls, RefuseWhatTheyDoNotGoWith) {
  Options options;
  options.volume.shell = 1;
  EXPECT_THROW(check_options(options), OptionError);
  options.volume.shell = 2;
  options.surface.keep = true;
  EXPECT_THROW(check_options(options), OptionError);
  options.surface.keep = false;
  options.layers.count = 2;
  options.layers.first_part = 0.1;
  EXPECT_THROW(check_options(options), OptionError);
}

TEST(Through, LayersAreAmongTheElementsExpected) {
  for (const std::uint32_t layers : {2u, 3u, 4u}) {
    SCOPED_TRACE(layers);
    const Report report = shelled(box(20, 20, 1), 4, layers).report;
    EXPECT_NEAR(report.expected_tets, static_cast<double>(report.tets), 0.4 * static_cast<double>(report.tets));
  }
}

}  // namespace
}  // namespace octafront
