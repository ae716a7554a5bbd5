#include "fill/lattice/cut_lattice.h"

#include <octafront/quality.h>
#include <octafront/validity.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

// The body where a function is positive; crossings by linear interpolation, as in the publication.
class Positive final : public ImplicitDomain {
 public:
  explicit Positive(std::function<double(Vec3)> f) : f_(std::move(f)) {}
  int side(Vec3 p) const override {
    const double v = f_(p);
    return (v > 0) - (v < 0);
  }
  double crossing(Vec3 in, Vec3 out) const override {
    const double a = f_(in), b = f_(out);
    return a / (a - b);
  }
  bool is_clear(Vec3, double) const override { return false; }

 private:
  std::function<double(Vec3)> f_;
};

Octree uniform_tree(int level) {
  std::vector<OctreeKey> leaves;
  const std::uint32_t n = 1u << level, side = OctreeKey::kSide >> level;
  for (std::uint32_t z = 0; z < n; ++z)
    for (std::uint32_t y = 0; y < n; ++y)
      for (std::uint32_t x = 0; x < n; ++x)
        leaves.push_back(OctreeKey::containing(x * side, y * side, z * side, level));
  std::sort(leaves.begin(), leaves.end());
  return Octree(std::move(leaves));
}

TetMesh cut(int level, const ImplicitDomain& domain) {
  StageReport report;
  return cut_lattice({{-1, -1, -1}, 2}, uniform_tree(level), domain, {{}, report});
}

double inside_box(Vec3 p) {
  return 0.7 - std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// Any signs and any cut points at all, away from the wall.
Positive noise(unsigned seed, double level) {
  return Positive([=](Vec3 p) {
    if (inside_box(p) <= 0) return -1e-3 - 1e-3 * std::abs(std::sin(1e5 * (p.x + 2 * p.y + 3 * p.z)));
    std::uint64_t h = seed;
    for (int k = 0; k < 3; ++k)
      h = (h ^ static_cast<std::uint64_t>(std::llround((p[k] + 1) * 4096))) * 0x9e3779b97f4a7c15ull ^ h >> 29;
    std::mt19937_64 random(h);
    random.discard(4);
    const double u = std::uniform_real_distribution<double>(-1, 1)(random);
    return std::copysign(std::pow(10.0, 3 * u * u), u + level);
  });
}

void expect_bounds(const TetMesh& mesh, double least, double greatest) {
  ASSERT_GT(mesh.tets.size(), 500u);
  const auto defect = first_defect(mesh);
  EXPECT_FALSE(defect) << *defect;
  const QualitySummary q = summarize_quality(mesh);
  EXPECT_GE(q.dihedral_min, least);
  EXPECT_LE(q.dihedral_max, greatest);
}

TEST(CutLattice, KeepsThePublishedAnglesWhateverTheFunction) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    expect_bounds(cut(5, noise(seed, 0.1 * (seed % 7))), 10.78, 164.75);
  }
}

}  // namespace
}  // namespace octafront
