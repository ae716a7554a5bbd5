#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/level_set.h>
#include <octafront/validity.h>

#include "base/geometry/measures.h"
#include "improve/start_meshes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;
using ::octafront::testing::perturbed;

LevelSet level_set_of(const std::string& name, const TetMesh& mesh, const std::function<double(Vec3)>& f,
                      double level = 0) {
  LevelSet set{name, {}, level};
  for (const Vec3& p : mesh.points) set.values.push_back(f(p));
  return set;
}

std::function<double(Vec3)> ball_around(Vec3 middle, double radius) {
  return [=](Vec3 p) { return distance(p, middle) - radius; };
}

double volume_of_region(const TetMesh& mesh, const std::string& name) {
  double sum = 0;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    if (mesh.region_names[mesh.region[t]] == name)
      sum += signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  }
  return sum;
}

TEST(CutAlong, APlaneIsMetExactly) {
  const TetMesh mesh = perturbed(kuhn_cube(5), 0.25, 1);
  const CutMesh cut = cut_along(mesh, std::vector{level_set_of(
                                          "low", mesh, [](Vec3 p) { return p.z; }, 0.37)});
  EXPECT_EQ(first_defect(cut.mesh), std::nullopt);
  EXPECT_EQ(cut.mesh.region_names, (std::vector<std::string>{"outside", "low"}));
  EXPECT_NEAR(volume_of_region(cut.mesh, "low"), 0.37, 1e-12);
  EXPECT_NEAR(volume_of_region(cut.mesh, "outside"), 0.63, 1e-12);
  ASSERT_EQ(cut.mesh.interface_patch.size(), cut.mesh.interfaces.size());
  double area = 0;
  for (std::size_t f = 0; f < cut.mesh.interfaces.size(); ++f) {
    EXPECT_EQ(cut.mesh.patch_names[cut.mesh.interface_patch[f]], "low_surface");
    for (const VertexIndex v : cut.mesh.interfaces[f]) EXPECT_NEAR(cut.mesh.points[v].z, 0.37, 1e-14);
    area += triangle_area(cut.mesh.points, cut.mesh.interfaces[f]);
  }
  EXPECT_NEAR(area, 1, 1e-12);
  const LevelSetReport& report = cut.level_sets.front();
  EXPECT_GT(report.moved, 0u);
  EXPECT_GT(report.divided, 0u);
  EXPECT_EQ(report.pieces, 1u);
  EXPECT_NEAR(report.area, area, 1e-15);
}

TEST(CutAlong, WhereFacesLieOnItNothingIsDivided) {
  const TetMesh mesh = kuhn_cube(4);
  const CutMesh cut = cut_along(mesh, std::vector{level_set_of("low", mesh, [](Vec3 p) { return p.z - 0.5; })});
  EXPECT_EQ(cut.level_sets[0].divided, 0u);
  EXPECT_EQ(cut.mesh.tets, mesh.tets);
  EXPECT_EQ(cut.level_sets[0].triangles, 32u);
}

