#include "fill/front/advance.h"

#include "base/core/index_range.h"
#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/shared/shares.h"
#include "fill/front/block_run.h"
#include "fill/front/front_limits.h"

#include <algorithm>
#include <array>
#include <utility>

namespace octafront {

namespace {

constexpr int kMostRounds = 8;
/// A queue of no more faces than this is worked off as far as blocks reach: too little for many phases.
constexpr std::size_t kSmallQueue = 500;
/// Queued faces in a block: its front fits the second-level cache. From 500 to 4000, time and quality change by less
/// than what two runs differ by; fewer faces share better among many threads.
constexpr std::size_t kFacesPerBlock = 500;
/// Faces in a block, for each has to be put into its index: without this, most of the work at the end of a queue would
/// be done for faces that nothing comes near. From 2000 to 8000, time differs by a hundredth.
constexpr std::size_t kMostInBlock = 4000;
/// Layers that a block works off in one phase. Its neighbours then meet a step of as many layers in the front, which
/// costs no quality (1 to 100 layers: mean beta .8237 to .8250, below .2 .049 to .058 %); 4 cost a tenth more time.
constexpr int kLayersPerPhase = 16;
/// Where blocks are divided, phase by phase: no plane comes back soon.
constexpr std::array<double, 4> kQuantiles{0.5, 0.36, 0.64, 0.43};
/// A phase that settles less than this share of its queue is followed by one without blocks.
constexpr double kLeastSettled = 0.2;

/// What ranks must know of each other's blocks before vertices have numbers.
struct BlockTotals {
  std::uint64_t points = 0, deferred = 0;
  FrontWork work;
  FrontCounters counters;
};

/// What a block gives the front, in the front's numbers.
void pack_front(const BlockResult& r, Packer& to) {
  to.add(r.points), to.add(r.sizes), to.add(r.queue), to.add(r.held), to.add(r.passive);
}
void unpack_front(BlockResult& r, Unpacker& from) {
  from.take(r.points), from.take(r.sizes), from.take(r.queue), from.take(r.held), from.take(r.passive);
}

/// Gives the vertices of a block the front's numbers; its own ones begin at `first_own`.
void renumber_block(BlockResult& r, VertexIndex first_own) {
  if (r.found.empty()) return;
  const auto own = static_cast<VertexIndex>(r.found.size());
  const auto take = [&](auto& corners) {
    for (VertexIndex& v : corners) v = v < own ? r.found[v] : first_own + (v - own);
  };
  for (Tet& t : r.tets) take(t);
  for (WaitingFace& w : r.queue) take(w.face.corners);
  for (FrontFace& f : r.held) take(f.corners);
  for (FrontFace& f : r.passive) take(f.corners);
}

class Phases {
 public:
  Phases(FrontState& front, const FrontTask& task, const AdvanceBudget& budget, FrontCounters& counters)
      : front_(front), task_(task), budget_(budget), counters_(counters) {}

  bool run() {
    validate(front_);
    work_off_queue();
    queue_up(front_.passive, 0);
    work_off_queue();
    // Each round lets the faces that are held try all levels; a success may have made room for others, so there are
    // several.
    for (int round = 0; round < kMostRounds && !over_budget(); ++round) {
      const std::size_t before = front_.work.tets;
      for (std::size_t level = 1; level < kLimits.size() && !over_budget(); ++level) {
        counters_.retries += front_.held.size();
        queue_up(front_.held, static_cast<std::uint8_t>(level));
        work_off_queue();
      }
      if (front_.work.tets == before) break;
    }
    return !over_budget();
  }

 private:
  void queue_up(RawVector<FrontFace>& faces, std::uint8_t level) {
    const std::size_t first = front_.queue.size();
    front_.queue.resize(first + faces.size());
    parallel_for(faces.size(), [&](std::size_t f) { front_.queue[first + f] = {faces[f], level, false}; });
    faces.clear();
  }

  void work_off_queue() {
    bool stuck = false;
    while (!front_.queue.empty() && !over_budget()) {
      task_.stage.check();
      if (budget_.volume != kNoLimit)
        task_.stage.progress(static_cast<double>(front_.work.volume) / static_cast<double>(budget_.volume));
      const std::size_t queued = front_.queue.size();
      const bool few = queued <= kSmallQueue, small = few && front_.faces() <= kMostInBlock;
      const std::size_t deferred = phase(small || stuck, few ? kAllLayers : kLayersPerPhase);
      counters_.deferred += deferred;
      stuck = static_cast<double>(deferred) > (1 - kLeastSettled) * static_cast<double>(queued);
    }
  }

