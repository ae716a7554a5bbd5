#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/validity.h>

#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "base/geometry/true_geometry.h"
#include "improve/start_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;
using ::octafront::testing::volume;

/// The cube's points drawn to spheres around (0, 0, 0): a ball of radius 1.
Vec3 on_ball(Vec3 p) {
  const Vec3 q = 2 * p - Vec3{1, 1, 1};
  const double cube = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}), round = length(q);
  return round > 0 ? (cube / round) * q : q;
}

TetMesh ball_of(int n) {
  TetMesh mesh = kuhn_cube(n);
  for (Vec3& p : mesh.points) p = on_ball(p);
  mesh.patch.assign(mesh.boundary.size(), 0);
  return mesh;
}

SurfaceMesh surface_of(const TetMesh& mesh) {
  SurfaceMesh surface;
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  for (Triangle t : mesh.boundary) {
    for (VertexIndex& v : t) {
      if (number[v] == kNone) {
        number[v] = static_cast<VertexIndex>(surface.points.size());
        surface.points.push_back(mesh.points[v]);
      }
      v = number[v];
    }
    surface.triangles.push_back(t);
  }
  return surface;
}

AdaptedMesh adapted_on(const TetMesh& mesh, double size, const Domain& surface, int threads = 0,
                       const std::string& only = {}) {
  Options options;
  options.size.size = size;
  options.adapt.only = only;
  RunContext context;
  context.threads = threads;
  return adapt_existing(mesh, options, context, &surface);
}

/// The farthest that vertices of the boundary are from triangles.
double farthest(const TetMesh& mesh, const SurfaceMesh& surface) {
  const TriangleTree tree(surface);
  double far = 0;
  for (const Triangle& t : mesh.boundary)
    for (const VertexIndex v : t) far = std::max(far, std::sqrt(tree.nearest(mesh.points[v]).squared_distance));
  return far;
}

bool report_says(const Report& report, const std::string& words) {
  for (const StageReport& stage : report.stages)
    for (const std::string& note : stage.notes)
      if (note.find(words) != std::string::npos) return true;
  return false;
}

TEST(AdaptGiven, CoarseMeshComesToTheFineSurfaceAndItsVolume) {
  const TetMesh start = ball_of(4);
  const TetMesh exact = ball_of(30);
  const Domain surface(surface_of(exact));
  const AdaptedMesh made = adapted_on(start, 0.12, surface);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_LT(farthest(made.mesh, surface.surface), 1e-12);
  EXPECT_GT(std::abs(volume(start) / volume(exact) - 1), 0.05);
  // Flat triangles of edges h cut .37 h^2 off a ball.
  EXPECT_LT(std::abs(volume(made.mesh) / volume(exact) - 1), 6e-3);
  EXPECT_LT(made.deviation.upper, made.deviation.bound);
  // By itself it knows of 16 triangles each side and no more.
  Options options;
  options.size.size = 0.12;
  EXPECT_GT(farthest(adapt_existing(start, options).mesh, surface.surface), 1e-3);
}

TEST(AdaptGiven, LoopsDoNotWearTheBody) {
  const TetMesh exact = ball_of(20);
  const Domain surface(surface_of(exact));
  TetMesh mesh = ball_of(8);
  std::vector<double> volumes;
  for (int loop = 0; loop < 3; ++loop) {
    mesh = adapted_on(mesh, 0.6, surface).mesh;
    mesh = adapted_on(mesh, 0.2, surface).mesh;
    volumes.push_back(volume(mesh) / volume(exact));
  }
  EXPECT_NEAR(volumes[0], 1, 0.02);  // what flat triangles of that size cut off
  EXPECT_NEAR(volumes[2], volumes[0], 2e-3);
}

TEST(AdaptGiven, SameBitsForAnyNumberOfThreads) {
  const Domain surface(surface_of(ball_of(20)));
  EXPECT_EQ(adapted_on(ball_of(5), 0.09, surface, 1).mesh, adapted_on(ball_of(5), 0.09, surface, 3).mesh);
}

/// The unit sphere, patch 0.
class Sphere : public TrueGeometry {
 public:
  std::optional<Vec3> on_face(std::uint32_t, Vec3 p) const override { return normalized(p); }
  std::optional<Vec3> on_edge(std::span<const std::uint32_t>, Vec3) const override { return std::nullopt; }
  bool is_vertex(Vec3) const override { return false; }
  const std::vector<std::string>& patch_names() const override { return names_; }
  std::uint32_t part_at(std::uint32_t, Vec3) const override { return 0; }
  const std::vector<std::string>& part_names() const override { return names_; }
  std::uint32_t patch_of_part(std::uint32_t) const override { return 0; }
  const std::vector<PartGroup>& groups() const override { return groups_; }

 private:
  std::vector<std::string> names_{"sphere"};
  std::vector<PartGroup> groups_;
};

TEST(AdaptGiven, TrueGeometryGoesBeforeItsTriangles) {
  Domain surface(surface_of(ball_of(6)));
  surface.geometry = std::make_shared<Sphere>();
  const AdaptedMesh made = adapted_on(ball_of(4), 0.15, surface);
  double off = 0;
  for (const Triangle& t : made.mesh.boundary)
    for (const VertexIndex v : t) off = std::max(off, std::abs(length(made.mesh.points[v]) - 1));
  EXPECT_LT(off, 1e-12);
  EXPECT_LT(made.deviation.upper, made.deviation.bound);
}

