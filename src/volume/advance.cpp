#include "volume/advance.h"

#include <cmath>
#include <utility>

namespace octafront {

namespace {

constexpr std::size_t kFacesBetweenChecks = 512, kFacesBetweenReports = 1 << 15;
constexpr int kMostRounds = 8;

/// The queues of one run.
class Queues {
 public:
  Queues(Front& front, const AdvanceBudget& budget, const RunContext& context, FrontCounters& counters,
         Attempt& attempt)
      : front_(front), budget_(budget), context_(context), counters_(counters), attempt_(attempt) {}

  AdvanceResult run(std::vector<QueuedFace> layer, std::vector<QueuedFace> passive) {
    work_off(std::move(layer), 0);
    work_off(std::move(passive), 0);
    // Each round lets the faces that wait try all levels; a success may have made room for others, so there are
    // several.
    for (int round = 0; round < kMostRounds && !over_budget(); ++round) {
      const std::size_t before = front_.tets().size();
      for (std::size_t level = 1; level < kLimits.size() && !over_budget(); ++level) {
        std::vector<QueuedFace> held = take_held();
        counters_.retries += held.size();
        work_off(std::move(held), level);
      }
      if (front_.tets().size() == before) break;
    }
    AdvanceResult result;
    result.over_budget = over_budget();
    for (const QueuedFace& q : take_held()) result.left.push_back(q.face);
    return result;
  }

 private:
  void work_off(std::vector<QueuedFace> layer, std::size_t level) {
    std::vector<QueuedFace> next;
    while (!layer.empty()) {
      ++counters_.layers;
      for (const QueuedFace& q : layer) {
        if (counters_.attempts % kFacesBetweenChecks == 0) context_.check();
        if (counters_.attempts % kFacesBetweenReports == 0 && std::isfinite(budget_.volume))
          context_.report("volume", front_.filled_volume() / budget_.volume);
        if (over_budget()) return;
        if (!front_.alive(q)) continue;
        if (!attempt_.advance(q.face, kLimits[level], next)) held_.push_back(q);
      }
      layer.swap(next);
      next.clear();
      level = 0;
    }
  }

  std::vector<QueuedFace> take_held() {
    std::vector<QueuedFace> held;
    for (const QueuedFace& q : std::exchange(held_, {}))
      if (front_.alive(q)) held.push_back(q);
    return held;
  }

  bool over_budget() const {
    return front_.tets().size() > budget_.tets || front_.filled_volume() > budget_.volume ||
           counters_.face_tests > budget_.face_tests;
  }

  Front& front_;
  AdvanceBudget budget_;
  const RunContext& context_;
  FrontCounters& counters_;
  Attempt& attempt_;
  std::vector<QueuedFace> held_;
};

}  // namespace

AdvanceResult advance_front(Front& front, std::vector<QueuedFace> layer, std::vector<QueuedFace> passive,
                            const SizeField& sizes, const VolumeOptions& options, const AdvanceBudget& budget,
                            const RunContext& context, FrontCounters& counters) {
  Attempt attempt(front, sizes, options, counters);
  AdvanceResult result = Queues(front, budget, context, counters, attempt).run(std::move(layer), std::move(passive));
  counters.faces_found += attempt.faces_found();
  return result;
}

}  // namespace octafront
