// Corners of a mesh on their way to the true geometry.

#include <octafront/run_context.h>
#include <octafront/validity.h>

#include "../start_meshes.h"
#include "improve/curved/curved.h"
#include "support/parts_by_patch.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

constexpr int kCubes = 8;
constexpr double kEdge = 1.0 / kCubes;

/// The sides of the unit cube as patches, of which one lies elsewhere.
class Sides6 final : public testing::PartsByPatch {
 public:
  /// The side z = 1 lies at 1 + height(p).
  using Height = double (*)(Vec3);
  Sides6(const TetMesh& cube, Height height)
      : PartsByPatch({"a", "b", "c", "d", "e", "f"}), height_(height), side_of_(6) {
    for (std::size_t f = 0; f < cube.boundary.size(); ++f)
      for (std::uint32_t side = 0; side < 6; ++side)
        if (lies_on(cube, cube.boundary[f], side)) side_of_[cube.patch[f]] = side;
  }

  std::optional<Vec3> on_face(std::uint32_t patch, Vec3 p) const override { return put_on(side_of_[patch], p); }
  std::optional<Vec3> on_edge(std::span<const std::uint32_t> patches, Vec3 p) const override {
    for (const std::uint32_t patch : patches) p = put_on(side_of_[patch], p);
    return p;
  }
  bool is_vertex(Vec3) const override { return false; }

 private:
  /// Sides 0 to 5: x = 0, x = 1, y = 0, ...
  static double& coordinate(Vec3& p, std::uint32_t side) { return side < 2 ? p.x : side < 4 ? p.y : p.z; }
  static bool lies_on(const TetMesh& cube, const Triangle& t, std::uint32_t side) {
    return std::all_of(t.begin(), t.end(), [&](VertexIndex v) {
      Vec3 p = cube.points[v];
      return coordinate(p, side) == side % 2;
    });
  }
  Vec3 put_on(std::uint32_t side, Vec3 p) const {
    coordinate(p, side) = side == 5 ? 1 + height_(p) : side % 2;
    return p;
  }

  Height height_;
  std::vector<std::uint32_t> side_of_;  ///< per patch
};

double highest(const TetMesh& mesh) {
  double z = 0;
  for (const Vec3& p : mesh.points) z = std::max(z, p.z);
  return z;
}

TEST(TrueBends, AWholeSideGoesTogetherFartherThanHalfAnEdge) {
  TetMesh mesh = testing::kuhn_cube(kCubes);
  const Sides6 geometry(mesh, [](Vec3) { return 0.9 * kEdge; });
  const SecondOrderSummary made = move_to_geometry(mesh, geometry, {}, no_context());
  EXPECT_EQ(made.held, 0u);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_NEAR(testing::volume(mesh), 1 + 0.9 * kEdge, 1e-12);
}

TEST(TrueBends, AVertexAloneStaysAndIsCounted) {
  TetMesh mesh = testing::kuhn_cube(kCubes);
  const Sides6 geometry(mesh, [](Vec3 p) { return std::hypot(p.x - 0.5, p.y - 0.5) < 0.01 ? 0.9 * kEdge : 0.0; });
  EXPECT_EQ(move_to_geometry(mesh, geometry, {}, no_context()).held, 1u);
  EXPECT_EQ(highest(mesh), 1);
}

TEST(TrueBends, AVertexAloneGoesWhereItIsNear) {
  TetMesh mesh = testing::kuhn_cube(kCubes);
  const Sides6 geometry(mesh, [](Vec3 p) { return std::hypot(p.x - 0.5, p.y - 0.5) < 0.01 ? 0.4 * kEdge : 0.0; });
  EXPECT_EQ(move_to_geometry(mesh, geometry, {}, no_context()).held, 0u);
  EXPECT_EQ(highest(mesh), 1 + 0.4 * kEdge);
}

}  // namespace
}  // namespace octafront
