#include <octafront/adapt.h>
#include <octafront/error.h>

#include "improve/start_meshes.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;
using ::octafront::testing::perturbed;

double volume_of_tet(const TetMesh& mesh, TetIndex t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  const auto& p = mesh.points;
  return dot(cross(p[b] - p[a], p[c] - p[a]), p[d] - p[a]) / 6;
}

Vec3 middle_of(const TetMesh& mesh, TetIndex t) {
  Vec3 sum{};
  for (const VertexIndex v : mesh.tets[t]) sum += 0.25 * mesh.points[v];
  return sum;
}

AdaptedMesh adapted_to(const TetMesh& mesh, double size, const std::string& only = {}) {
  Options options;
  options.size.size = size;
  options.adapt.only = only;
  return adapt_existing(mesh, options);
}

/// A ball: the cube's points drawn to spheres. Its walls are curved, so new vertices lie off the old ones.
TetMesh ball(int n) {
  TetMesh mesh = kuhn_cube(n);
  for (Vec3& p : mesh.points) {
    const Vec3 q = 2 * p - Vec3{1, 1, 1};
    const double cube = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}), round = length(q);
    p = round > 0 ? (cube / round) * q : q;
  }
  mesh.patch.clear();
  return mesh;
}

TEST(Carry, LinearFunctionsStayExact) {
  const TetMesh start = perturbed(kuhn_cube(5), 0.2, 1);
  MeshField u{"u", false, 2, {}};
  const auto f = [](Vec3 p) { return 1 + 2 * p.x - 3 * p.y + 0.5 * p.z; };
  const auto g = [](Vec3 p) { return p.z - 7 * p.x; };
  for (const Vec3& p : start.points) u.values.push_back(f(p)), u.values.push_back(g(p));
  for (const double size : {0.07, 0.4}) {
    const AdaptedMesh made = adapted_to(start, size);
    const MeshField now = carried(u, start, made);
    ASSERT_EQ(now.values.size(), 2 * made.mesh.points.size());
    for (VertexIndex v = 0; v < made.mesh.points.size(); ++v) {
      EXPECT_NEAR(now.values[2 * v], f(made.mesh.points[v]), 1e-12);
      EXPECT_NEAR(now.values[2 * v + 1], g(made.mesh.points[v]), 1e-12);
    }
  }
}

TEST(Carry, VerticesThatStayKeepTheirBits) {
  const TetMesh start = kuhn_cube(6);
  MeshField u{"u", false, 1, {}};
  for (std::size_t v = 0; v < start.points.size(); ++v) u.values.push_back(1.0 / static_cast<double>(v + 3));
  const AdaptedMesh made = adapted_to(start, 0.05, "sphere:0.5,0.5,0.5,0.1");
  const MeshField now = carried(u, start, made);
  std::size_t same = 0;
  for (VertexIndex v = 0; v < now.values.size(); ++v) {
    const VertexIndex old = made.old_of_new[v];
    if (old == kNone || start.points[old] != made.mesh.points[v]) continue;
    EXPECT_EQ(now.values[v], u.values[old]);
    ++same;
  }
  EXPECT_GT(same, 150u);
}

TEST(Carry, LinearFunctionsOnCurvedBodiesGoOnOutside) {
  const TetMesh start = ball(6);
  MeshField u{"u", false, 1, {}};
  for (const Vec3& p : start.points) u.values.push_back(3 * p.x + p.y);
  const AdaptedMesh made = adapted_to(start, 0.15);
  const MeshField now = carried(u, start, made);
  std::size_t exact = 0;
  for (VertexIndex v = 0; v < now.values.size(); ++v) {
    const double wanted = 3 * made.mesh.points[v].x + made.mesh.points[v].y;
    EXPECT_NEAR(now.values[v], wanted, 0.1);
    exact += std::abs(now.values[v] - wanted) < 1e-11;
  }
  EXPECT_GT(exact, 99 * now.values.size() / 100);
}

/// The integral over one region, or with kNone over all, and that of the absolute value.
std::pair<double, double> integral(const TetMesh& mesh, const MeshField& field, std::uint32_t region) {
  double sum = 0, all = 0;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    if (!mesh.region.empty() && mesh.region[t] != region) continue;
    const double part = volume_of_tet(mesh, t) * field.values[t];
    sum += part, all += std::abs(part);
  }
  return {sum, all};
}

TEST(Carry, IntegralsOfElementsStayInEachRegion) {
  TetMesh start = ball(6);
  for (TetIndex t = 0; t < start.tets.size(); ++t) start.region.push_back(middle_of(start, t).x > 0);
  MeshField u{"u", true, 1, {}};
  for (TetIndex t = 0; t < start.tets.size(); ++t) {
    const Vec3 p = middle_of(start, t);
    u.values.push_back(start.region[t] == 0 ? 1000 : p.x * p.y - 0.01);
  }
  for (const double size : {0.12, 0.6}) {
    const AdaptedMesh made = adapted_to(start, size);
    const MeshField now = carried(u, start, made);
    for (const std::uint32_t region : {0u, 1u}) {
      const auto had = integral(start, u, region), has = integral(made.mesh, now, region);
      EXPECT_NEAR(had.first, has.first, 1e-12 * had.second);
    }
    // Regions do not mix: one is constant, up to what its wall moved.
    for (TetIndex t = 0; t < made.mesh.tets.size(); ++t) {
      if (made.mesh.region[t] == 0) {
        EXPECT_NEAR(now.values[t], 1000, 100);
      } else {
        EXPECT_LT(std::abs(now.values[t]), 2);
      }
    }
  }
}

TEST(Carry, ConstantsStayConstantWhereWallsAreFlat) {
  const TetMesh start = perturbed(kuhn_cube(5), 0.2, 2);
  const MeshField u{"u", true, 1, std::vector<double>(start.tets.size(), 5)};
  const AdaptedMesh made = adapted_to(start, 0.08);
  for (const double value : carried(u, start, made).values) EXPECT_NEAR(value, 5, 1e-11);
}

TEST(Carry, UnchangedElementsKeepTheirBits) {
  const TetMesh start = kuhn_cube(6);
  MeshField u{"u", true, 1, {}};
  for (std::size_t t = 0; t < start.tets.size(); ++t) u.values.push_back(1.0 / static_cast<double>(t + 3));
  const AdaptedMesh made = adapted_to(start, 0.05, "sphere:0.5,0.5,0.5,0.1");
  const MeshField now = carried(u, start, made);
  std::size_t same = 0;
  for (TetIndex t = 0; t < now.values.size(); ++t) {
    if (made.old_tet_of_new[t] == kNone) continue;
    EXPECT_EQ(now.values[t], u.values[made.old_tet_of_new[t]]);
    ++same;
  }
  EXPECT_GT(same, start.tets.size() / 5);
  const auto had = integral(start, u, 0), has = integral(made.mesh, now, 0);
  EXPECT_NEAR(had.first, has.first, 1e-12 * had.second);
}

TEST(Carry, FieldsOfAnotherMeshAreRefused) {
  const TetMesh start = kuhn_cube(2);
  const AdaptedMesh made = adapted_to(start, 0.3);
  EXPECT_THROW(carried({"u", false, 1, {1, 2}}, start, made), InputError);
  EXPECT_THROW(carried({"u", true, 0, {}}, start, made), InputError);
  std::vector<double> bad(start.points.size(), 1);
  bad[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(carried({"u", false, 1, bad}, start, made), InputError);
}

}  // namespace
}  // namespace octafront
