// The boundary moves on the surface it stands for, and on nothing else.

#include <octafront/quality.h>
#include <octafront/validity.h>

#include "base/core/thread_limit.h"
#include "base/geometry/measures.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/features.h"
#include "improve/passes/fewest_poor.h"
#include "improve/passes/passes.h"
#include "improve/schedule/schedule.h"
#include "improve/start_meshes.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace octafront::improve {
namespace {

using namespace octafront::testing;

SurfaceMesh boundary_of(const TetMesh& mesh) {
  return {mesh.points, mesh.boundary, mesh.patch, {}, {}};
}

int sides_at(Vec3 p) {
  int sides = 0;
  for (int axis = 0; axis < 3; ++axis) sides += p[axis] == 0 || p[axis] == 1;
  return sides;
}

/// A cube whose boundary vertices too have been moved, each along the sides of the cube on which it lies.
TetMesh shaken_cube(int n, double amount, std::uint32_t seed) {
  TetMesh mesh = perturbed(kuhn_cube(n), amount, seed);
  std::mt19937 random(seed);
  for (Vec3& p : mesh.points) {
    if (sides_at(p) == 0) continue;
    const Vec3 was = p;
    for (int axis = 0; axis < 3; ++axis)
      if (was[axis] != 0 && was[axis] != 1) p[axis] += (random() / 4294967296.0 * 2 - 1) * amount / n;
    if (first_defect(mesh)) p = was;
  }
  return mesh;
}

struct Cube {
  TetMesh first = kuhn_cube(1);
  SurfaceMesh surface = boundary_of(first);
  Features features = detect_features(surface, 40);
};

TEST(Boundary, SlidesOnTheSidesAndEdgesOfACube) {
  const Cube cube;
  const TetMesh start = shaken_cube(5, 0.3, 2);
  ASSERT_EQ(first_defect(start), std::nullopt);
  const Features of_mesh = detect_features(boundary_of(start), 40);
  const TriangleTree tree(cube.surface);
  const BoundaryInput input{cube.surface, tree, cube.features, of_mesh};
  ImproveOptions options;
  StageReport report;
  TetMesh slid = start, fixed = start;
  EXPECT_TRUE(improve_mesh(slid, &input, options, {{}, report}));
  EXPECT_FALSE(improve_mesh(fixed, nullptr, options, {{}, report}));
  EXPECT_EQ(first_defect(slid), std::nullopt);
  EXPECT_GT(summarize_quality(slid).beta_mean, summarize_quality(fixed).beta_mean);
  EXPECT_GE(summarize_quality(slid).dihedral_min, summarize_quality(start).dihedral_min);
  ASSERT_EQ(slid.boundary.size(), start.boundary.size());
  // The sum of the areas of a patch is that of its side just if it lies on it and covers it once.
  std::array<double, 6> area{};
  for (std::size_t t = 0; t < slid.boundary.size(); ++t) {
    const auto& [a, b, c] = slid.boundary[t];
    area[slid.patch[t]] += length(cross(slid.points[b] - slid.points[a], slid.points[c] - slid.points[a])) / 2;
    const int axis = static_cast<int>(slid.patch[t] / 2);
    for (const VertexIndex v : slid.boundary[t]) EXPECT_NEAR(slid.points[v][axis], slid.patch[t] % 2, 1e-14);
  }
  for (const double a : area) EXPECT_NEAR(a, 1, 1e-12);
  // Numbers may change where an inner vertex goes: places are compared.
  const auto places = [](const TetMesh& mesh, bool corners_only) {
    std::set<std::array<double, 3>> found;
    for (const Triangle& t : mesh.boundary)
      for (const VertexIndex v : t) {
        const Vec3 p = mesh.points[v];
        if (!corners_only || sides_at(p) == 3) found.insert({p.x, p.y, p.z});
      }
    return found;
  };
  EXPECT_EQ(places(start, true).size(), 8u);
  EXPECT_EQ(places(slid, true), places(start, true));
  EXPECT_EQ(places(slid, false).size(), places(start, false).size());
  EXPECT_NE(places(slid, false), places(start, false));
}

/// Two pairs of tetrahedra, one pair with a common edge, one with a common vertex: walks around these see half.
TEST(Boundary, StaysWhereItTouchesItself) {
  TetMesh touching;
  touching.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {5, 0, 0},
                     {6, 0, 0}, {6, 1, 0}, {6, 0, 1}, {4, 0, 0}, {4, -1, 0}, {4, 0, -1}};
  touching.tets = {{0, 1, 3, 2}, {0, 1, 5, 4}, {6, 7, 8, 9}, {6, 10, 11, 12}};
  for (Tet& t : touching.tets) {
    const auto at = [&](int i) { return touching.points[t[i]]; };
    if (signed_volume(at(0), at(1), at(2), at(3)) < 0) std::swap(t[2], t[3]);
  }
  const TetMesh mesh = with_boundary(touching);
  SurfaceMesh complex = boundary_of(mesh);
  complex.sides.assign(complex.triangles.size(), {kNone, 0});
  const Features none;
  const TriangleTree tree(complex);
  const EditMesh edit{TetMesh{mesh}};
  const BoundaryGuide guide(edit, {complex, tree, none, none}, {});
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) EXPECT_EQ(guide.is_frozen(v), v == 0 || v == 1 || v == 6) << v;
}

