#include "base/mesh/known_surface.h"

#include "support/named_surfaces.h"

#include <set>
#include <thread>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(KnownSurface, AnswersAsWhoeverAsksAlone) {
  const SurfaceMesh cube = testing::cube(3);
  const KnownSurface known(cube, 40);
  const EdgeTable edges = make_edge_table(cube.points.size(), cube.triangles);
  EXPECT_EQ(known.mesh(), cube);
  EXPECT_EQ(known.edges().edges, edges.edges);
  EXPECT_EQ(known.edges().half_edges, edges.half_edges);
  EXPECT_EQ(known.features().edges, detect_features(cube, 40).edges);
  EXPECT_EQ(known.features().corners.size(), 8u);
  const Vec3 p{0.3, 0.4, 2};
  EXPECT_EQ(known.tree().nearest(p).point, TriangleTree(cube).nearest(p).point);
}

TEST(KnownSurface, HasOneTreeWhoeverAsksFirst) {
  const KnownSurface known(testing::icosphere(4), 40);
  std::vector<const TriangleTree*> trees(8);
  std::vector<std::thread> threads;
  for (const TriangleTree*& tree : trees) threads.emplace_back([&] { tree = &known.tree(); });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(std::set(trees.begin(), trees.end()).size(), 1u);
}

}  // namespace
}  // namespace octafront
