#include <octafront/solver_checks.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TetMesh one_tet(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  TetMesh mesh;
  mesh.points = {a, b, c, d};
  mesh.tets = {{0, 1, 2, 3}};
  for (int i = 0; i < 4; ++i) {
    const auto& f = kTetFaces[static_cast<std::size_t>(i)];
    mesh.boundary.push_back(
        {static_cast<VertexIndex>(f[0]), static_cast<VertexIndex>(f[1]), static_cast<VertexIndex>(f[2])});
  }
  return mesh;
}

TetMesh regular() {
  return one_tet({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}, {0.5, std::sqrt(1 / 12.0), std::sqrt(2 / 3.0)});
}

TetMesh second_order(TetMesh mesh) {
  mesh.mid_nodes.push_back({4, 5, 6, 7, 8, 9});
  for (const auto& [a, b] : kTetEdges)
    mesh.points.push_back(0.5 * (mesh.points[static_cast<std::size_t>(a)] + mesh.points[static_cast<std::size_t>(b)]));
  return mesh;
}

constexpr Solver kAll[] = {Solver::kAbaqus, Solver::kAnsys, Solver::kNastran, Solver::kCalculix};

const SolverFinding& finding(const std::vector<SolverFinding>& all, const std::string& measure, bool refused) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const SolverFinding& f) {
    return f.measure.starts_with(measure) && f.refused == refused;
  });
  if (at == all.end()) throw std::logic_error("no such measure: " + measure);
  return *at;
}

TEST(SolverChecks, ARegularElementPassesAll) {
  for (const TetMesh& mesh : {regular(), second_order(regular())})
    for (const Solver solver : kAll) {
      const auto all = check_for_solver(mesh, solver);
      EXPECT_FALSE(all.empty());
      for (const SolverFinding& f : all) EXPECT_EQ(f.count, 0u) << f.measure;
    }
}

TEST(SolverChecks, LimitsOfMidSideNodesNeedMidSideNodes) {
  EXPECT_GT(check_for_solver(second_order(regular()), Solver::kNastran).size(),
            check_for_solver(regular(), Solver::kNastran).size());
}

TEST(SolverChecks, ALongElementIsWarnedOfByAspectRatio) {
  const TetMesh longish = one_tet({0, 0, 0}, {11, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const auto abaqus = check_for_solver(longish, Solver::kAbaqus);
  const auto& f = finding(abaqus, "aspect ratio", false);
  ASSERT_EQ(f.count, 1u);
  EXPECT_NEAR(f.worst[0].value, std::sqrt(122), 1e-12);
  EXPECT_EQ(finding(check_for_solver(longish, Solver::kNastran), "aspect ratio", false).count, 0u);
}

TEST(SolverChecks, AnsysStretchesRectanglesAroundTriangles) {
  // The triangle (0,0) (40,0) (20,1) is in a rectangle of 20 x 1 and one of 40 x .5 and more stretched ones.
  const TetMesh flat = one_tet({0, 0, 0}, {40, 0, 0}, {20, 1, 0}, {20, 0.5, 30});
  const auto ansys = check_for_solver(flat, Solver::kAnsys);
  EXPECT_EQ(finding(ansys, "aspect ratio", false).count, 1u);
  EXPECT_EQ(finding(ansys, "aspect ratio", true).count, 0u);
  EXPECT_EQ(finding(ansys, "largest corner angle", false).count, 1u);
  EXPECT_NEAR(finding(ansys, "largest corner angle", false).worst[0].value, 174.275, 1e-3);
}

TEST(SolverChecks, AMidSideNodeOutsideTheMiddleThirdIsWarnedOf) {
  TetMesh mesh = second_order(regular());
  mesh.points[4] = {0.36, 0, 0};
  EXPECT_EQ(finding(check_for_solver(mesh, Solver::kNastran), "edge point", false).count, 0u);
  mesh.points[4] = {0.32, 0, 0};
  const auto all = check_for_solver(mesh, Solver::kNastran);
  EXPECT_NEAR(finding(all, "edge point", false).worst.at(0).value, 0.32 / 0.68, 1e-12);
  EXPECT_EQ(finding(all, "Jacobian at the integration", true).count, 0u);
}

TEST(SolverChecks, AnInvertedCornerIsNotSeenAtIntegrationPoints) {
  TetMesh mesh = second_order(regular());
  mesh.points[4] = {0.24, 0, 0};
  const auto nastran = check_for_solver(mesh, Solver::kNastran);
  EXPECT_EQ(finding(nastran, "Jacobian at the corners", false).count, 1u);
  EXPECT_EQ(finding(nastran, "Jacobian at the integration", true).count, 0u);
  EXPECT_EQ(finding(check_for_solver(mesh, Solver::kAnsys), "Jacobian ratio", true).count, 1u);
  mesh.points[4] = {-0.4, 0, 0};
  EXPECT_EQ(finding(check_for_solver(mesh, Solver::kCalculix), "Jacobian", true).count, 1u);
}

TEST(SolverChecks, CalculixRefusesElementsOfTheSizeOfItsLimit) {
  TetMesh mesh = regular();
  for (Vec3& p : mesh.points) p *= 1e-7;
  EXPECT_EQ(finding(check_for_solver(mesh, Solver::kCalculix), "Jacobian", true).count, 1u);
}

}  // namespace
}  // namespace octafront