TEST(Boundary, StaysWhenTold) {
  const Cube cube;
  const TetMesh start = shaken_cube(4, 0.3, 3);
  const Features of_mesh = detect_features(boundary_of(start), 40);
  const TriangleTree tree(cube.surface);
  const BoundaryInput input{cube.surface, tree, cube.features, of_mesh};
  ImproveOptions options;
  options.move_boundary = false;
  StageReport report;
  TetMesh mesh = start;
  EXPECT_FALSE(improve_mesh(mesh, &input, options, {{}, report}));
  for (const Triangle& t : start.boundary)
    for (const VertexIndex v : t) EXPECT_EQ(mesh.points[v], start.points[v]);
}

TEST(Boundary, IsTheSameOnAnyNumberOfThreads) {
  const Cube cube;
  const TetMesh start = perturbed(kuhn_cube(20), 0.4, 4);  // several blocks
  const Features of_mesh = detect_features(boundary_of(start), 40);
  const TriangleTree tree(cube.surface);
  const BoundaryInput input{cube.surface, tree, cube.features, of_mesh};
  TetMesh once;
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    TetMesh mesh = start;
    StageReport report;
    improve_mesh(mesh, &input, {}, {{}, report});
    if (threads == 1) once = mesh;
    EXPECT_EQ(mesh, once) << threads;
    EXPECT_TRUE(std::any_of(start.boundary.begin(), start.boundary.end(),
                            [&](const Triangle& t) { return mesh.points[t[0]] != start.points[t[0]]; }));
  }
}

/// Two good tets on a square, and a flat one below with the other diagonal of the square.
TetMesh with_sliver_below(double depth) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, -depth}, {1, 1, 0}, {0, 1, -depth}, {0.5, 0.5, 0.8}};
  mesh.tets = {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 1, 3, 2}};
  return with_boundary(std::move(mesh));
}

TEST(Boundary, ASliverOnItGoesWithoutAnotherInItsPlace) {
  const TetMesh start = with_sliver_below(0.02);
  ASSERT_EQ(first_defect(start), std::nullopt);
  const SurfaceMesh surface = boundary_of(start);
  const Features features = detect_features(surface, 40);
  const TriangleTree tree(surface);
  const BoundaryInput input{surface, tree, features, features};
  EditMesh edit{TetMesh{start}};
  const BoundaryGuide guide(edit, input, {});
  EXPECT_EQ(reconnect(edit, 0.6f, Goal::kWorst, {}, &guide).done, 1u);
  const TetMesh mesh = edit.release();
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_EQ(mesh.tets.size(), 2u);
}

