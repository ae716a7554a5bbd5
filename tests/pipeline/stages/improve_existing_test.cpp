#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/validity.h>

#include "base/geometry/hausdorff.h"
#include "support/mixed_mesh.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TetMesh unimproved(const SurfaceMesh& surface, double size) {
  Options options;
  options.size.size = size;
  options.improve.level = ImproveOptions::Level::kOff;
  return generate(surface, options).mesh;
}

TEST(ImproveExisting, KeepsTheBoundaryUnlessThereIsASurface) {
  const TetMesh start = unimproved(testing::torus(40, 20), 0.2);
  const Improved better = improve_existing(start);
  EXPECT_GT(better.report.quality.beta_mean, better.before.beta_mean);
  EXPECT_GE(better.report.quality.beta_min, better.before.beta_min);
  EXPECT_EQ(first_defect(better.mesh, {start.points, start.boundary, {}, {}, {}}), std::nullopt);
}

TEST(ImproveExisting, SlidesOnASurfaceAndStaysTrueToIt) {
  const SurfaceMesh surface = testing::icosphere(4);
  const TetMesh start = unimproved(surface, 0.25);
  const Improved fixed = improve_existing(start), slid = improve_existing(start, {}, &surface);
  EXPECT_GT(slid.report.quality.beta_mean, fixed.report.quality.beta_mean);
  EXPECT_EQ(first_defect(slid.mesh), std::nullopt);
  EXPECT_NE(first_defect(slid.mesh, {start.points, start.boundary, {}, {}, {}}), std::nullopt);
  const SurfaceMesh before{start.points, start.boundary, {}, {}, {}},
      after{slid.mesh.points, slid.mesh.boundary, {}, {}, {}};
  const double tolerance = 1e-3;
  EXPECT_LE(hausdorff_distance(after, surface, tolerance).lower,
            1.1 * hausdorff_distance(before, surface, tolerance).upper);
  // Sources are the nearest input faces still.
  for (std::size_t t = 0; t < slid.mesh.boundary.size(); ++t) {
    const auto& [a, b, c] = slid.mesh.boundary[t];
    const Vec3 middle = (slid.mesh.points[a] + slid.mesh.points[b] + slid.mesh.points[c]) / 3;
    const auto& [x, y, z] = surface.triangles[slid.mesh.source[t]];
    EXPECT_LT(distance(middle, (surface.points[x] + surface.points[y] + surface.points[z]) / 3), 0.15);
  }
}

TEST(ImproveExisting, GainsNextToNothingOnTheResultOfBest) {
  const SurfaceMesh surface = testing::icosphere(4);
  Options options;
  options.size.size = 0.25;
  options.improve.level = ImproveOptions::Level::kBest;
  const TetMesh best = generate(surface, options).mesh;
  for (const SurfaceMesh* ground : {&surface, static_cast<const SurfaceMesh*>(nullptr)}) {
    const Improved again = improve_existing(best, options, ground);
    EXPECT_LT(again.report.quality.beta_min, again.before.beta_min + 0.01);
  }
}

TEST(ImproveExisting, RefusesWhatIsNotValid) {
  TetMesh mesh = unimproved(testing::cube(1), 0.5);
  const SurfaceMesh other = testing::icosphere(2);
  EXPECT_THROW(improve_existing(mesh, {}, &other), InputError);
  std::swap(mesh.tets[3][0], mesh.tets[3][1]);
  try {
    improve_existing(mesh);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("tetrahedron 3 is inverted"), std::string::npos) << e.what();
  }
}

/// The corners of each wedge or pyramid by their places, in its order.
std::vector<std::vector<std::array<double, 3>>> placed_wide_cells(const TetMesh& mesh) {
  std::vector<std::vector<std::array<double, 3>>> all;
  for (const WideCell& cell : mesh.wide_cells) {
    auto& corners = all.emplace_back();
    for (TetIndex t = cell.first; t < cell.first + cell.tet_count; ++t)
      for (const VertexIndex v : mesh.tets[t])
        corners.push_back({mesh.points[v].x, mesh.points[v].y, mesh.points[v].z});
    for (std::size_t k = 0; k < cell.tet_count + 3; ++k) {
      const Vec3 p = mesh.points[cell.nodes[k]];
      corners.push_back({p.x, p.y, p.z});
    }
  }
  return all;
}