/// The unit cube with sides pushed out by `bulge` in their middles, its edges kept.
SurfaceMesh bulged_cube(int n, double bulge) {
  SurfaceMesh surface = surface_of(kuhn_cube(n));
  for (Vec3& p : surface.points) {
    const Vec3 q = p;
    for (int axis = 0; axis < 3; ++axis) {
      if (q[axis] != 0 && q[axis] != 1) continue;
      const int i = (axis + 1) % 3, j = (axis + 2) % 3;
      p[axis] += (q[axis] == 0 ? -1 : 1) * bulge * 16 * q[i] * (1 - q[i]) * q[j] * (1 - q[j]);
    }
  }
  return surface;
}

TEST(AdaptGiven, CornersAndEdgesStayWhereTheSurfaceHasThem) {
  const Domain surface(bulged_cube(24, 0.012));
  const AdaptedMesh made = adapted_on(kuhn_cube(3), 0.12, surface);
  EXPECT_LT(farthest(made.mesh, surface.surface), 1e-12);
  EXPECT_GT(volume(made.mesh), 1.02);
  int corners = 0, on_edges = 0;
  for (const Vec3 p : made.mesh.points) {
    const int planes = (p.x == 0 || p.x == 1) + (p.y == 0 || p.y == 1) + (p.z == 0 || p.z == 1);
    corners += planes == 3, on_edges += planes == 2;
  }
  EXPECT_EQ(corners, 8);
  EXPECT_GE(on_edges, 12 * 5);  // edges of 1 / 6, the longest that fit
}

TEST(AdaptGiven, WallsThatTheSurfaceDoesNotHaveKeepTheirOwn) {
  TetMesh start = kuhn_cube(4);
  for (TetIndex t = 0; t < start.tets.size(); ++t) {
    double z = 0;
    for (const VertexIndex v : start.tets[t]) z += start.points[v].z / 4;
    start.region.push_back(z > 0.5);
  }
  start.region_names = {"low", "high"};
  const Domain surface(bulged_cube(16, 0.01));
  const AdaptedMesh made = adapted_on(start, 0.15, surface);
  EXPECT_TRUE(report_says(made.report, "32 of 224 wall triangles are farther from the surface"));
  double low = 0;
  for (TetIndex t = 0; t < made.mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = made.mesh.tets[t];
    const auto& p = made.mesh.points;
    if (made.mesh.region[t] == 0)
      for (const VertexIndex v : {a, b, c, d}) EXPECT_LE(p[v].z, 0.5 + 1e-4);
    else
      for (const VertexIndex v : {a, b, c, d}) EXPECT_GE(p[v].z, 0.5 - 1e-4);
    low = std::min(low, signed_volume(p[a], p[b], p[c], p[d]));
  }
  EXPECT_EQ(low, 0);
  EXPECT_LT(farthest(made.mesh, surface.surface), 1e-12);
}

TEST(AdaptGiven, AThinInnerLayerIsNotDrawnToTheSurface) {
  // The wall of the layer is a hundredth below the top: nearer than what counts as near.
  TetMesh start = kuhn_cube(5);
  for (Vec3& p : start.points)
    if (std::abs(p.z - 0.8) < 1e-9) p.z = 0.99;
  for (TetIndex t = 0; t < start.tets.size(); ++t) {
    double z = 0;
    for (const VertexIndex v : start.tets[t]) z = std::max(z, start.points[v].z);
    start.region.push_back(z > 0.995);
  }
  start.region_names = {"body", "layer"};
  ASSERT_EQ(first_defect(start), std::nullopt);
  const Domain surface(surface_of(kuhn_cube(1)));
  const AdaptedMesh made = adapted_on(start, 0.2, surface);
  double layer = 0;
  for (TetIndex t = 0; t < made.mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = made.mesh.tets[t];
    const auto& p = made.mesh.points;
    if (made.mesh.region[t] == 1) layer += signed_volume(p[a], p[b], p[c], p[d]);
  }
  EXPECT_NEAR(layer, 0.01, 1e-12);
}

TEST(AdaptGiven, OutsideOfAPlaceNothingMoves) {
  const TetMesh start = ball_of(6);
  const Domain surface(surface_of(ball_of(24)));
  const AdaptedMesh made = adapted_on(start, 0.1, surface, 0, "sphere:0,0,1,0.2");
  std::size_t same = 0, beside = 0;
  for (VertexIndex v = 0; v < made.mesh.points.size(); ++v) {
    if (made.old_of_new[v] == kNone) continue;
    const Vec3 was = start.points[made.old_of_new[v]];
    same += made.mesh.points[v] == was;
    beside += made.mesh.points[v] != was && was.z < 0;
  }
  EXPECT_EQ(beside, 0u);
  EXPECT_GT(same, start.points.size() / 2);
  EXPECT_LT(made.deviation.upper, made.deviation.bound);
}

TEST(AdaptGiven, SurfaceOfAnotherPlaceIsRefused) {
  SurfaceMesh away = surface_of(ball_of(6));
  for (Vec3& p : away.points) p.x += 5;
  EXPECT_THROW(adapted_on(ball_of(4), 0.3, Domain(away)), InputError);
}

TEST(AdaptGiven, OpenSurfaceIsFollowedWhereItIs) {
  SurfaceMesh half = surface_of(ball_of(20));
  std::erase_if(half.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](VertexIndex v) { return half.points[v].z < 0; });
  });
  const AdaptedMesh made = adapted_on(ball_of(5), 0.16, Domain(half));
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_TRUE(report_says(made.report, "stand for their own smooth surface"));
  const TriangleTree tree(half);
  for (const Triangle& t : made.mesh.boundary)
    for (const VertexIndex v : t)
      EXPECT_TRUE(made.mesh.points[v].z < 0.4 || tree.nearest(made.mesh.points[v]).squared_distance < 1e-24);
}

}  // namespace
}  // namespace octafront
