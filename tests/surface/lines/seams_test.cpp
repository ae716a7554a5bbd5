#include "surface/lines/seams.h"

#include <gtest/gtest.h>

namespace octafront::surface {
namespace {

/// Three sheets on one rim, a square: one of two triangles, one with a vertex so high above the middle, and a dome.
SurfaceMesh three_sheets(double height) {
  SurfaceMesh s;
  s.points = {{-1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, -1, 0}, {0, 0, height}, {0, 0, 1}};
  s.triangles = {{0, 2, 1}, {2, 0, 3}};
  for (const VertexIndex top : {4U, 5U})
    for (VertexIndex i = 0; i < 4; ++i) s.triangles.push_back({i, top, (i + 1) % 4});
  s.patch = {0, 0, 1, 1, 1, 1, 2, 2, 2, 2};
  return s;
}

std::uint64_t divided(double height) {
  const KnownSurface sheets(three_sheets(height), 40);
  SeamedSurface seamed = cut_along_seams(sheets);
  set_features(seamed.input, seamed.features.edges);
  WorkingMesh mesh(seamed.input);
  mesh.pinned = seamed.pinned;
  return divide_repeated_edges(mesh, sheets, {}, SizeField::uniform(1));
}

// Once sewn the first two sheets would lie upon each other, though no edge of theirs runs between the same vertices.
TEST(Seams, AnEdgeUnderOneThatIsDividedIsDividedToo) {
  EXPECT_EQ(divided(1e-3), 1U);
  EXPECT_EQ(divided(0.5), 0U);
}

}  // namespace
}  // namespace octafront::surface