TEST(Boundary, KeepsARidgeThatIsNoFeature) {
  const TetMesh start = with_sliver_below(0.3);
  const SurfaceMesh surface = boundary_of(start);
  const Features features = detect_features(surface, 150);
  const TriangleTree tree(surface);
  const BoundaryInput input{surface, tree, features, features};
  EditMesh edit{TetMesh{start}};
  const BoundaryGuide guide(edit, input, {});
  reconnect(edit, 1.0f, Goal::kWorst, {}, &guide);
  const TetMesh mesh = edit.release();
  EXPECT_EQ(mesh.boundary, start.boundary);  // elements inside may well change
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Boundary, FacesBetweenRegionsAreKept) {
  TetMesh start = perturbed(kuhn_cube(4), 0.6, 5);
  std::array<double, 2> before{}, after{};
  const auto add = [](const TetMesh& mesh, std::array<double, 2>& volume) {
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      const Vec3 p = mesh.points[a];
      volume[mesh.region[t]] += dot(cross(mesh.points[b] - p, mesh.points[c] - p), mesh.points[d] - p) / 6;
    }
  };
  for (std::size_t t = 0; t < start.tets.size(); ++t) start.region.push_back(t % 7 < 3);
  add(start, before);
  ImproveOptions options;
  options.level = ImproveOptions::Level::kBest;
  StageReport report;
  TetMesh mesh = start;
  improve_mesh(mesh, nullptr, options, {{}, report});
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  add(mesh, after);
  for (int r = 0; r < 2; ++r) EXPECT_NEAR(after[r], before[r], 1e-12);
}

/// Two cubes beside each other, this far apart.
TetMesh two_cubes(double apart) {
  TetMesh both = kuhn_cube(4);
  const TetMesh other = transformed(kuhn_cube(4), 1, {1 + apart, 0, 0});
  both.boundary.clear();
  both.patch.clear();
  both.source.clear();
  const auto shift = static_cast<VertexIndex>(both.points.size());
  both.points.insert(both.points.end(), other.points.begin(), other.points.end());
  for (Tet t : other.tets) {
    for (VertexIndex& v : t) v += shift;
    both.tets.push_back(t);
  }
  return with_boundary(std::move(both));
}

TEST(Boundary, WhatCrossesGoesBackToWhereItWas) {
  const TetMesh start = two_cubes(0.05);
  TetMesh crossing = start;
  const auto moved = static_cast<std::size_t>(std::find(start.points.begin(), start.points.end(), Vec3{1, 0.5, 0.5}) -
                                              start.points.begin());
  crossing.points[moved].x += 0.1;
  ASSERT_FALSE(self_intersections(crossing.points, crossing.boundary).empty());
  const SurfaceMesh surface = boundary_of(start);
  const Features features = detect_features(surface, 40);
  const TriangleTree tree(surface);
  EditMesh edit{TetMesh{crossing}};
  const BoundaryGuide guide(edit, {surface, tree, features, features}, {});
  const TakenBack back = take_back_crossings(edit, start.points, guide, {});
  EXPECT_TRUE(back.crossing.empty());
  EXPECT_EQ(back.pass.done, 1u);
  const TetMesh made = edit.release();
  EXPECT_EQ(first_defect(made), std::nullopt);
  EXPECT_EQ(made.points[moved], start.points[moved]);
  EXPECT_TRUE(self_intersections(made.points, made.boundary).empty());
  // Frozen, it cannot.
  EditMesh again{TetMesh{crossing}};
  const BoundaryGuide frozen(again, {surface, tree, features, features}, {static_cast<VertexIndex>(moved)});
  EXPECT_FALSE(take_back_crossings(again, start.points, frozen, {}).crossing.empty());
}