  /// Returns how many turns of faces were deferred.
  std::size_t phase(bool undivided, int layers) {
    std::vector<FrontBlock> blocks;
    if (undivided)
      blocks.push_back(FrontBlock::whole(front_));
    else
      blocks = partition_front(front_, {kFacesPerBlock, kQuantiles[front_.phases % kQuantiles.size()], kMostInBlock});
    const FrontPhase phase{front_, task_, budget_.after(front_.work), layers};
    const Comm comm = comm_for(blocks.size());
    const Shares shares = shares_of(blocks, comm);
    std::vector<BlockResult> results(blocks.size());
    do_share(comm, shares, "front", [&](std::size_t b) {
      results[b] = advance_block(phase, blocks[b]);
      blocks[b] = {};
    });
    blocks.clear();
    ++front_.phases;
    const std::size_t deferred = join(results, comm, shares);
    if (!over_budget()) validate(front_);  // a run that was stopped has dropped faces
    return deferred;
  }

  /// What is a single block, every rank does by itself.
  Comm comm_for(std::size_t blocks) const { return Comm(blocks > 1 ? task_.ranks : nullptr); }

  static Shares shares_of(const std::vector<FrontBlock>& blocks, const Comm& comm) {
    std::vector<std::uint64_t> work;
    work.reserve(blocks.size());
    for (const FrontBlock& block : blocks) work.push_back(1 + block.queued);
    return {work, comm.size()};
  }

  /// Numbers what the blocks made in their order, and makes their results the front. Returns how
  /// many turns they deferred.
  std::size_t join(std::vector<BlockResult>& results, const Comm& comm, const Shares& shares) {
    std::size_t deferred = 0;
    const std::vector<std::size_t> first_point = number_points(results, comm, shares, deferred);
    parallel_for(shares.end(comm.rank()) - shares.begin(comm.rank()), [&](std::size_t i) {
      const std::size_t b = shares.begin(comm.rank()) + i;
      renumber_block(results[b], static_cast<VertexIndex>(first_point[b]));
    });
    gather_results(comm, shares, "front", results, pack_front, unpack_front);
    put(results, first_point, comm, shares);
    return deferred;
  }

  /// The front's number of each block's first own point, and of the one behind the last; adds up the totals.
  std::vector<std::size_t> number_points(const std::vector<BlockResult>& results, const Comm& comm,
                                         const Shares& shares, std::size_t& deferred) {
    std::vector<BlockTotals> totals;
    totals.reserve(results.size());
    for (const BlockResult& r : results) totals.push_back({r.points.size(), r.deferred, r.work, r.counters});
    gather_results(
        comm, shares, "front", totals, [](const BlockTotals& t, Packer& to) { to.add(t); },
        [](BlockTotals& t, Unpacker& from) { t = from.take<BlockTotals>(); });
    std::vector<std::size_t> first{front_.points.size()};
    first.reserve(totals.size() + 1);
    for (const BlockTotals& t : totals) {
      first.push_back(first.back() + t.points);
      deferred += t.deferred;
      front_.work += t.work;
      counters_ += t.counters;
    }
    require_in_range(first.back(), kMostVertices, "vertices");
    require_in_range(front_.work.tets, kMostTets, "tetrahedra");
    return first;
  }

  /// Puts the results, in the front's numbers, one behind the other. Tetrahedra stay with the rank that made them.
  void put(std::vector<BlockResult>& results, const std::vector<std::size_t>& first_point, const Comm& comm,
           const Shares& shares) {
    struct Offsets {
      std::size_t queue, held, passive;
    };
    std::vector<Offsets> first;
    first.reserve(results.size());
    Offsets end{0, 0, 0};
    for (const BlockResult& r : results) {
      first.push_back(end);
      end.queue += r.queue.size();
      end.held += r.held.size();
      end.passive += r.passive.size();
    }
    front_.points.resize(first_point.back());
    front_.sizes.resize(first_point.back());
    front_.queue.resize(end.queue);
    front_.held.resize(end.held);
    front_.passive.resize(end.passive);
    const std::size_t pieces = front_.filled.size();
    front_.filled.resize(pieces + results.size());
    parallel_for(results.size(), [&](std::size_t b) {
      BlockResult r = std::move(results[b]);
      const auto copy = [](const auto& from, auto& to, std::size_t at) {
        std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(at));
      };
      copy(r.points, front_.points, first_point[b]);
      copy(r.sizes, front_.sizes, first_point[b]);
      copy(r.queue, front_.queue, first[b].queue);
      copy(r.held, front_.held, first[b].held);
      copy(r.passive, front_.passive, first[b].passive);
      r.tets.shrink_to_fit();
      front_.filled[pieces + b].tets = std::move(r.tets);
    });
    if (comm.alone()) return;
    for (int rank = 0; rank < comm.size(); ++rank)
      for (std::size_t b = shares.begin(rank); b < shares.end(rank); ++b) front_.filled[pieces + b].rank = rank;
  }

  bool over_budget() const { return budget_.exceeded_by(front_.work); }

  FrontState& front_;
  const FrontTask& task_;
  const AdvanceBudget budget_;
  FrontCounters& counters_;
};

}  // namespace

bool advance_front(FrontState& front, const FrontTask& task, const AdvanceBudget& budget, FrontCounters& counters) {
  return Phases(front, task, budget, counters).run();
}

}  // namespace octafront
