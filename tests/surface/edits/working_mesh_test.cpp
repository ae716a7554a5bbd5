#include "surface/edits/working_mesh.h"

#include "support/named_surfaces.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront::surface {
namespace {

constexpr double kFeatureAngle = 40;

/// A cube, its sides patches, between features.
WorkingMesh working_cube() {
  const KnownSurface cube(testing::cube(4), kFeatureAngle);
  InputSurface input = make_input_surface(cube.mesh(), cube.edges());
  set_features(input, cube.features().edges);
  return WorkingMesh(input);
}

/// The first half-edge inside a side whose both ends are inside as well.
HalfEdge inner_half_edge(const WorkingMesh& m) {
  HalfEdge h = 0;
  while (m.on_curve(m.start[h]) || m.on_curve(m.end(h))) ++h;
  return h;
}

TEST(WorkingMesh, IsConsistentAfterEachOperation) {
  WorkingMesh mesh = working_cube();
  ASSERT_EQ(mesh.first_inconsistency(), std::nullopt);
  const auto add = [&](Vec3 p) { return mesh.add_vertex(p, VertexKind::kFree, {0, 0, 1}, 1, 0); };
  HalfEdge h = inner_half_edge(mesh);
  mesh.split_triangle(h / 3, add(mesh.points[mesh.start[h]]));
  EXPECT_EQ(mesh.first_inconsistency(), std::nullopt);
  mesh.split_edge(h, add(mesh.points[mesh.start[h]]));
  EXPECT_EQ(mesh.first_inconsistency(), std::nullopt);
  int flips = 0, collapses = 0;
  for (h = 0; h < mesh.start.size(); ++h)
    if (mesh.may_flip(h)) mesh.flip(h), ++flips;
  EXPECT_EQ(mesh.first_inconsistency(), std::nullopt);
  for (h = 0; h < mesh.start.size(); ++h)
    if (!mesh.is_removed(h / 3) && mesh.may_collapse(h)) mesh.collapse(h), ++collapses;
  EXPECT_EQ(mesh.first_inconsistency(), std::nullopt);
  EXPECT_GT(flips, 10);
  EXPECT_GT(collapses, 10);

  const WorkingMesh before = mesh;
  const std::vector<std::uint32_t> alive = before.alive_triangles();
  ASSERT_LT(alive.size(), before.triangle_count());
  const std::vector<VertexIndex> former = mesh.compact();
  EXPECT_EQ(mesh.first_inconsistency(), std::nullopt);
  EXPECT_EQ(mesh.alive_triangles().size(), mesh.triangle_count());
  EXPECT_EQ(mesh.made_triangles(), before.triangle_count());
  ASSERT_EQ(mesh.triangle_count(), alive.size());
  for (std::uint32_t t = 0; t < alive.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(former[mesh.triangle(t)[i]], before.triangle(alive[t])[i]);
}

TEST(WorkingMesh, FindsWhatIsBroken) {
  const auto expect_found = [](const std::function<void(WorkingMesh&, HalfEdge)>& breaks, const std::string& fragment) {
    WorkingMesh mesh = working_cube();
    const HalfEdge h = inner_half_edge(mesh);
    const VertexIndex v = mesh.start[h];
    breaks(mesh, h);
    const std::string wrong = mesh.first_inconsistency().value_or("");
    EXPECT_NE(wrong.find(fragment), std::string::npos) << wrong;
    EXPECT_NE(mesh.first_inconsistency(std::array{v}), std::nullopt);
  };
  expect_found([](WorkingMesh& m, HalfEdge h) { m.twin[h] = kNone; }, "twin");
  expect_found([](WorkingMesh& m, HalfEdge h) { m.patch[h / 3] = 99; }, "patches meet at vertex");
  expect_found([](WorkingMesh& m, HalfEdge h) { m.set_feature(h, true); }, "ends a feature, and is on no curve");
  WorkingMesh mesh = working_cube();
  mesh.place.pop_back();
  EXPECT_EQ(mesh.first_inconsistency(), "the arrays of vertices differ in length");
}

}  // namespace
}  // namespace octafront::surface
