#include "base/mesh/surface_topology.h"
#include "soup/mend/mend_steps.h"
#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront::mend {
namespace {

/// Every triangle with corners of its own, each moved by up to `gap` / 2.
SurfaceMesh torn(const SurfaceMesh& whole, double gap) {
  SurfaceMesh soup;
  std::uint64_t state = 5;
  const auto random = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 40) / (1u << 24) - 0.5;
  };
  for (const Triangle& t : whole.triangles) {
    Triangle own;
    for (int i = 0; i < 3; ++i) {
      own[i] = static_cast<VertexIndex>(soup.points.size());
      soup.points.push_back(whole.points[t[i]] + gap / 2 * Vec3{random(), random(), random()});
    }
    soup.triangles.push_back(own);
  }
  return soup;
}

bool is_closed_after(const SurfaceMesh& soup, double tolerance, double& move) {
  const RunContext context;
  tidy::Draft draft = tidy::make_draft(soup, context);
  tidy::merge_vertices(draft);
  move = weld_open_edges(draft, tolerance).largest_move;
  return is_closed_manifold(draft.mesh.triangles, draft.mesh.points.size());
}

TEST(WeldOpenEdges, ClosesATornSurface) {
  for (const SurfaceMesh& whole : {testing::cube(3), testing::icosphere(3), testing::torus(24, 12)}) {
    double move = 0;
    EXPECT_TRUE(is_closed_after(torn(whole, 0.004), 0.004, move));
    EXPECT_GT(move, 0);
    EXPECT_LE(move, 0.004);
    EXPECT_FALSE(is_closed_after(torn(whole, 0.004), 0, move));
    EXPECT_EQ(move, 0);
  }
}

TEST(WeldOpenEdges, DividesEdgesAtVerticesBesideThem) {
  // One side of a cube is finer than the others.
  SurfaceMesh soup;
  const SurfaceMesh coarse = testing::cube(1), fine = testing::cube(4);
  const auto is_top = [](const SurfaceMesh& s, const Triangle& t) {
    return s.points[t[0]].z == 1 && s.points[t[1]].z == 1 && s.points[t[2]].z == 1;
  };
  for (const SurfaceMesh* part : {&coarse, &fine}) {
    const auto first = static_cast<VertexIndex>(soup.points.size());
    soup.points.insert(soup.points.end(), part->points.begin(), part->points.end());
    for (const auto& t : part->triangles)
      if (is_top(*part, t) == (part == &fine)) soup.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  double move = 0;
  EXPECT_TRUE(is_closed_after(soup, 1e-6, move));
}

TEST(WeldOpenEdges, LeavesFineRimsAlone) {
  // Edges of the rim are much shorter than the tolerance: nothing there is a gap.
  SurfaceMesh sphere = testing::icosphere(4);
  std::erase_if(sphere.triangles, [&](const Triangle& t) { return sphere.points[t[0]].z > 0.5; });
  const RunContext context;
  tidy::Draft draft = tidy::make_draft(sphere, context);
  tidy::merge_vertices(draft);
  const std::vector<Triangle> before = draft.mesh.triangles;
  const Welded welded = weld_open_edges(draft, 0.2);
  EXPECT_EQ(welded.joined, 0u);
  EXPECT_EQ(draft.mesh.triangles.size(), before.size());
}

}  // namespace
}  // namespace octafront::mend
