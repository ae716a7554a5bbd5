#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Sizes from 0.0003 at a corner to 0.3 at the other end of a cube.
Options from_fine_to_coarse(VolumeOptions::Core core) {
  Options options;
  options.size.size = 0.3;
  options.size.gradation = 0.25;
  options.size.interior = SizeOptions::Interior::kGraded;
  options.size.regions = {{.lo = {0, 0, 0}, .hi = {0, 0, 0}, .radius = 0.0006, .size = 0.0003}};
  options.volume.core = core;
  options.improve.level = ImproveOptions::Level::kOff;
  return options;
}

TEST(SizeRange, AThousandToOneAcrossAModel) {
  for (const auto core : {VolumeOptions::Core::kOff, VolumeOptions::Core::kLattice}) {
    const Result result = generate(testing::cube(), from_fine_to_coarse(core));
    const TetMesh& mesh = result.mesh;
    EXPECT_EQ(first_defect(mesh), std::nullopt);
    double shortest = 1, longest = 0;
    for (const Tet& t : mesh.tets)
      for (const auto& [i, j] : kTetEdges) {
        const double edge = distance(mesh.points[t[i]], mesh.points[t[j]]);
        shortest = std::min(shortest, edge);
        longest = std::max(longest, edge);
      }
    EXPECT_GT(longest / shortest, 600);
    EXPECT_GT(result.report.quality.beta_mean, 0.72);
    EXPECT_GT(result.report.volume_edges.share_within, 0.8);
  }
}

}  // namespace
}  // namespace octafront
