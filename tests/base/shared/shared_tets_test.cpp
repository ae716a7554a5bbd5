#include "base/shared/shared_tets.h"

#include <octafront/validity.h>

#include "base/mesh/tet_meshes.h"
#include "base/shared/shared_defects.h"
#include "base/shared/virtual_ranks.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

TEST(SharedTets, AreKeptAndGatheredInOrder) {
  TetMesh mesh = testing::tet_cube(3);
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) mesh.region.push_back(t % 7);
  for (const int ranks : {1, 2, 3, 8})
    run_virtual_ranks(ranks, [&](Ranks& here) {
      const Comm comm(&here);
      TetMesh share = mesh;
      keep_share(share, comm);
      const TetCounts counts = count_tets(share, comm);
      EXPECT_EQ(counts.all, mesh.tets.size());
      ASSERT_LE(counts.before + share.tets.size(), counts.all);
      const auto begin = mesh.tets.begin() + static_cast<std::ptrdiff_t>(counts.before);
      EXPECT_TRUE(std::equal(share.tets.begin(), share.tets.end(), begin));
      EXPECT_LE(share.tets.size(), mesh.tets.size() / static_cast<std::size_t>(ranks) + 1);
      TetMesh at_first = share;
      gather_tets_at_first(at_first, comm);
      if (here.rank() == 0) {
        EXPECT_EQ(at_first, mesh);
      } else {
        EXPECT_TRUE(at_first.tets.empty() && at_first.region.empty());
      }
      gather_tets(share, comm);
      EXPECT_EQ(share, mesh);
    });
}

TEST(SharedTets, DropUnusedPointsOfAll) {
  TetMesh mesh = testing::tet_cube(2);
  const std::size_t used = mesh.points.size();
  mesh.points.push_back({9, 9, 9});
  run_virtual_ranks(3, [&](Ranks& here) {
    const Comm comm(&here);
    TetMesh share = mesh;
    keep_share(share, comm);
    drop_unused_points(share, 0, comm);
    EXPECT_EQ(share.points.size(), used);
  });
}

TEST(SharedTets, JoinSetsOfAll) {
  run_virtual_ranks(4, [&](Ranks& here) {
    const Comm comm(&here);
    DisjointSets sets(10);
    const auto rank = static_cast<std::uint32_t>(here.rank());
    sets.join(2 * rank, 2 * rank + 2);
    join_sets(sets, 10, comm);
    for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(sets.find(i), i % 2 == 0 ? 0 : i);
  });
}

/// What first_defect_of_shares() says on all ranks of a mesh after change(share, rank).
std::string defect_of(const TetMesh& mesh, const SurfaceMesh& surface, int ranks,
                      const std::function<void(TetMesh&, int)>& change) {
  std::vector<std::string> found(static_cast<std::size_t>(ranks));
  run_virtual_ranks(ranks, [&](Ranks& here) {
    const Comm comm(&here);
    TetMesh share = mesh;
    keep_share(share, comm);
    change(share, here.rank());
    found[static_cast<std::size_t>(here.rank())] = first_defect_of_shares(share, surface, {}, comm).value_or("none");
  });
  for (const std::string& of_rank : found) EXPECT_EQ(of_rank, found[0]);
  return found[0];
}

class SharedDefects : public ::testing::TestWithParam<int> {
 protected:
  std::string defect(const std::function<void(TetMesh&, int)>& change) const {
    return defect_of(mesh_, surface_, GetParam(), change);
  }
  int last() const { return GetParam() - 1; }

  const TetMesh mesh_ = testing::tet_cube(4);
  const SurfaceMesh surface_{mesh_.points, mesh_.boundary, {}, {}, {}};
};

TEST_P(SharedDefects, AreNoneInAValidMesh) {
  EXPECT_EQ(defect([](TetMesh&, int) {}), "none");
}

TEST_P(SharedDefects, AreThoseOfOneShare) {
  const std::size_t end = mesh_.tets.size() - 1;
  EXPECT_THAT(defect([&](TetMesh& share, int rank) {
                if (rank == last()) std::swap(share.tets.back()[0], share.tets.back()[1]);
              }),
              HasSubstr("tetrahedron " + std::to_string(end) + " is inverted"));
  EXPECT_THAT(defect([&](TetMesh& share, int rank) {
                if (rank == last()) share.tets.pop_back();
              }),
              HasSubstr("face "));
  EXPECT_THAT(defect([&](TetMesh& share, int rank) {
                if (rank == last()) share.tets.back()[2] = 1000;
              }),
              HasSubstr("refers to vertex 1000"));
}

TEST_P(SharedDefects, AreThoseBetweenShares) {
  // Each tetrahedron once more, on the last rank: at rims and inside, whole or beside its neighbours.
  for (const std::size_t t : {std::size_t{0}, mesh_.tets.size() / 2, mesh_.tets.size() - 1})
    EXPECT_THAT(defect([&](TetMesh& share, int rank) {
                  if (rank == last()) share.tets.push_back(mesh_.tets[t]);
                }),
                HasSubstr("face "));
  // One that is missing anywhere.
  for (std::size_t k = 0; k < 384 / static_cast<std::size_t>(GetParam()); k += 11)
    EXPECT_THAT(defect([&](TetMesh& share, int rank) {
                  if (rank == 0) share.tets.erase(share.tets.begin() + static_cast<std::ptrdiff_t>(k));
                }),
                AnyOf(HasSubstr("face "), HasSubstr("belongs to no tetrahedron")));
}

TEST_P(SharedDefects, AreThoseOfTheBoundary) {
  for (std::size_t f = 0; f < mesh_.boundary.size(); f += 13) {
    EXPECT_THAT(defect([&](TetMesh& share, int) {
                  share.boundary.erase(share.boundary.begin() + static_cast<std::ptrdiff_t>(f));
                }),
                HasSubstr("is open but not listed as boundary"));
    EXPECT_THAT(defect([&](TetMesh& share, int) { std::swap(share.boundary[f][0], share.boundary[f][1]); }),
                HasSubstr("faces inward"));
    EXPECT_NE(defect([&](TetMesh& share, int) { share.boundary.push_back(share.boundary[f]); }), "none");
  }
  EXPECT_THAT(defect([&](TetMesh& share, int) {
                share.boundary.push_back({0, 1, 124});
              }),
              HasSubstr("belongs to no tetrahedron"));
}

INSTANTIATE_TEST_SUITE_P(Ranks, SharedDefects, ::testing::Values(2, 3, 7));

}  // namespace
}  // namespace octafront
