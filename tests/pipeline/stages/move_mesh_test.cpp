#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/move.h>
#include <octafront/validity.h>

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "improve/start_meshes.h"
#include "support/mixed_mesh.h"
#include "support/named_surfaces.h"

#include <algorithm>
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

TEST(MoveMesh, ALengthThatIsGivenIsThatOfAllEdges) {
  const TetMesh mesh = kuhn_cube(3);
  Options options;
  options.size.size = 0.2;
  const MovedMesh moved = move_mesh(mesh,
                                    displacement_on(mesh,
                                                    [](Vec3 p) {
                                                      return Vec3{2 * p.x, p.y, p.z};
                                                    }),
                                    {}, options);
  EXPECT_EQ(moved.history.back().change, "adapted");
  double sum = 0;
  std::size_t count = 0;
  for (const Tet& t : moved.mesh.tets)
    for (const auto& [i, j] : kTetEdges) sum += distance(moved.mesh.points[t[i]], moved.mesh.points[t[j]]), ++count;
  EXPECT_NEAR(sum / static_cast<double>(count), 0.2, 0.03);
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

TEST(MoveMesh, WhatIsInsideFollowsTheBoundaryAlone) {
  const TetMesh mesh = kuhn_cube(4);
  std::vector<std::uint8_t> is_inside(mesh.points.size(), 1);
  for (const Triangle& f : mesh.boundary)
    for (const VertexIndex v : f) is_inside[v] = 0;
  const auto turned = [](Vec3 p) { return Vec3{-p.y + 5, 1.5 * p.x, p.z + 0.3 * p.x}; };
  std::vector<Vec3> displacement = displacement_on(mesh, turned);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (is_inside[v]) displacement[v] = Vec3{} * std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(move_mesh(mesh, displacement), InputError);
  Options options;
  options.move.boundary_alone = true;
  const MovedMesh moved = move_mesh(mesh, displacement, {}, options);
  ASSERT_EQ(moved.history.size(), 1u);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    EXPECT_LT(distance(moved.mesh.points[v], turned(mesh.points[v])), 1e-10);
}

TEST(MoveMesh, WhatIsMeshedAnewKeepsItsPartsAndWhatIsKnown) {
  TetMesh mesh = bar();
  mesh.region.clear();
  for (const Tet& t : mesh.tets) {
    const double x = mesh.points[t[0]].x + mesh.points[t[1]].x + mesh.points[t[2]].x + mesh.points[t[3]].x;
    mesh.region.push_back(x < 8 ? 0 : 1);
  }
  mesh.region_names = {"left", "right"};
  mesh.sets.push_back({"some", NamedSet::Kind::kElements, {0, 1, 2}});
  MeshField mass{"mass", true, 1, {}};
  for (const std::uint32_t r : mesh.region) mass.values.push_back(1 + r);
  Options options;
  options.move.remesh = true, options.move.least_quality = 0.4;
  const auto drawn = [](Vec3 p) { return Vec3{3 * p.x, p.y, p.z}; };
  const MovedMesh moved = move_mesh(mesh, displacement_on(mesh, drawn), std::vector{mass}, options);
  EXPECT_EQ(first_defect(moved.mesh), std::nullopt);
  EXPECT_TRUE(std::any_of(moved.history.begin(), moved.history.end(),
                          [](const MoveStep& step) { return step.change == "remeshed"; }));
  EXPECT_GE(moved.history.back().beta_min, 0.2);
  EXPECT_EQ(moved.mesh.region_names, mesh.region_names);
  ASSERT_GE(moved.mesh.patch_names.size(), 3u);
  for (std::size_t f = 0; f < moved.mesh.boundary.size(); ++f) {
    double x = 0;
    for (const VertexIndex v : moved.mesh.boundary[f]) x += moved.mesh.points[v].x / 3;
    EXPECT_EQ(moved.mesh.patch_names[moved.mesh.patch[f]], x == 0 ? "low" : x == 12 ? "high" : "side");
  }
  EXPECT_NEAR(volume_of_mesh_moved(moved.mesh), 12, 1e-6);
  for (TetIndex t = 0; t < moved.mesh.tets.size(); ++t) {
    double x = 0;
    for (const VertexIndex v : moved.mesh.tets[t]) x += moved.mesh.points[v].x / 4;
    EXPECT_EQ(moved.mesh.region[t], x < 6 ? 0u : 1u);
    EXPECT_EQ(moved.fields[0].values[t], 1 + moved.mesh.region[t]);
  }
  ASSERT_EQ(moved.notes.size(), 1u);
  EXPECT_NE(moved.notes[0].find("some"), std::string::npos);
}

TEST(MoveMesh, PeriodsMoveWithTheirPairs) {
  Options options;
  options.size.size = 0.4, options.periodic = "xyz";
  const TetMesh mesh = generate(testing::cube(1), options).mesh;
  ASSERT_EQ(mesh.periods.size(), 3u);
  const auto sheared = [](Vec3 p) {
    return Vec3{1.1 * p.x + 0.3 * p.y + 0.03 * elementary::sin(6.283185307179586 * p.x), 0.7 * p.z - 0.1 * p.x + p.y,
                p.z + 0.2 * p.x};
  };
  const std::vector<Vec3> displacement = displacement_on(mesh, sheared);
  const MovedMesh moved = move_mesh(mesh, displacement);
  EXPECT_EQ(first_defect(moved.mesh), std::nullopt);
  EXPECT_EQ(moved.mesh.periodic_nodes.size(), mesh.periodic_nodes.size());
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT(distance(moved.mesh.periods[k], sheared(mesh.periods[k]) - sheared({})), 1e-12);
  for (const auto& [period, copy, original] : moved.mesh.periodic_nodes)
    EXPECT_EQ(moved.mesh.points[copy], moved.mesh.points[original] + moved.mesh.periods[period]);
  std::vector<Vec3> other = displacement;
  other[mesh.periodic_nodes[0][1]].x += 0.01;
  EXPECT_THROW(move_mesh(mesh, other), InputError);
}

TEST(MoveMesh, WedgesAndPyramidsGoAlong) {
  const TetMesh mesh = testing::mixed_mesh(4);
  ASSERT_FALSE(mesh.wide_cells.empty());
  const auto stretched = [](Vec3 p) { return Vec3{p.x + 0.2 * p.z * p.z, p.y, 2 * p.z}; };
  const MovedMesh moved = move_mesh(mesh, displacement_on(mesh, stretched));
  EXPECT_EQ(first_defect(moved.mesh), std::nullopt);
  EXPECT_EQ(first_wide_defect(moved.mesh), std::nullopt);
  ASSERT_EQ(moved.mesh.wide_cells.size(), mesh.wide_cells.size());
  for (std::size_t c = 0; c < mesh.wide_cells.size(); ++c)
    for (std::size_t k = 0; k < mesh.wide_cells[c].tet_count + 3; ++k)
      EXPECT_LT(distance(moved.mesh.points[moved.mesh.wide_cells[c].nodes[k]],
                         stretched(mesh.points[mesh.wide_cells[c].nodes[k]])),
                1e-12);
  // What is flat in the end cannot follow.
  EXPECT_THROW(move_mesh(mesh, displacement_on(mesh, [](Vec3 p) { return Vec3{p.x, p.y, 0}; })), MeshingError);
}

}  // namespace
}  // namespace octafront
