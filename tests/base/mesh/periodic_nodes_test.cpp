#include "base/mesh/periodic_nodes.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// A quarter of a turn about z: 1 goes to 2, 3 to 4, and 0 lies on the axis.
TetMesh quarter() {
  TetMesh mesh;
  mesh.points = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {2, 0, 1}, {0, 2, 1}};
  mesh.periods = {{0, 0, 0}};
  mesh.period_rotations = {{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}};
  mesh.periodic_nodes = {{0, 2, 1}, {0, 4, 3}};
  return mesh;
}

TEST(PeriodicNodes, PeriodsLeadPlacesAndTurnDirections) {
  TetMesh mesh = quarter();
  EXPECT_EQ(led_by_period(mesh, 0, mesh.points[3]), mesh.points[4]);
  mesh.periods[0] = {0, 0, 5};
  EXPECT_EQ(led_by_period(mesh, 0, {1, 0, 0}), (Vec3{0, 1, 5}));
  EXPECT_EQ(turned_by_period(mesh, 0, {1, 0, 0}), (Vec3{0, 1, 0}));
  mesh.period_rotations.clear();
  EXPECT_EQ(led_by_period(mesh, 0, {1, 0, 0}), (Vec3{1, 0, 5}));
  EXPECT_EQ(turned_by_period(mesh, 0, {1, 0, 0}), (Vec3{1, 0, 0}));
}

TEST(PeriodicNodes, NodesOnTheAxisAreTheirOwnOriginals) {
  const TetMesh mesh = quarter();
  const Originals originals(mesh);
  EXPECT_EQ(originals.of(0, 2), 1u);
  EXPECT_EQ(originals.of(0, 0), 0u);
  EXPECT_EQ(originals.of(0, 1), kNone);
  EXPECT_EQ(originals.of(0, Triangle{0, 2, 4}), (Triangle{0, 1, 3}));
  EXPECT_EQ(originals.of(0, Triangle{0, 1, 3}), std::nullopt);
  EXPECT_EQ(originals.of(0, Triangle{0, 0, 0}), std::nullopt);
}

}  // namespace
}  // namespace octafront