/// Patches, curves, sets of faces and elements are where they were; sets of nodes keep theirs.
TEST(CutAlong, WhatHangsOnTheMeshGoesAlong) {
  TetMesh mesh = perturbed(kuhn_cube(4), 0.2, 2);
  mesh.patch.clear();
  for (const Triangle& f : mesh.boundary)
    mesh.patch.push_back(mesh.points[f[0]].x + mesh.points[f[1]].x + mesh.points[f[2]].x == 0);
  mesh.patch_names = {"rest", "wall"};
  NamedSet half{"half", NamedSet::Kind::kElements, {}}, wall{"wall too", NamedSet::Kind::kFaces, {}};
  for (TetIndex t = 0; t < mesh.tets.size() / 2; ++t) half.members.push_back(t);
  for (std::uint32_t f = 0; f < mesh.boundary.size(); ++f)
    if (mesh.patch[f] == 1) wall.members.push_back(f);
  NamedSet node{"node", NamedSet::Kind::kNodes, {static_cast<std::uint32_t>(mesh.points.size() / 2)}};
  mesh.sets = {half, wall, node};
  double half_volume = 0;
  for (const TetIndex t : half.members) {
    const auto& [a, b, c, d] = mesh.tets[t];
    half_volume += signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  }
  const CutMesh cut = cut_along(mesh, std::vector{level_set_of("ball", mesh, ball_around({0.4, 0.5, 0.5}, 0.45))});
  const TetMesh& now = cut.mesh;
  EXPECT_EQ(first_defect(now), std::nullopt);
  EXPECT_EQ(now.patch_names, (std::vector<std::string>{"rest", "wall", "ball_surface"}));
  double area = 0, in_set = 0;
  for (std::size_t f = 0; f < now.boundary.size(); ++f)
    if (now.patch[f] == 1) area += triangle_area(now.points, now.boundary[f]);
  for (const std::uint32_t f : now.sets[1].members) in_set += triangle_area(now.points, now.boundary[f]);
  EXPECT_NEAR(area, 1, 1e-12);
  EXPECT_NEAR(in_set, 1, 1e-12);
  EXPECT_EQ(now.sets[2].members, node.members);
  EXPECT_EQ(now.points[node.members[0]], mesh.points[node.members[0]]);
  EXPECT_GT(now.sets[0].members.size(), half.members.size());
}

TEST(CutAlong, ABallHasAClosedSurface) {
  const TetMesh mesh = perturbed(kuhn_cube(8), 0.25, 3);
  const CutMesh cut = cut_along(mesh, std::vector{level_set_of("ball", mesh, ball_around({0.5, 0.5, 0.5}, 0.3))});
  std::map<Edge, int> uses;
  for (const Triangle& f : cut.mesh.interfaces)
    for (std::size_t i = 0; i < 3; ++i) ++uses[{std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3])}];
  for (const auto& [edge, count] : uses) EXPECT_EQ(count, 2);
  const double wanted = 4.0 / 3 * 3.14159265 * 0.027;
  // Chords of a coarse mesh lie inside.
  EXPECT_LT(volume_of_region(cut.mesh, "ball"), wanted);
  const TetMesh finer = perturbed(kuhn_cube(20), 0.25, 3);
  const CutMesh nearer = cut_along(finer, std::vector{level_set_of("ball", finer, ball_around({0.5, 0.5, 0.5}, 0.3))});
  EXPECT_NEAR(volume_of_region(nearer.mesh, "ball"), wanted, 0.03 * wanted);
}

TEST(CutAlong, OfSeveralTheFirstNamesARegion) {
  const TetMesh mesh = perturbed(kuhn_cube(7), 0.2, 4);
  const std::vector sets{level_set_of("a", mesh, ball_around({0.35, 0.5, 0.5}, 0.25)),
                         level_set_of("b", mesh, [](Vec3 p) { return 0.4 - p.x; })};
  const CutMesh cut = cut_along(mesh, sets);
  EXPECT_EQ(first_defect(cut.mesh), std::nullopt);
  EXPECT_EQ(cut.mesh.region_names, (std::vector<std::string>{"outside", "a", "b"}));
  const double a = volume_of_region(cut.mesh, "a"), b = volume_of_region(cut.mesh, "b");
  const CutMesh alone = cut_along(mesh, std::vector{sets[0]});
  EXPECT_NEAR(a, volume_of_region(alone.mesh, "a"), 0.01 * a);
  EXPECT_LT(b, 0.6 - 0.2 * a);
  EXPECT_NEAR(a + b + volume_of_region(cut.mesh, "outside"), 1, 1e-12);
}

