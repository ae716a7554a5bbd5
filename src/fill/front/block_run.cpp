#include "fill/front/block_run.h"

#include "base/core/flat_map.h"
#include "base/core/validate.h"
#include "fill/front/attempt.h"
#include "fill/front/front.h"

#include <algorithm>
#include <utility>

namespace octafront {

namespace {

constexpr std::size_t kFacesBetweenChecks = 512;

class BlockRun {
 public:
  BlockRun(const FrontPhase& phase, const FrontBlock& block)
      : phase_(phase),
        state_(phase.front),
        block_(block),
        front_(state_.domain, state_.finest_size),
        attempt_(front_, phase.task, block.territory, result_.counters) {
    fill_front();
  }

  BlockResult run() {
    work_off();
    validate(front_);
    collect();
    return std::move(result_);
  }

 private:
  struct Turn {
    QueuedFace face;
    std::uint8_t level;
  };

  void fill_front() {
    FlatMap<VertexIndex, VertexIndex> local(block_.members.size());
    const auto number = [&](VertexIndex v) {
      VertexIndex& here = local.find_or_add(v, kNone);
      if (here != kNone) return here;
      result_.found.push_back(v);
      return here = front_.add_vertex(state_.points[v], state_.sizes[v]);
    };
    for (const FrontBlock::Member m : block_.members) {
      const auto& [t, region] = state_.face(m.face);
      front_.add_face({{number(t[0]), number(t[1]), number(t[2])}, region});
    }
  }

  /// The first layer: owned faces of the queue; those that have waited for a block to fit them come first.
  std::vector<Turn> first_layer() const {
    std::vector<Turn> layer;
    layer.reserve(block_.queued);
    for (const bool deferred : {true, false})
      for (FaceIndex f = 0; f < block_.members.size(); ++f) {
        const FrontBlock::Member m = block_.members[f];
        if (!m.owned || m.face >= state_.queue.size() || state_.queue[m.face].deferred != deferred) continue;
        layer.push_back({front_.queued(f), state_.queue[m.face].level});
      }
    return layer;
  }

  void work_off() {
    const VolumeOptions::Order order = phase_.task.options.order;
    std::vector<Turn> layer = first_layer();
    if (order == VolumeOptions::Order::kNewest) return work_off_newest(std::move(layer));
    for (int layers = block_.is_of_regions ? kAllLayers : phase_.layers; !layer.empty() && layers > 0 && !over_budget();
         --layers) {
      if (order == VolumeOptions::Order::kSmallest) sort_by_area(layer);
      created_.clear();
      for (const Turn& turn : layer) take(turn);
      layer.clear();
      for (const QueuedFace& q : created_)
        if (front_.alive(q)) layer.push_back({q, 0});
    }
    next_ = std::move(layer);
  }

  /// Depth first: a face's own offspring come before its neighbours.
  void work_off_newest(std::vector<Turn> stack) {
    std::reverse(stack.begin(), stack.end());
    while (!stack.empty() && !over_budget()) {
      const Turn turn = stack.back();
      stack.pop_back();
      created_.clear();
      take(turn);
      for (const QueuedFace& q : created_) stack.push_back({q, 0});
    }
  }

  void sort_by_area(std::vector<Turn>& layer) const {
    const auto squared_area = [&](const Turn& t) {
      const Triangle& c = front_.corners(t.face.face);
      const Vec3 a = front_.at(c[0]);
      return squared_length(cross(front_.at(c[1]) - a, front_.at(c[2]) - a));
    };
    std::vector<std::pair<double, std::size_t>> keys(layer.size());
    for (std::size_t i = 0; i < layer.size(); ++i) keys[i] = {squared_area(layer[i]), i};
    std::sort(keys.begin(), keys.end());
    std::vector<Turn> sorted;
    sorted.reserve(layer.size());
    for (const auto& [area, i] : keys) sorted.push_back(layer[i]);
    layer = std::move(sorted);
  }

  void take(const Turn& turn) {
    if (++turns_ % kFacesBetweenChecks == 0) phase_.task.stage.check();
    if (over_budget() || !front_.alive(turn.face)) return;
    switch (attempt_.advance(turn.face.face, kLimits[turn.level], created_)) {
      case Attempt::Outcome::kAdvanced:
        break;
      case Attempt::Outcome::kStuck:
        held_.push_back(turn.face);
        break;
      case Attempt::Outcome::kBeyond:
        deferred_.push_back(turn);
        break;
    }
  }

  FrontWork work() const {
    return {front_.tets().size(), volume_part(front_.filled_volume(), state_.domain), attempt_.face_tests()};
  }
  bool over_budget() const { return phase_.budget.exceeded_by(work()); }

  void collect() {
    for (const Turn& t : deferred_)
      if (front_.alive(t.face)) result_.queue.push_back({front_.face(t.face.face), t.level, true});
    for (const Turn& t : next_)
      if (front_.alive(t.face)) result_.queue.push_back({front_.face(t.face.face), t.level, false});
    const std::size_t first_passive = state_.queue.size() + state_.held.size();
    for (FaceIndex f = 0; f < block_.members.size(); ++f) {
      const FrontBlock::Member m = block_.members[f];
      if (!m.owned || m.face < state_.queue.size() || !front_.alive({f, 0})) continue;
      (m.face < first_passive ? result_.held : result_.passive).push_back(front_.face(f));
    }
    for (const QueuedFace& q : held_)
      if (front_.alive(q)) result_.held.push_back(front_.face(q.face));
    for (std::size_t v = result_.found.size(); v < front_.vertices().size(); ++v) {
      result_.points.push_back(front_.vertices()[v].at);
      result_.sizes.push_back(front_.vertices()[v].size);
    }
    result_.deferred = deferred_.size();
    result_.work = work();
    result_.tets = std::move(front_.tets());
  }

  const FrontPhase& phase_;
  const FrontState& state_;
  const FrontBlock& block_;
  BlockResult result_;
  Front front_;
  Attempt attempt_;
  std::vector<QueuedFace> created_, held_;
  std::vector<Turn> deferred_, next_;
  std::size_t turns_ = 0;
};

/// Where nothing waits all faces stay what they are, in the front's numbers.
BlockResult untouched(const FrontState& state, const FrontBlock& block) {
  BlockResult result;
  const std::size_t first_passive = state.queue.size() + state.held.size();
  for (const FrontBlock::Member m : block.members)
    if (m.owned) (m.face < first_passive ? result.held : result.passive).push_back(state.face(m.face));
  return result;
}

}  // namespace

BlockResult advance_block(const FrontPhase& phase, const FrontBlock& block) {
  return block.queued > 0 ? BlockRun(phase, block).run() : untouched(phase.front, block);
}

}  // namespace octafront