TEST(FeatureCurves, AreWalkedToTheirEndsAndNoFarther) {
  const Cube cube;
  const FeatureCurves curves(cube.surface, cube.features);
  const auto start = curves.nearest({0.3, 1e-9, 0}, 1e-6);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->at, (Vec3{0.3, 0, 0}));
  const double sign = curves.tangent(*start).x;
  EXPECT_NEAR(curves.walk(*start, 0.5 * sign)->at.x, 0.8, 1e-15);
  EXPECT_NEAR(curves.walk(*start, -0.2 * sign)->at.x, 0.1, 1e-15);
  EXPECT_FALSE(curves.walk(*start, 0.8 * sign));
  EXPECT_FALSE(curves.nearest({0.5, 0.5, 0.5}, 0.1));
}

TEST(FeatureCurves, AreWalkedAroundBends) {
  SurfaceMesh surface;  // only its edges matter: a bent line of two segments
  surface.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const Features features{{{0, 1}, {1, 2}}, {0, 2}};
  const FeatureCurves curves(surface, features);
  const auto start = curves.nearest({0.5, 0, 0}, 0.1);
  ASSERT_TRUE(start);
  EXPECT_EQ(curves.walk(*start, 0.75)->at, (Vec3{1, 0.25, 0}));
}

double lack_of_elements(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    sum += improve::lack_of(shape_of(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]).score);
  return sum;
}

/// A mesh of a cube in which a vertex inside a side has come next to another one: slivers that no inner vertex mends.
TetMesh cube_with_a_needle(double length) {
  TetMesh mesh = kuhn_cube(4);
  const auto at = [&](Vec3 p) { return std::find(mesh.points.begin(), mesh.points.end(), p); };
  *at({0.5, 0.5, 0}) = Vec3{0.25 + length, 0.5, 0};
  return mesh;
}

struct Edited {
  TetMesh mesh;
  BoundaryEdits edits;
};

Edited edited(const TetMesh& start, double tolerance) {
  const Cube cube;
  const Features of_mesh = detect_features(boundary_of(start), 40);
  const TriangleTree tree(cube.surface);
  const BoundaryInput input{cube.surface, tree, cube.features, of_mesh, tolerance};
  EditMesh edit(TetMesh{start});
  BoundaryGuide guide(edit, input, {});
  const BoundaryEdits edits = edit_boundary(edit, kComfort, guide, {});
  EXPECT_EQ(edit.first_inconsistency(), std::nullopt);
  return {edit.release(), edits};
}

TEST(BoundaryEdits, CollapseAShortEdgeOfASide) {
  const TetMesh start = cube_with_a_needle(0.01);
  ASSERT_EQ(first_defect(start), std::nullopt);
  const auto [made, edits] = edited(start, 0.01);
  EXPECT_GT(edits.result.done, 0u);
  EXPECT_EQ(first_defect(made), std::nullopt);
  EXPECT_LT(made.boundary.size(), start.boundary.size());
  EXPECT_LT(lack_of_elements(made), 0.5 * lack_of_elements(start));
  EXPECT_EQ(made.patch.size(), made.boundary.size());
  EXPECT_NEAR(enclosed_volume(boundary_of(made)), 1, 1e-3);
}

TEST(BoundaryEdits, StrayNoFartherThanTheTolerance) {
  constexpr double kTolerance = 0.02;
  const Cube cube;
  const TriangleTree tree(cube.surface);
  std::uint64_t done = 0;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const TetMesh start = shaken_cube(4, 0.48, seed);
    const auto [made, edits] = edited(start, kTolerance);
    done += edits.result.done;
    EXPECT_EQ(first_defect(made), std::nullopt);
    EXPECT_LE(lack_of_elements(made), lack_of_elements(start));
    for (const Triangle& t : made.boundary)
      for (const VertexIndex v : t) EXPECT_TRUE(tree.is_within(made.points[v], 2 * kTolerance));
    const TriangleTree boundary(boundary_of(made));
    for (const Vec3 corner : cube.surface.points) EXPECT_TRUE(boundary.is_within(corner, 2 * kTolerance));
  }
  EXPECT_GT(done, 0u);
}

}  // namespace
}  // namespace octafront::improve
