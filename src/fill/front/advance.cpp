#include "fill/front/advance.h"

#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/mesh/index_range.h"
#include "fill/front/block_run.h"
#include "fill/front/limits.h"

#include <algorithm>
#include <array>
#include <utility>

namespace octafront {

namespace {

constexpr int kMostRounds = 8;
/// A queue of no more faces than this is worked off to its end in one block.
constexpr std::size_t kSmallQueue = 1500;
/// Queued faces in a block: their front fits the second-level cache. From 600 to 4000, time and quality change by less
/// than what two runs differ by; fewer faces share better among many threads.
constexpr std::size_t kFacesPerBlock = 1500;
/// Layers that a block works off in one phase. Its neighbours then meet a step of as many layers in the front, which
/// costs no quality (1 to 100 layers: mean beta .8237 to .8250, below .2 .049 to .058 %); 1 costs a tenth more time.
constexpr int kLayersPerPhase = 4;
/// Where blocks are divided, phase by phase: no plane comes back soon.
constexpr std::array<double, 4> kQuantiles{0.5, 0.36, 0.64, 0.43};
/// A phase that settles less than this share of its queue is followed by one without blocks.
constexpr double kLeastSettled = 0.2;

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
  void queue_up(std::vector<FrontFace>& faces, std::uint8_t level) {
    for (const FrontFace& f : faces) front_.queue.push_back({f, level, false});
    faces.clear();
  }

  void work_off_queue() {
    bool stuck = false;
    while (!front_.queue.empty() && !over_budget()) {
      task_.stage.check();
      if (budget_.volume != kNoLimit)
        task_.stage.progress(static_cast<double>(front_.work.volume) / static_cast<double>(budget_.volume));
      const std::size_t queued = front_.queue.size();
      const bool small = queued <= kSmallQueue;
      const std::size_t deferred = phase(small || stuck, small ? kAllLayers : kLayersPerPhase);
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
      blocks = partition_front(front_, {kFacesPerBlock, kQuantiles[front_.phases % kQuantiles.size()]});
    const FrontPhase phase{front_, task_, budget_.after(front_.work), layers};
    std::vector<BlockResult> results(blocks.size());
    parallel_for(
        blocks.size(),
        [&](std::size_t b) {
          results[b] = advance_block(phase, blocks[b]);
          blocks[b] = {};
        },
        Split::kSingly);
    ++front_.phases;
    const std::size_t deferred = join(results);
    if (!over_budget()) validate(front_);  // a run that was stopped has dropped faces
    return deferred;
  }

  /// Numbers what the blocks made in their order, and makes their results the front. Returns how
  /// many turns they deferred.
  std::size_t join(std::vector<BlockResult>& results) {
    struct Offsets {
      std::size_t point, queue, held, passive;
    };
    std::vector<Offsets> first;
    first.reserve(results.size());
    Offsets end{front_.points.size(), 0, 0, 0};
    std::size_t deferred = 0;
    for (const BlockResult& r : results) {
      first.push_back(end);
      end.point += r.points.size();
      end.queue += r.queue.size();
      end.held += r.held.size();
      end.passive += r.passive.size();
      deferred += r.deferred;
      front_.work += r.work;
      counters_ += r.counters;
    }
    require_in_range(end.point, kMostVertices, "vertices");
    require_in_range(front_.work.tets, kMostTets, "tetrahedra");
    front_.points.resize(end.point);
    front_.sizes.resize(end.point);
    front_.queue.resize(end.queue);
    front_.held.resize(end.held);
    front_.passive.resize(end.passive);
    const std::size_t pieces = front_.filled.size();
    front_.filled.resize(pieces + results.size());
    parallel_for(results.size(), [&](std::size_t b) {
      BlockResult r = std::move(results[b]);
      const auto own = static_cast<VertexIndex>(r.found.size());
      const auto first_own = static_cast<VertexIndex>(first[b].point);
      const auto renumber = [&](auto& corners) {
        for (VertexIndex& v : corners) v = v < own ? r.found[v] : first_own + (v - own);
      };
      for (Tet& t : r.tets) renumber(t);
      for (WaitingFace& w : r.queue) renumber(w.face.corners);
      for (FrontFace& f : r.held) renumber(f.corners);
      for (FrontFace& f : r.passive) renumber(f.corners);
      const auto put = [](const auto& from, auto& to, std::size_t at) {
        std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(at));
      };
      put(r.points, front_.points, first[b].point);
      put(r.sizes, front_.sizes, first[b].point);
      put(r.queue, front_.queue, first[b].queue);
      put(r.held, front_.held, first[b].held);
      put(r.passive, front_.passive, first[b].passive);
      r.tets.shrink_to_fit();
      front_.filled[pieces + b] = std::move(r.tets);
    });
    return deferred;
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
