#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/quality.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include "support/complexes.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::testing::HasSubstr;

Options periodic(double h, const char* axes) {
  Options o;
  o.size.size = h;
  o.periodic = axes;
  return o;
}

/// Nodes of boundary faces on a face of the bounding box, mid-side nodes too.
std::set<VertexIndex> nodes_on(const TetMesh& mesh, int axis, double at) {
  std::set<VertexIndex> nodes;
  for (VertexIndex v = 0; v < mesh.points.size(); ++v)
    if (mesh.points[v][axis] == at) nodes.insert(v);
  return nodes;
}

std::set<std::array<VertexIndex, 3>> triangles_on(const TetMesh& mesh, int axis, double at,
                                                  const std::map<VertexIndex, VertexIndex>& renamed) {
  std::set<std::array<VertexIndex, 3>> found;
  for (Triangle t : mesh.boundary) {
    if (!std::all_of(t.begin(), t.end(), [&](VertexIndex v) { return mesh.points[v][axis] == at; })) continue;
    for (VertexIndex& v : t)
      if (!renamed.empty()) v = renamed.at(v);
    std::sort(t.begin(), t.end());
    found.insert(t);
  }
  return found;
}

/// Each node and each triangle of the high face of an axis is the copy of one of the low face, bit for bit.
void expect_same_faces(const TetMesh& mesh, int axis) {
  SCOPED_TRACE(axis);
  const Box3 box = bounding_box(mesh.points);
  const double lo = box.lo[axis], hi = box.hi[axis];
  std::map<VertexIndex, VertexIndex> original_of;
  for (const auto& [period, copy, original] : mesh.periodic_nodes) {
    const Vec3 shift = mesh.periods.at(period);
    if (shift[axis] == 0) continue;
    for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.points[original][k] + shift[k], mesh.points[copy][k]);
    original_of[copy] = original;
  }
  std::set<VertexIndex> copies, originals;
  for (const auto& [copy, original] : original_of) copies.insert(copy), originals.insert(original);
  EXPECT_EQ(copies, nodes_on(mesh, axis, hi));
  EXPECT_EQ(originals, nodes_on(mesh, axis, lo));
  const auto low = triangles_on(mesh, axis, lo, {});
  EXPECT_FALSE(low.empty());
  EXPECT_EQ(low, triangles_on(mesh, axis, hi, original_of));
}

TEST(Periodic, BoxesHaveTheSameOppositeFaces) {
  for (const char* axes : {"x", "yz", "xyz"})
    for (const double h : {0.9, 0.3, 0.12}) {
      SCOPED_TRACE(::testing::Message() << axes << " " << h);
      const Result r =
          generate(testing::transformed(testing::box(1, 1.3, 0.7, 2), 1, {0.1, -0.2, 0.3}), periodic(h, axes));
      EXPECT_EQ(first_defect(r.mesh), std::nullopt);
      EXPECT_NEAR(r.report.volume, 0.91, 1e-12);
      EXPECT_EQ(r.mesh.periods.size(), std::string(axes).size());
      for (const char axis : std::string(axes)) expect_same_faces(r.mesh, axis - 'x');
    }
}

TEST(Periodic, ComplexesWhoseFacesDifferAreImprinted) {
  const testing::KnownComplex foam = testing::foam(6, 5);
  const Result r = generate(foam.surface, periodic(0.15, "xyz"));
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  for (int axis = 0; axis < 3; ++axis) expect_same_faces(r.mesh, axis);
  ASSERT_EQ(r.report.regions.size(), foam.volumes.size());
  for (std::size_t k = 0; k < foam.volumes.size(); ++k) EXPECT_NEAR(r.report.regions[k].volume, foam.volumes[k], 1e-6);
}

TEST(Periodic, SheetsEndOnBothFaces) {
  const Result r = generate(testing::cracked_plate().surface, periodic(0.2, "xy"));
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  expect_same_faces(r.mesh, 0);
  expect_same_faces(r.mesh, 1);
}

TEST(Periodic, NodesBehindCornersArePaired) {
  for (const int order : {2, 3, 4}) {
    Options o = periodic(0.3, "xyz");
    o.order = order;
    const Result r = generate(testing::cube(1), o);
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    EXPECT_EQ(r.mesh.order(), order);
    for (int axis = 0; axis < 3; ++axis) expect_same_faces(r.mesh, axis);
    Options along = o;
    along.size.size = 0.4;
    along.periodic.erase(0, 2);  // "z"
    const Result pipe = generate(testing::pipe(48, 20), along);
    EXPECT_EQ(check_jacobians(pipe.mesh).invalid, 0u);
    EXPECT_GT(pipe.report.second_order.curved, 100u);
    expect_same_faces(pipe.mesh, 2);
    Options same;
    same.order = order;
    const Improved improved = improve_existing(pipe.mesh, same);
    EXPECT_EQ(check_jacobians(improved.mesh).invalid, 0u);
    expect_same_faces(improved.mesh, 2);
    EXPECT_NEAR(improved.report.volume, pipe.report.volume, 1e-3 * pipe.report.volume);
  }
}

TEST(Periodic, QualityIsThatWithoutPeriods) {
  const Result with = generate(testing::cube(1), periodic(0.1, "xyz")),
               without = generate(testing::cube(1), periodic(0.1, ""));
  EXPECT_NEAR(with.report.quality.beta_mean, without.report.quality.beta_mean, 0.005);
  EXPECT_TRUE(without.mesh.periodic_nodes.empty());
}

TEST(Periodic, KeptTrianglesArePairedAsTheyAre) {
  Options o = periodic(0.3, "xyz");
  o.surface.keep = true;
  const SurfaceMesh cube = testing::cube(4);
  const Result r = generate(cube, o);
  for (int axis = 0; axis < 3; ++axis) expect_same_faces(r.mesh, axis);
}

TEST(Periodic, IsTheSameForEveryNumberOfThreads) {
  const SurfaceMesh cube = testing::cube(1);
  RunContext one;
  one.threads = 1;
  RunContext four;
  four.threads = 4;
  EXPECT_EQ(generate(cube, periodic(0.15, "xyz"), one).mesh, generate(cube, periodic(0.15, "xyz"), four).mesh);
}

TEST(Periodic, RefusesWhatCannotBe) {
  EXPECT_THROW(generate(testing::icosphere(3), periodic(0.3, "x")), InputError);
  EXPECT_THROW(generate(testing::cube(1), periodic(0.3, "xq")), OptionError);
  Options layered = periodic(0.3, "x");
  layered.layers.count = 2, layered.layers.first = 0.01;
  EXPECT_THROW(generate(testing::cube(1), layered), OptionError);
  Options stuffed = periodic(0.3, "x");
  stuffed.method = Method::kOctree;
  EXPECT_THROW(generate(testing::cube(1), stuffed), OptionError);
  SurfaceMesh wedge = testing::cube(1);
  for (Vec3& p : wedge.points)
    if (p.x == 1 && p.z == 1) p.z = 0.5;
  try {
    generate(wedge, periodic(0.3, "x"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("x_min has something at"));
  }
}

}  // namespace
}  // namespace octafront
