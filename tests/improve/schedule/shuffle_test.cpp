// What comes out hangs on the mesh alone: not on the slots in which its elements lie while it is improved, nor on the
// order in which they came.

#include "improve/shuffle.h"

#include <octafront/validity.h>

#include "base/mesh/features.h"
#include "improve/schedule/schedule.h"
#include "improve/start_meshes.h"

#include <algorithm>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace octafront::improve {
namespace {

using namespace octafront::testing;
using Level = ImproveOptions::Level;

struct ShuffledResult {
  TetMesh mesh;
  int stages = 0;
};

/// With `seed` the mesh is shuffled before each stage.
ShuffledResult improve_shuffled(TetMesh mesh, const BoundaryInput* input, const ImproveOptions& options,
                                std::optional<std::uint64_t> seed) {
  ShuffledResult result;
  StageReport report;
  SlotShuffle shuffle(seed.value_or(0));
  const auto before_stage = [&](MeshOfPieces& pieces) {
    ++result.stages;
    if (seed) shuffle(pieces);
  };
  improve_mesh(mesh, input, options, {{}, report}, nullptr, Tets::kAll, before_stage);
  result.mesh = std::move(mesh);
  return result;
}

void expect_same_shuffled(const TetMesh& start, const BoundaryInput* input, const ImproveOptions& options) {
  const ShuffledResult plain = improve_shuffled(start, input, options, std::nullopt);
  ASSERT_EQ(first_defect(plain.mesh), std::nullopt);
  EXPECT_NE(plain.mesh.points, start.points);
  for (const std::uint64_t seed : {1, 2}) {
    const ShuffledResult shuffled = improve_shuffled(start, input, options, seed);
    EXPECT_EQ(shuffled.stages, plain.stages);
    EXPECT_EQ(shuffled.mesh.points, plain.mesh.points);
    EXPECT_EQ(shuffled.mesh.tets, plain.mesh.tets);
    EXPECT_EQ(shuffled.mesh.region, plain.mesh.region);
    EXPECT_EQ(shuffled.mesh.boundary, plain.mesh.boundary);
  }
}

ImproveOptions at(Level level) {
  ImproveOptions options;
  options.level = level;
  return options;
}

TEST(Shuffle, ChangesNothingAtAnyLevel) {
  for (const Level level : {Level::kPaper, Level::kFast, Level::kDefault, Level::kBest}) {
    SCOPED_TRACE(static_cast<int>(level));
    expect_same_shuffled(perturbed(kuhn_cube(10), 0.6, 3), nullptr, at(level));
  }
}

TEST(Shuffle, ChangesNothingInManyPieces) {
  const TetMesh start = perturbed(kuhn_cube(26), 0.5, 4);
  EXPECT_GT(improve_shuffled(start, nullptr, at(Level::kDefault), std::nullopt).stages, 2);
  expect_same_shuffled(start, nullptr, at(Level::kDefault));
}

TEST(Shuffle, ChangesNothingForOtherObjectives) {
  for (const auto objective : {ImproveOptions::Objective::kMeanRatio, ImproveOptions::Objective::kSolver}) {
    ImproveOptions options = at(Level::kDefault);
    options.objective = objective;
    expect_same_shuffled(perturbed(kuhn_cube(8), 0.6, 5), nullptr, options);
  }
}

TEST(Shuffle, ChangesNothingBetweenRegions) {
  TetMesh mesh = perturbed(kuhn_cube(9), 0.6, 6);
  for (const Tet& t : mesh.tets) mesh.region.push_back(mesh.points[t[0]].x + mesh.points[t[1]].y > 0.8);
  expect_same_shuffled(mesh, nullptr, at(Level::kDefault));
}

/// The sides of the cube, on which its vertices may slide; with a tolerance they may leave them, too.
void expect_same_on_sides(const TetMesh& start, double tolerance) {
  const TetMesh first = kuhn_cube(1);
  const SurfaceMesh surface{first.points, first.boundary, first.patch, {}, {}};
  const Features features = detect_features(surface, 40);
  const Features of_mesh = detect_features({start.points, start.boundary, start.patch, {}, {}}, 40);
  const TriangleTree tree(surface);
  const BoundaryInput input{surface, tree, features, of_mesh, tolerance};
  expect_same_shuffled(start, &input, at(Level::kDefault));
}

TEST(Shuffle, ChangesNothingOnTheBoundary) {
  expect_same_on_sides(perturbed(kuhn_cube(10), 0.7, 7), 0);
  TetMesh pressed = perturbed(kuhn_cube(8), 0.5, 8);
  for (VertexIndex v = 0; v < pressed.points.size(); ++v) {
    Vec3& p = pressed.points[v];
    const Vec3 was = p;
    if (p.z != 0 || p.x == 0 || p.y == 0 || p.x == 1 || p.y == 1) continue;
    p += Vec3{0.06, 0.05, 0};
    if (first_defect(pressed)) p = was;
  }
  expect_same_on_sides(pressed, 0.02);
}

TEST(Shuffle, OfTheElementsThatComeInChangesNothing) {
  const TetMesh start = perturbed(kuhn_cube(10), 0.6, 9);
  TetMesh turned = start;
  Random random(1);
  for (std::size_t k = turned.tets.size(); k > 1; --k) std::swap(turned.tets[k - 1], turned.tets[random.below(k)]);
  ASSERT_NE(turned.tets, start.tets);
  const TetMesh a = improve_shuffled(start, nullptr, at(Level::kDefault), std::nullopt).mesh;
  const TetMesh b = improve_shuffled(turned, nullptr, at(Level::kDefault), std::nullopt).mesh;
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace octafront::improve
