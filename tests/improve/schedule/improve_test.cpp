#include <octafront/error.h>
#include <octafront/quality.h>
#include <octafront/validity.h>

#include "base/core/thread_limit.h"
#include "improve/schedule/schedule.h"
#include "improve/shape/shape.h"
#include "improve/start_meshes.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using namespace testing;
using Level = ImproveOptions::Level;

TetMesh improved(TetMesh mesh, Level level, int threads = 0) {
  ImproveOptions options;
  options.level = level;
  StageReport report;
  const ThreadLimit limit(threads);
  improve_mesh(mesh, nullptr, options, {{}, report});
  return mesh;
}

TEST(Improve, NoneChangesNothing) {
  const TetMesh mesh = perturbed(kuhn_cube(4), 0.4, 1);
  EXPECT_EQ(improved(mesh, Level::kOff), mesh);
}

TEST(Improve, EveryLevelMakesBetterElementsOnTheSameBoundary) {
  const TetMesh start = perturbed(kuhn_cube(6), 0.6, 2);
  const QualitySummary before = summarize_quality(start);
  for (const Level level : {Level::kPaper, Level::kFast, Level::kDefault, Level::kBest}) {
    const TetMesh mesh = improved(start, level);
    const QualitySummary after = summarize_quality(mesh);
    EXPECT_GE(after.beta_min, before.beta_min);
    EXPECT_GT(after.beta_mean, before.beta_mean);
    EXPECT_EQ(mesh.boundary.size(), start.boundary.size());
    if (level != Level::kPaper) {
      EXPECT_GE(after.dihedral_min, before.dihedral_min);
      EXPECT_LE(after.dihedral_max, before.dihedral_max);
    }
  }
}

TetMesh relieved(TetMesh mesh) {
  StageReport report;
  relieve_mesh(mesh, {}, {{}, report});
  return mesh;
}

TEST(Relief, MendsWhatMovesOfTheBoundaryPressedFlatAndLeavesThese) {
  TetMesh start = kuhn_cube(6);
  const auto pressed = std::find(start.points.begin(), start.points.end(), Vec3{0.5, 0.5, 0});
  ASSERT_NE(pressed, start.points.end());
  pressed->z += 0.9 / 6;
  ASSERT_EQ(first_defect(start), std::nullopt);
  const TetMesh mesh = relieved(start);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_LT(summarize_quality(start).beta_min, 0.2);
  EXPECT_GT(summarize_quality(mesh).beta_min, 0.4);
  ASSERT_EQ(mesh.boundary, start.boundary);
  for (const Triangle& t : mesh.boundary)
    for (const VertexIndex v : t) EXPECT_EQ(mesh.points[v], start.points[v]);
}

TEST(Relief, LeavesWhatIsGoodAlone) {
  const TetMesh mesh = kuhn_cube(4);
  EXPECT_EQ(relieved(mesh), mesh);
}

double worst_score(const TetMesh& mesh, ImproveOptions::Objective objective) {
  double worst = 1;
  for (const Tet& t : mesh.tets) {
    const auto shape =
        improve::shape_of(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]], objective);
    worst = std::min(worst, double{shape.score});
  }
  return worst;
}

TEST(Improve, RaisesTheWorstByEveryObjective) {
  using Objective = ImproveOptions::Objective;
  const TetMesh start = perturbed(kuhn_cube(8), 0.7, 6);
  const QualitySummary before = summarize_quality(start);
  for (const Objective objective : {Objective::kBalanced, Objective::kBeta, Objective::kMinDihedral,
                                    Objective::kMaxDihedral, Objective::kMeanRatio, Objective::kSolver}) {
    ImproveOptions options;
    options.objective = objective;
    StageReport report;
    TetMesh mesh = start;
    improve_mesh(mesh, nullptr, options, {{}, report});
    EXPECT_GT(worst_score(mesh, objective), worst_score(start, objective) + 0.1) << static_cast<int>(objective);
    const QualitySummary after = summarize_quality(mesh);
    EXPECT_GT(after.beta_min, before.beta_min) << static_cast<int>(objective);
    EXPECT_GE(after.dihedral_min, before.dihedral_min) << static_cast<int>(objective);
    EXPECT_LE(after.dihedral_max, before.dihedral_max) << static_cast<int>(objective);
  }
}

TEST(Improve, IsDeterministic) {
  const TetMesh start = perturbed(kuhn_cube(5), 0.6, 3);
  EXPECT_EQ(improved(start, Level::kDefault), improved(start, Level::kDefault));
}

TEST(Improve, GivesTheSameOnAnyNumberOfThreads) {
  const TetMesh start = perturbed(kuhn_cube(26), 0.5, 7);  // several pieces
  const TetMesh once = improved(start, Level::kDefault, 1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(improved(start, Level::kDefault, threads), once);
}

TEST(Improve, EndsAfterThePassInWhichItsTimeIsOver) {
  TetMesh mesh = perturbed(kuhn_cube(5), 0.6, 3);
  ImproveOptions options;
  options.seconds = 0;
  int passes = -1;  // the look at the start
  options.after_pass = [&](const std::string&, const ImproveOptions::Worst& worst) {
    EXPECT_TRUE(worst.positive);
    ++passes;
  };
  StageReport report;
  improve_mesh(mesh, nullptr, options, {{}, report});
  EXPECT_EQ(passes, 1);
  EXPECT_FALSE(report.notes.empty());
  options.seconds = -1;
  EXPECT_THROW(improve_mesh(mesh, nullptr, options, {{}, report}), OptionError);
}

TEST(Improve, DoesNotDependOnUnits) {
  const TetMesh start = perturbed(kuhn_cube(5), 0.6, 4);
  const TetMesh once = improved(start, Level::kDefault);
  for (const double scale : {0x1p-30, 0x1p+40}) {
    const TetMesh other = improved(transformed(start, scale, {}), Level::kDefault);
    EXPECT_EQ(other.tets, once.tets);
    EXPECT_EQ(other, transformed(once, scale, {}));
  }
}

TEST(Improve, KeepsRegionsApart) {
  TetMesh two = perturbed(kuhn_cube(4), 0.6, 5);
  TetMesh other = transformed(perturbed(kuhn_cube(4), 0.6, 6), 1, {5, 0, 0});
  const auto shift = static_cast<VertexIndex>(two.points.size());
  two.region.assign(two.tets.size(), 3);
  two.region.resize(two.tets.size() + other.tets.size(), 7);
  two.points.insert(two.points.end(), other.points.begin(), other.points.end());
  for (Tet t : other.tets) two.tets.push_back({t[0] + shift, t[1] + shift, t[2] + shift, t[3] + shift});
  for (Triangle t : other.boundary) two.boundary.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  two.patch.clear(), two.source.clear();
  const TetMesh mesh = improved(two, Level::kDefault);
  ASSERT_EQ(mesh.region.size(), mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    EXPECT_EQ(mesh.region[t], mesh.points[mesh.tets[t][0]].x < 3 ? 3u : 7u);
}

TEST(Improve, RefusesOptionsOutOfRange) {
  ImproveOptions options;
  options.relaxation = 1.5;
  TetMesh mesh = kuhn_cube(2);
  StageReport report;
  EXPECT_THROW(improve_mesh(mesh, nullptr, options, {{}, report}), OptionError);
}

}  // namespace
}  // namespace octafront
