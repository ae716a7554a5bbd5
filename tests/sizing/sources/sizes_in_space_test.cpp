// Sizes by distance, on meshes, across walls.

#include <octafront/error.h>

#include "sizing/field/mesh_sizes.h"
#include "sizing/size_cases.h"
#include "sizing/sources/gaps.h"
#include "sizing/sources/sources.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;
using testing::joined;
using testing::random_point;
using testing::sizes_of;
using testing::transformed;

/// Sizes at the eight corners of a box, in six tetrahedra around a diagonal.
std::shared_ptr<SizeMesh> box_of_tets(Box3 of, double (*size)(Vec3)) {
  auto mesh = std::make_shared<SizeMesh>();
  for (int k = 0; k < 8; ++k)
    mesh->points.push_back(
        {(k & 1) != 0 ? of.hi.x : of.lo.x, (k & 2) != 0 ? of.hi.y : of.lo.y, (k & 4) != 0 ? of.hi.z : of.lo.z});
  mesh->tets = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  for (const Vec3 p : mesh->points) mesh->point_sizes.push_back(size(p));
  mesh->name = "box";
  return mesh;
}

double rising(Vec3 p) {
  return 0.1 + 0.05 * p.x + 0.02 * p.y;
}

TEST(MeshSizes, AreLinearInsideAndThoseOfTheNearestPointOutside) {
  const MeshSizes sizes(box_of_tets({{0, 0, 0}, {2, 1, 1}}, rising));
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_point(random, {{0, 0, 0}, {2, 1, 1}});
    const Vec3 inside = max(Vec3{0, 0, 0}, min(p, Vec3{2, 1, 1}));
    const MeshSizes::Answer answer = sizes.at(p);
    EXPECT_NEAR(answer.size, rising(inside), 1e-12);
    EXPECT_NEAR(answer.away, distance(p, inside), 1e-12);
  }
}

TEST(MeshSizes, KnowAnUnderBoundInEveryBox) {
  const MeshSizes sizes(box_of_tets({{0, 0, 0}, {2, 1, 1}}, rising));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> part(0, 1);
  constexpr double kRounding = 1e-12;
  for (int i = 0; i < 300; ++i) {
    const Vec3 a = random_point(random, {{-1, -1, -1}, {3, 2, 2}}), b = random_point(random, {{-1, -1, -1}, {3, 2, 2}});
    const Box3 in{min(a, b), max(a, b)};
    const double least = sizes.least_in(in);
    for (int k = 0; k < 20; ++k) {
      const Vec3 e = in.extent();
      EXPECT_GE(sizes.at(in.lo + Vec3{part(random) * e.x, part(random) * e.y, part(random) * e.z}).size,
                least - kRounding);
    }
  }
}

TEST(MeshSizes, OfElementsAreThoseOfTheElement) {
  auto mesh = box_of_tets({{0, 0, 0}, {1, 1, 1}}, rising);
  mesh->point_sizes.clear();
  mesh->element_sizes = {1, 2, 3, 4, 5, 6};
  const MeshSizes sizes(mesh);
  for (std::size_t t = 0; t < mesh->tets.size(); ++t) {
    Vec3 middle;
    for (const VertexIndex v : mesh->tets[t]) middle += mesh->points[v] * 0.25;
    EXPECT_EQ(sizes.at(middle).size, mesh->element_sizes[t]);
  }
}

TEST(SizeField, FollowsAMeshOnTheSurfaceAndInside) {
  SizeOptions options;
  options.mesh = box_of_tets({{0, 0, 0}, {1, 1, 1}}, [](Vec3 p) { return 0.02 + 0.05 * p.x; });
  const SizeField field = sizes_of(box(1, 1, 1), options);
  for (const Vec3 p : {Vec3{0.02, 0.5, 0.5}, Vec3{0.5, 0.5, 0.5}, Vec3{0.9, 0.2, 0.7}, Vec3{0.3, 0, 0.4}})
    EXPECT_NEAR(field.at(p), 0.02 + 0.05 * p.x, 0.12 * (0.02 + 0.05 * p.x)) << p.x;
}

TEST(SizeField, NearAPlaceRisesByItsLaw) {
  SizeOptions options;
  options.size = 0.5;
  options.near = {{"", {0, 0.5, 0.5}, 0.02, 1}};
  options.gradation = 1;
  const SurfaceMesh body = box(2, 1, 1);
  const SizeField field = sizes_of(body, options, detect_features(body, 40));
  // size / (1 - s / distance), inside too.
  for (const double s : {0.05, 0.25, 0.5, 0.75}) {
    const double law = 0.02 / (1 - s);
    EXPECT_LE(field.at({s, 0.5, 0.5}), 1.02 * law) << s;
    EXPECT_GE(field.at({s, 0.5, 0.5}), 0.75 * law) << s;
  }
  EXPECT_GT(field.at({2, 0.5, 0.5}), 0.4);
}

TEST(SizeField, NearAPatchItIsTheSizeAllOverIt) {
  SurfaceMesh body = box(2, 1, 1);
  body.patch.assign(body.triangles.size(), 0);
  body.patch_names = {"rest", "end"};
  for (std::size_t t = 0; t < body.triangles.size(); ++t)
    if (std::ranges::all_of(body.triangles[t], [&](VertexIndex v) { return body.points[v].x == 0; })) body.patch[t] = 1;
  SizeOptions options;
  options.size = 0.4;
  options.near = {{"end", {}, 0.05, 0.5}};
  const SizeField field = sizes_of(body, options);
  for (const double y : {0.1, 0.5, 0.9}) EXPECT_NEAR(field.at({0, y, 0.5}), 0.05, 0.005);
  EXPECT_GT(field.at({2, 0.5, 0.5}), 0.2);
  options.near = {{"nowhere", {}, 0.05, 0.5}};
  EXPECT_THROW(sizes_of(body, options), OptionError);
}

TEST(SizeField, ThroughWallsLeavesGapsAlone) {
  // Two plates of .1, a gap of .02 between them.
  const SurfaceMesh plates = joined(box(1, 1, 0.1), transformed(box(1, 1, 0.1), 1, {0, 0, 0.12}));
  SizeOptions options;
  options.size = 0.3;
  options.through = 2;
  const SizeField field = sizes_of(plates, options);
  EXPECT_NEAR(field.at({0.5, 0.5, 0.1}), 0.05, 0.01);
  options.through.reset();
  options.gap = 2;
  EXPECT_LT(sizes_of(plates, options).at({0.5, 0.5, 0.1}), 0.02);
}

TEST(SizeField, RefusesMeshesThatAreNone) {
  SizeOptions options;
  const auto with = [&](auto change) {
    auto mesh = box_of_tets({{0, 0, 0}, {1, 1, 1}}, rising);
    change(*mesh);
    options.mesh = mesh;
    EXPECT_THROW(sizes_of(box(1, 1, 1), options), OptionError);
  };
  with([](SizeMesh& m) { m.point_sizes.pop_back(); });
  with([](SizeMesh& m) { m.point_sizes[3] = 0; });
  with([](SizeMesh& m) { m.tets[2][1] = 99; });
  with([](SizeMesh& m) { m.tets.clear(); });
  with([](SizeMesh& m) { m.points[0].x = NAN; });
}

}  // namespace
}  // namespace octafront
