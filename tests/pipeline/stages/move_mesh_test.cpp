#include <octafront/error.h>
#include <octafront/move.h>
#include <octafront/validity.h>

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "improve/start_meshes.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;

std::vector<Vec3> displacement_on(const TetMesh& mesh, const std::function<Vec3(Vec3)>& place_after) {
  std::vector<Vec3> displacement;
  for (const Vec3& p : mesh.points) displacement.push_back(place_after(p) - p);
  return displacement;
}

double volume_of_mesh_moved(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    sum += signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  return sum;
}

/// A bar along x, with patches of its ends.
TetMesh bar() {
  TetMesh mesh = kuhn_cube(8);
  for (Vec3& p : mesh.points) p.x *= 4;
  mesh.patch.clear();
  for (const Triangle& f : mesh.boundary) {
    const double x = mesh.points[f[0]].x + mesh.points[f[1]].x + mesh.points[f[2]].x;
    mesh.patch.push_back(x == 0 ? 1 : x == 12 ? 2 : 0);
  }
  mesh.patch_names = {"side", "low", "high"};
  return mesh;
}

TEST(MoveMesh, WhatIsSoundGoesAtOnceAndKeepsItsElements) {
  const TetMesh mesh = kuhn_cube(3);
  const MovedMesh moved = move_mesh(mesh, displacement_on(mesh, [](Vec3 p) { return Vec3{-p.y + 5, p.x, p.z}; }));
  ASSERT_EQ(moved.history.size(), 1u);
  EXPECT_EQ(moved.history[0].change, "moved");
  EXPECT_EQ(moved.mesh.tets, mesh.tets);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3 p = mesh.points[v];
    EXPECT_LT(distance(moved.mesh.points[v], {-p.y + 5, p.x, p.z}), 1e-14);
  }
}

/// A bar bent by a half turn, its middle line as long as it was.
TEST(MoveMesh, ABarIsBentByAHalfTurnAndItsFieldsGoAlong) {
  const TetMesh mesh = bar();
  const double pi = 3.141592653589793, radius = 4 / pi;
  const auto bent = [&](Vec3 p) {
    const double angle = p.x / radius, r = radius + 0.5 - p.y;
    return Vec3{r * elementary::sin(angle), radius + 0.5 - r * elementary::cos(angle), p.z};
  };
  MeshField mass{"mass", true, 1, {}}, place{"x", false, 1, {}};
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) mass.values.push_back(1 + t % 3);
  for (const Vec3& p : mesh.points) place.values.push_back(p.x);
  const MovedMesh moved = move_mesh(mesh, displacement_on(mesh, bent), std::vector{mass, place});
  EXPECT_EQ(first_defect(moved.mesh), std::nullopt);
  EXPECT_EQ(moved.history.back().fraction, 1);
  EXPECT_GE(moved.history.back().beta_min, 0.1);
  EXPECT_EQ(moved.mesh.patch_names, mesh.patch_names);
  EXPECT_NEAR(volume_of_mesh_moved(moved.mesh), 4, 0.25);
  EXPECT_NEAR(moved.history.back().volume, volume_of_mesh_moved(moved.mesh), 1e-12);
  // Points know where they were.
  for (std::size_t f = 0; f < moved.mesh.boundary.size(); ++f)
    for (const VertexIndex v : moved.mesh.boundary[f]) {
      const std::uint32_t patch = moved.mesh.patch[f];
      EXPECT_NEAR(moved.fields[1].values[v], patch == 1 ? 0 : patch == 2 ? 4 : 2, patch == 0 ? 2.05 : 0.05);
    }
  for (const double value : moved.fields[0].values) EXPECT_TRUE(value >= 1 && value <= 3);
}

TEST(MoveMesh, AStretchedBlockGetsElementsOfItsOldLengths) {
  const TetMesh mesh = kuhn_cube(4);
  const MovedMesh moved = move_mesh(mesh, displacement_on(mesh, [](Vec3 p) { return Vec3{8 * p.x, p.y, p.z}; }));
  EXPECT_EQ(first_defect(moved.mesh), std::nullopt);
  EXPECT_NEAR(volume_of_mesh_moved(moved.mesh), 8, 1e-9);
  EXPECT_EQ(moved.history.back().change, "adapted");
  EXPECT_GT(moved.mesh.tets.size(), 4 * mesh.tets.size());
  EXPECT_GT(moved.history.back().beta_min, 0.2);
}

TEST(MoveMesh, AFlattenedBlockIsMendedOnTheWay) {
  const TetMesh mesh = kuhn_cube(4);
  const MovedMesh moved = move_mesh(mesh, displacement_on(mesh, [](Vec3 p) {
                                      return Vec3{0.06 * p.x, 4 * p.y, 4 * p.z};
                                    }));
  EXPECT_EQ(first_defect(moved.mesh), std::nullopt);
  EXPECT_NEAR(volume_of_mesh_moved(moved.mesh), 0.96, 1e-9);
  EXPECT_GT(moved.history.size(), 1u);
  for (std::size_t i = 1; i < moved.history.size(); ++i)
    EXPECT_GT(moved.history[i].fraction, moved.history[i - 1].fraction);
  EXPECT_EQ(moved.history.back().fraction, 1);
  Box3 box;
  for (const Vec3& p : moved.mesh.points) box.add(p);
  EXPECT_LT(length(box.hi - Vec3{0.06, 4, 4}) + length(box.lo), 1e-12);
}

TEST(MoveMesh, ContactIsRefusedWithItsPlaceAndHowFarItGoes) {
  TetMesh two = kuhn_cube(2);
  const TetMesh one = two;
  const auto first = static_cast<VertexIndex>(one.points.size());
  for (const Vec3& p : one.points) two.points.push_back(p + Vec3{1.25, 0.1, 0.1});
  for (Tet t : one.tets) two.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  for (const Triangle& f : one.boundary) two.boundary.push_back({f[0] + first, f[1] + first, f[2] + first});
  two.patch.clear(), two.source.clear();
  std::vector<Vec3> displacement(two.points.size());
  for (std::size_t v = first; v < two.points.size(); ++v) displacement[v] = {-1, 0, 0};
  try {
    move_mesh(two, displacement);
    FAIL() << "they pass through each other";
  } catch (const MeshingError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("touches itself at (1"), std::string::npos) << text;
    EXPECT_NE(text.find("24.9 %"), std::string::npos) << text;
  }
  // Nor may one end behind the other.
  std::vector<Vec3> through = displacement;
  for (Vec3& u : through) u = 5 * u;
  EXPECT_THROW(move_mesh(two, through), MeshingError);
  for (Vec3& u : displacement) u = 0.24 * u;
  EXPECT_EQ(move_mesh(two, displacement).history.back().fraction, 1);
}

TEST(MoveMesh, WhatFoldsTheBodyOrIsNoMotionIsRefused) {
  const TetMesh mesh = kuhn_cube(2);
  EXPECT_THROW(move_mesh(mesh, displacement_on(mesh, [](Vec3 p) { return Vec3{-p.x, p.y, p.z}; })), MeshingError);
  std::vector<Vec3> none(mesh.points.size());
  none.pop_back();
  EXPECT_THROW(move_mesh(mesh, none), InputError);
  none.push_back({std::numeric_limits<double>::infinity(), 0, 0});
  EXPECT_THROW(move_mesh(mesh, none), InputError);
}

}  // namespace
}  // namespace octafront
