#include "fill/front/ladder.h"

#include <octafront/validity.h>

#include "base/core/random.h"
#include "base/mesh/tet_key.h"
#include "fill/front/fill.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

namespace octafront {
namespace {

template <class Item>
void shuffle(std::vector<Item>& items, Random& random) {
  for (std::size_t k = items.size(); k > 1; --k) std::swap(items[k - 1], items[random.below(k)]);
}

/// A filled sphere with holes: the tetrahedra around some inner vertices, no two of which have a common neighbour, are
/// gone.
struct Sieve {
  SurfaceMesh surface = testing::icosphere(3);
  SizeField sizes = SizeField::uniform(0.15);
  VolumeOptions options;
  RunContext context;
  StageReport report;
  Stage stage{context, report};
  FrontTask task{sizes, options, stage};
  TetMesh mesh;
  std::vector<Wall> walls;
  int holes = 0;

  Sieve() {
    options.core = VolumeOptions::Core::kOff;
    mesh = fill_volume(surface, sizes, options, stage);
    std::vector<VertexIndex> hole(mesh.points.size(), kNone);  // whose star a vertex is in
    std::vector<std::vector<TetIndex>> star(mesh.points.size());
    for (TetIndex t = 0; t < mesh.tets.size(); ++t)
      for (const VertexIndex v : mesh.tets[t]) star[v].push_back(t);
    std::vector<bool> gone(mesh.tets.size(), false);
    for (auto v = static_cast<VertexIndex>(surface.points.size()); v < mesh.points.size(); ++v) {
      const bool is_free = std::ranges::all_of(star[v], [&](TetIndex t) {
        return std::ranges::all_of(mesh.tets[t], [&](VertexIndex u) { return hole[u] == kNone; });
      });
      if (!is_free) continue;
      ++holes;
      for (const TetIndex t : star[v]) {
        gone[t] = true;
        const Tet& c = mesh.tets[t];
        for (const VertexIndex u : c) hole[u] = v;
        const auto& f = kTetFaces[static_cast<std::size_t>(std::ranges::find(c, v) - c.begin())];
        walls.push_back({c[f[0]], c[f[2]], c[f[1]]});
      }
    }
    std::vector<Tet> kept;
    for (TetIndex t = 0; t < mesh.tets.size(); ++t)
      if (!gone[t]) kept.push_back(mesh.tets[t]);
    mesh.tets = std::move(kept);
  }

  /// Points, and tetrahedra by their names.
  std::pair<std::vector<Vec3>, std::vector<Tet>> closed(std::vector<Tet> tets, std::vector<Wall> open) const {
    TetMesh result = mesh;
    result.tets = std::move(tets);
    close_cavities(result, std::move(open), surface, task);
    EXPECT_EQ(first_defect(result, surface), std::nullopt);
    std::ranges::sort(result.tets, {}, tet_key);
    return {std::move(result.points), std::move(result.tets)};
  }
};

TEST(Ladder, HangsOnNoOrder) {
  const Sieve sieve;
  ASSERT_GT(sieve.holes, 8);
  const auto plain = sieve.closed(sieve.mesh.tets, sieve.walls);
  EXPECT_GT(plain.second.size(), sieve.mesh.tets.size());
  Random random(1);
  for (int k = 0; k < 2; ++k) {
    std::vector<Tet> tets = sieve.mesh.tets;
    std::vector<Wall> walls = sieve.walls;
    shuffle(tets, random);
    shuffle(walls, random);
    EXPECT_TRUE(sieve.closed(std::move(tets), std::move(walls)) == plain);
  }
}

}  // namespace
}  // namespace octafront
