#include <octafront/validity.h>

#include "base/core/thread_limit.h"
#include "fill/front/advance.h"
#include "fill/front/block_run.h"
#include "fill/front/fill.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

namespace octafront {
namespace {

using testing::icosphere;

constexpr double kEdgeOfIcosphere = 1.1;  // of level 0, about; halved by each level

FrontState front_on(const SurfaceMesh& surface, double size) {
  FrontState front;
  front.domain = bounding_box(surface.points);
  front.finest_size = size;
  front.points = surface.points;
  front.sizes.assign(surface.points.size(), static_cast<float>(size));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    // Some of each kind.
    if (t % 7 == 0)
      front.held.push_back({{a, c, b}});
    else if (t % 5 == 0)
      front.passive.push_back({{a, c, b}});
    else
      front.queue.push_back({{{a, c, b}}});
  }
  return front;
}

Box3 box_of(const FrontState& front, std::size_t face) {
  Box3 box;
  for (const VertexIndex v : front.face(face).corners) box.add(front.points[v]);
  return box;
}

TEST(Partition, GivesEveryFaceOneOwnerAndListsAllThatReachIn) {
  const FrontState front = front_on(icosphere(5), kEdgeOfIcosphere / 32);
  for (const double quantile : {0.5, 0.36, 0.64}) {
    const std::vector<FrontBlock> blocks = partition_front(front, {800, quantile});
    ASSERT_GT(blocks.size(), 8u);
    std::vector<int> owners(front.faces(), 0);
    for (const FrontBlock& block : blocks) {
      std::vector<bool> listed(front.faces(), false);
      std::size_t queued = 0;
      for (const FrontBlock::Member m : block.members) {
        listed[m.face] = true;
        owners[m.face] += m.owned;
        queued += m.owned && m.face < front.queue.size();
      }
      EXPECT_EQ(queued, block.queued);
      EXPECT_LE(block.queued, 800u);
      for (std::size_t f = 0; f < front.faces(); ++f)
        EXPECT_EQ(listed[f], box_of(front, f).overlaps(block.territory)) << f;
    }
    for (std::size_t f = 0; f < owners.size(); ++f) EXPECT_EQ(owners[f], 1) << f;
    for (std::size_t i = 0; i < blocks.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Box3 &p = blocks[i].territory, &q = blocks[j].territory;
        bool apart = false;
        for (int axis = 0; axis < 3; ++axis) apart = apart || p.hi[axis] <= q.lo[axis] || q.hi[axis] <= p.lo[axis];
        EXPECT_TRUE(apart) << i << " and " << j;
      }
  }
}

TEST(Partition, KeepsRegionsApart) {
  FrontState front = front_on(icosphere(4), kEdgeOfIcosphere / 16);
  // The first region has half of the faces, the others an eighth each.
  const auto region_of = [&](const Triangle& t) {
    const Vec3 p = front.points[t[0]];
    return p.x < 0 ? 0u : 1u + (p.y > 0 ? 1u : 0u) + (p.z > 0 ? 2u : 0u);
  };
  front.regions = 5;
  for (WaitingFace& w : front.queue) w.face.region = region_of(w.face.corners);
  for (FrontFace& f : front.held) f.region = region_of(f.corners);
  for (FrontFace& f : front.passive) f.region = region_of(f.corners);
  const std::vector<FrontBlock> blocks = partition_front(front, {1000, 0.5});
  std::vector<int> owners(front.faces(), 0);
  std::set<std::uint32_t> alone;
  for (const FrontBlock& block : blocks) {
    EXPECT_LE(block.queued, 1000u);
    std::set<std::uint32_t> regions;
    for (std::size_t i = 0; i < block.members.size(); ++i) {
      owners[block.members[i].face] += block.members[i].owned;
      regions.insert(front.face(block.members[i].face).region);
      if (i > 0) {
        EXPECT_LT(block.members[i - 1].face, block.members[i].face);
      }
    }
    if (block.is_of_regions)
      alone.insert(regions.begin(), regions.end());
    else
      EXPECT_EQ(regions, (std::set<std::uint32_t>{0}));
  }
  EXPECT_EQ(alone, (std::set<std::uint32_t>{1, 2, 3, 4}));
  for (std::size_t f = 0; f < owners.size(); ++f) EXPECT_EQ(owners[f], 1) << f;
  front.passive[0].region = kNone;
  for (const FrontBlock& block : partition_front(front, {1000, 0.5})) EXPECT_FALSE(block.is_of_regions);
}

TEST(FrontState, FindsWhatIsWrongWithIt) {
  const FrontState whole = front_on(icosphere(2), kEdgeOfIcosphere / 4);
  EXPECT_EQ(whole.first_inconsistency(), std::nullopt);
  FrontState open = whole, turned = whole, more = whole, sizeless = whole;
  open.held.pop_back();
  std::swap(turned.passive[3].corners[0], turned.passive[3].corners[1]);
  more.filled.push_back({{{0, 1, 2, 3}}});
  sizeless.sizes.pop_back();
  for (const FrontState& broken : {open, turned, more, sizeless}) EXPECT_NE(broken.first_inconsistency(), std::nullopt);
}

TEST(Partition, DividesWhereManyFacesWaitForFew) {
  FrontState front = front_on(icosphere(5), kEdgeOfIcosphere / 32);
  for (std::size_t i = 4; i < front.queue.size(); ++i) front.passive.push_back(front.queue[i].face);
  front.queue.resize(4);
  const std::vector<FrontBlock> blocks = partition_front(front, {500, 0.5, 1000});
  ASSERT_GT(blocks.size(), 4u);
  std::size_t queued = 0, owned = 0;
  for (const FrontBlock& block : blocks) {
    queued += block.queued;
    EXPECT_TRUE(block.queued == 0 || block.members.size() <= 1000) << block.members.size();
    owned += static_cast<std::size_t>(
        std::count_if(block.members.begin(), block.members.end(), [](FrontBlock::Member m) { return m.owned != 0; }));
  }
  EXPECT_EQ(queued, 4u);
  EXPECT_EQ(owned, front.faces());
}

TEST(BlockRun, LeavesFacesAsTheyAreWhereNoneWaits) {
  FrontState front = front_on(icosphere(3), kEdgeOfIcosphere / 8);
  for (const WaitingFace& w : front.queue) front.passive.push_back(w.face);
  front.queue.clear();
  const SizeField sizes = SizeField::uniform(1);
  const VolumeOptions options;
  const RunContext context;
  StageReport report;
  const Stage stage{context, report};
  const FrontTask task{sizes, options, stage};
  const BlockResult result = advance_block({front, task, {.tets = 100}, 3}, FrontBlock::whole(front));
  EXPECT_TRUE(result.found.empty() && result.tets.empty());
  const auto same = [](const FrontFace& f, const FrontFace& g) { return f.corners == g.corners; };
  EXPECT_TRUE(std::equal(result.held.begin(), result.held.end(), front.held.begin(), front.held.end(), same));
  EXPECT_TRUE(
      std::equal(result.passive.begin(), result.passive.end(), front.passive.begin(), front.passive.end(), same));
}

TEST(Partition, DoesNotMakeBlocksThatAreTooNarrow) {
  const FrontState front = front_on(icosphere(2), kEdgeOfIcosphere / 4);
  EXPECT_EQ(partition_front(front, {1, 0.5}).size(), 1u);
}

TEST(BlockRun, StaysStrictlyInsideItsTerritory) {
  const double size = kEdgeOfIcosphere / 32;
  const FrontState front = front_on(icosphere(5), size);
  const SizeField sizes = SizeField::uniform(size);
  const VolumeOptions options;
  const RunContext context;
  StageReport report;
  const Stage stage{context, report};
  const FrontTask task{sizes, options, stage};
  const FrontPhase phase{front, task, {.tets = 100'000}, 3};
  std::size_t tets = 0;
  for (const FrontBlock& block : partition_front(front, {1500, 0.5})) {
    const BlockResult result = advance_block(phase, block);
    tets += result.tets.size();
    EXPECT_GT(result.deferred, 0u);
    for (const Tet& t : result.tets)
      for (const VertexIndex v : t) {
        const Vec3 p = v < result.found.size() ? front.points[result.found[v]] : result.points[v - result.found.size()];
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_LT(block.territory.lo[axis], p[axis]);
          EXPECT_LT(p[axis], block.territory.hi[axis]);
        }
      }
  }
  EXPECT_GT(tets, 5000u);
}

TEST(Advance, StatisticsDecideNothing) {
  const double size = kEdgeOfIcosphere / 16;
  const SizeField sizes = SizeField::uniform(size);
  const VolumeOptions options;
  const RunContext context;
  StageReport report;
  const Stage stage{context, report};
  const FrontTask task{sizes, options, stage};
  const AdvanceBudget budget{.tets = 60'000, .face_tests = 5'000'000};
  FrontState first = front_on(icosphere(4), size), second = first;
  FrontCounters counters;
  const bool ended = advance_front(first, task, budget, counters);
  ASSERT_GT(first.phases, 1u);
  ASSERT_GT(counters.deferred, 0u);
  // What an earlier run has counted is still in them.
  EXPECT_EQ(advance_front(second, task, budget, counters), ended);
  EXPECT_TRUE(first.filled == second.filled && first.points == second.points);
  EXPECT_EQ(first.work.face_tests, second.work.face_tests);
}

TetMesh filled_by(int threads, const SurfaceMesh& surface, double size, VolumeOptions::Core core) {
  // More threads than the machine has want an arena that lets them in.
  const ThreadLimit limit(threads);
  VolumeOptions options;
  options.core = core;
  StageReport report;
  return tbb::task_arena(threads).execute([&] {
    return fill_volume(surface, SizeField::uniform(size), options, {RunContext{}, report});
  });
}

TEST(Blocks, ThreadsChangeNotOneBit) {
  const struct {
    int level;
    VolumeOptions::Core core;
  } cases[] = {{4, VolumeOptions::Core::kOff}, {4, VolumeOptions::Core::kLattice}};
  for (const auto& [level, core] : cases) {
    const SurfaceMesh surface = icosphere(level);
    const double size = std::ldexp(kEdgeOfIcosphere, -level);
    const TetMesh mesh = filled_by(1, surface, size, core);
    EXPECT_EQ(first_defect(mesh, surface), std::nullopt);
    for (const int threads : {2, 3, 8, 16}) EXPECT_TRUE(filled_by(threads, surface, size, core) == mesh) << threads;
  }
}

}  // namespace
}  // namespace octafront