/// 0 of sets of anything but elements.
double volume_of_set(const TetMesh& mesh, std::size_t s) {
  double volume = 0;
  if (mesh.sets[s].kind != NamedSet::Kind::kElements) return volume;
  for (const TetIndex t : mesh.sets[s].members) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const Vec3 p = mesh.points[a];
    volume += dot(cross(mesh.points[b] - p, mesh.points[c] - p), mesh.points[d] - p) / 6;
  }
  return volume;
}

TEST(ImproveExisting, LeavesWedgesAndPyramidsAsTheyAre) {
  TetMesh start = testing::mixed_mesh(4);
  // Inside the cubes of tetrahedra.
  for (std::size_t v = 0; v < start.points.size(); ++v) {
    Vec3& p = start.points[v];
    const bool is_inside = p.x > 0 && p.x < 4 && p.y > 0 && p.y < 4 && p.z > 0.5 && p.z < 4.5;
    if (is_inside)
      p = p + Vec3{0.2 * std::sin(7.0 * static_cast<double>(v)), 0.2 * std::cos(3.0 * static_cast<double>(v)), 0.1};
  }
  ASSERT_EQ(first_defect(start), std::nullopt);
  const Improved better = improve_existing(start);
  EXPECT_EQ(first_defect(better.mesh), std::nullopt);
  EXPECT_EQ(first_wide_defect(better.mesh), std::nullopt);
  EXPECT_GT(better.report.quality.beta_mean, better.before.beta_mean);
  EXPECT_EQ(placed_wide_cells(better.mesh), placed_wide_cells(start));
  EXPECT_EQ(better.mesh.wide_faces.size(), start.wide_faces.size());
  EXPECT_EQ(first_defect(better.mesh, {start.points, start.boundary, {}, {}, {}}), std::nullopt);
  EXPECT_EQ(better.mesh.patch, start.patch);
  EXPECT_EQ(better.mesh.region_names, start.region_names);
  EXPECT_EQ(better.mesh.interfaces.size(), start.interfaces.size());
  ASSERT_EQ(better.mesh.sets.size(), start.sets.size());
  for (std::size_t s = 0; s < start.sets.size(); ++s) {
    EXPECT_EQ(better.mesh.sets[s].name, start.sets[s].name);
    EXPECT_FALSE(better.mesh.sets[s].members.empty()) << start.sets[s].name;
    EXPECT_NEAR(volume_of_set(better.mesh, s), volume_of_set(start, s), 1e-9) << start.sets[s].name;
  }
  const Improved again = improve_existing(start);
  EXPECT_EQ(again.mesh, better.mesh);
}

TEST(ImproveExisting, WhatIsRequiredInsideStays) {
  TetMesh start = unimproved(testing::torus(40, 20), 0.2);
  std::vector<char> is_wall(start.points.size(), 0);
  for (const Triangle& t : start.boundary)
    for (const VertexIndex v : t) is_wall[v] = 1;
  NamedSet set{"RequiredVertices", NamedSet::Kind::kNodes, {}};
  for (VertexIndex v = 0; v < is_wall.size(); ++v)
    if (!is_wall[v] && set.members.size() < 3) set.members.push_back(v);
  ASSERT_EQ(set.members.size(), 3U);
  std::vector<Vec3> wanted;
  for (const VertexIndex v : set.members) wanted.push_back(start.points[v]);
  start.sets = {set};
  const Improved better = improve_existing(start);
  EXPECT_EQ(first_defect(better.mesh), std::nullopt);
  EXPECT_GT(better.report.quality.beta_mean, better.before.beta_mean);
  ASSERT_EQ(better.mesh.sets.size(), 1U);
  std::vector<Vec3> kept;
  for (const VertexIndex v : better.mesh.sets[0].members) kept.push_back(better.mesh.points[v]);
  const auto by_place = [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  std::sort(kept.begin(), kept.end(), by_place), std::sort(wanted.begin(), wanted.end(), by_place);
  EXPECT_EQ(kept, wanted);
}

}  // namespace
}  // namespace octafront
