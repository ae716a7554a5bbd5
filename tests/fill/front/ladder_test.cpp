#include "fill/front/ladder.h"

#include <octafront/validity.h>

#include "base/core/random.h"
#include "base/mesh/tet_key.h"
#include "base/shared/shared_tets.h"
#include "base/shared/virtual_ranks.h"
#include "fill/front/filled_sphere.h"

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
struct Sieve : testing::FilledSphere {
  int holes = 0;

  Sieve() : FilledSphere(3, 0.15) {
    std::vector<std::vector<VertexIndex>> around(mesh.points.size());
    for (const Tet& t : mesh.tets)
      for (const VertexIndex v : t) around[v].insert(around[v].end(), t.begin(), t.end());
    std::vector<bool> is_used(mesh.points.size(), false);
    for (auto v = static_cast<VertexIndex>(surface.points.size()); v < mesh.points.size(); ++v) {
      if (std::ranges::any_of(around[v], [&](VertexIndex u) { return is_used[u]; })) continue;
      for (const VertexIndex u : around[v]) is_used[u] = true;
      punch(v);
      ++holes;
    }
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

TEST(Ladder, ClosesTheSameOfShares) {
  const Sieve sieve;
  const auto plain = sieve.closed(sieve.mesh.tets, sieve.walls);
  for (const int ranks : {2, 3})
    run_virtual_ranks(ranks, [&](Ranks& here) {
      const Comm comm(&here);
      StageReport report;
      RunContext context;
      context.ranks = &here;
      const FrontTask task{sieve.sizes, sieve.options, {context, report}, &here};
      TetMesh mesh = sieve.mesh;
      keep_share(mesh, comm);
      FrontTets share{mesh.tets, {{0, count_tets(mesh, comm).before}}};
      close_cavities_of_shares(mesh.points, share, sieve.walls, sieve.surface, task);
      mesh.tets = share.tets;
      drop_unused_points(mesh, sieve.surface.points.size(), comm);
      gather_tets(mesh, comm);
      std::ranges::sort(mesh.tets, {}, tet_key);
      EXPECT_TRUE(mesh.points == plain.first);
      EXPECT_TRUE(mesh.tets == plain.second);
    });
}

}  // namespace
}  // namespace octafront