TEST(CutAlong, RegionsAreDividedEach) {
  TetMesh mesh = kuhn_cube(4);
  mesh.region.clear(), mesh.patch.clear();
  for (const Tet& t : mesh.tets) {
    const auto& [a, b, c, d] = t;
    mesh.region.push_back(centroid(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]).x > 0.5);
  }
  mesh.region_names = {"left", "right"};
  const CutMesh cut = cut_along(mesh, std::vector{level_set_of("low", mesh, [](Vec3 p) { return p.z - 0.3; })});
  EXPECT_EQ(cut.mesh.region_names, (std::vector<std::string>{"left", "right", "left_low", "right_low"}));
  for (const char* name : {"left_low", "right_low"}) EXPECT_NEAR(volume_of_region(cut.mesh, name), 0.15, 1e-12);
}

TEST(CutAlong, SmallPiecesGoOnRequest) {
  const TetMesh mesh = perturbed(kuhn_cube(8), 0.1, 5);
  const auto two = [](Vec3 p) {
    return std::min(distance(p, {0.3, 0.5, 0.5}) - 0.22, distance(p, {0.8, 0.8, 0.8}) - 0.15);
  };
  const std::vector sets{level_set_of("ball", mesh, two)};
  const CutMesh both = cut_along(mesh, sets), one = cut_along(mesh, sets, {.least_piece = 0.02});
  EXPECT_EQ(both.level_sets[0].pieces, 2u);
  EXPECT_EQ(both.level_sets[0].dropped, 0u);
  EXPECT_EQ(one.level_sets[0].dropped, 1u);
  EXPECT_LT(volume_of_region(one.mesh, "ball"), volume_of_region(both.mesh, "ball") - 0.001);
  EXPECT_EQ(first_defect(one.mesh), std::nullopt);
}

/// Values of no sense, and such as floating point hardly tells from 0: always valid.
TEST(CutAlong, AnyValuesGiveAValidMesh) {
  const TetMesh mesh = perturbed(kuhn_cube(4), 0.3, 6);
  std::mt19937 random(7);
  for (const double scale : {1.0, 1e-3, 1e-12, 1e-17, 1e-300}) {
    LevelSet noise{"noise", {}, 0};
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const double value = static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 0.5;
      noise.values.push_back(random() % 3 == 0 ? scale * value : value);
    }
    const CutMesh cut = cut_along(mesh, std::vector{noise});
    EXPECT_EQ(first_defect(cut.mesh), std::nullopt);
  }
}

TEST(CutAlong, AdaptationMakesTheElementsSoundAndKeepsTheSurface) {
  const TetMesh mesh = perturbed(kuhn_cube(10), 0.2, 8);
  const CutMesh cut = cut_along(mesh, std::vector{level_set_of("ball", mesh, ball_around({0.5, 0.5, 0.5}, 0.3))});
  const MetricMesh lengths{mesh.points, mesh.tets, {}, metrics::of_edges(mesh), "lengths"};
  const AdaptedMesh made = adapt_to_metric(cut.mesh, lengths);
  EXPECT_GT(made.report.quality.dihedral_min, 12);
  EXPECT_NEAR(volume_of_region(made.mesh, "ball"), cut.level_sets[0].volume, 0.01 * cut.level_sets[0].volume);
  for (const Triangle& f : made.mesh.interfaces)
    for (const VertexIndex v : f) EXPECT_NEAR(distance(made.mesh.points[v], {0.5, 0.5, 0.5}), 0.3, 0.02);
}

TEST(CutAlong, WhatMakesNoSenseIsRefused) {
  TetMesh mesh = kuhn_cube(2);
  const LevelSet plane = level_set_of("low", mesh, [](Vec3 p) { return p.z - 0.3; });
  LevelSet bad = plane;
  bad.values.pop_back();
  EXPECT_THROW(cut_along(mesh, std::vector{bad}), InputError);
  bad = plane, bad.values[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(cut_along(mesh, std::vector{bad}), InputError);
  EXPECT_THROW(cut_along(mesh, std::vector{plane, plane}), OptionError);
  EXPECT_THROW(cut_along(mesh, std::vector<LevelSet>{}), OptionError);
  mesh.region_names = {"low"};
  EXPECT_THROW(cut_along(mesh, std::vector{plane}), OptionError);
}

}  // namespace
}  // namespace octafront
