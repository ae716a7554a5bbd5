#include "adapt/carry/carry.h"
#include "adapt/carry/element_slopes.h"
#include "adapt/carry/sums.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <memory>

namespace octafront::adapt {
namespace {

/// Tets that share less than this part of themselves with old ones share nothing: what is left of them is rounding.
constexpr double kLeastShared = 1e-9;
/// Between two looks at whether to stop.
constexpr std::size_t kElementsAtATime = 1 << 16;

class ElementMeans {
 public:
  ElementMeans(const MeshPair& meshes, const GoneTets& gone, const OldValues& old, const CarryOptions& options)
      : meshes_(meshes),
        gone_(gone),
        old_(old),
        made(meshes.now.tets.size() * old.components, 0),
        covered_(meshes.now.tets.size(), 1) {
    if (options.linear_elements)
      slopes_ = std::make_unique<ElementSlopes>(meshes.before, meshes.regions, old.values, old.components);
  }

  void find_all(const RunContext& context) {
    const std::size_t n = meshes_.now.tets.size();
    for (std::size_t begin = 0; begin < n; begin += kElementsAtATime) {
      context.check();
      context.report("fields", static_cast<double>(begin) / static_cast<double>(n));
      const std::size_t count = std::min(kElementsAtATime, n - begin);
      parallel_for(count, [&](std::size_t i) { find(static_cast<TetIndex>(begin + i)); });
    }
  }

  /// What is new is not covered, what is old is lost.
  void enter_into(CarryReport& report) const {
    CarefulSums sums = parallel_sum(covered_.size(), [&](std::size_t begin, std::size_t end) {
      CarefulSums part(2);
      for (std::size_t t = begin; t < end; ++t) {
        if (is_copied(static_cast<TetIndex>(t))) continue;
        const double volume = volume_in(meshes_.now, static_cast<TetIndex>(t)), covered = std::min(covered_[t], 1.0);
        part[0].add((1 - covered) * volume), part[1].add(covered * volume);
      }
      return part;
    });
    for (TetIndex t = 0; t < meshes_.before.tets.size(); ++t)
      if (gone_.is_gone(t)) sums[1].add(-volume_in(meshes_.before, t));
    report.uncovered = sums[0].value(), report.lost = std::max(0.0, -sums[1].value());
  }

 private:
  bool is_copied(TetIndex t) const { return meshes_.same.old_tet_of_new[t] != kNone; }
  double& value(TetIndex t, std::size_t k) { return made[t * old_.components + k]; }
  double old_value(TetIndex t, std::size_t k) const { return old_.values[t * old_.components + k]; }

  void copy(TetIndex to, TetIndex from) {
    for (std::size_t k = 0; k < old_.components; ++k) value(to, k) = old_value(from, k);
  }

  void find(TetIndex t) {
    if (is_copied(t)) return copy(t, meshes_.same.old_tet_of_new[t]);
    const TetPlanes tet(corners_in(meshes_.now, t));
    const std::uint32_t region = meshes_.regions.of_new(t);
    const auto is_of_region = [&](TetIndex old) { return meshes_.regions.of_old(old) == region; };
    Box3 box;
    for (const Vec3& p : tet.corners()) box.add(p);
    double sum = 0;
    gone_.for_each_near(box, [&](TetIndex old) {
      if (is_of_region(old)) sum += add_shared(t, tet, old);
    });
    covered_[t] = sum;
    if (sum > kLeastShared) {
      for (std::size_t k = 0; k < old_.components; ++k) value(t, k) /= sum;
      return;
    }
    covered_[t] = 0;
    for (std::size_t k = 0; k < old_.components; ++k) value(t, k) = 0;
    if (const TetIndex old = gone_.nearest(tet.centre(), is_of_region); old != kNone) copy(t, old);
  }

  double add_shared(TetIndex t, const TetPlanes& tet, TetIndex old) {
    const TetCorners other = corners_in(meshes_.before, old);
    if (slopes_ == nullptr) {
      const double shared = shared_volume(tet, other);
      for (std::size_t k = 0; shared > 0 && k < old_.components; ++k) value(t, k) += shared * old_value(old, k);
      return shared;
    }
    const TetOverlap shared = shared_moments(tet, other);
    if (shared.share == 0) return 0;
    const Vec3 way = shared.moment + shared.share * (tet.corners()[0] - middle_of(other));
    for (std::size_t k = 0; k < old_.components; ++k)
      value(t, k) += shared.share * old_value(old, k) + dot(slopes_->slope(old, k), way);
    return shared.share;
  }

  const MeshPair& meshes_;
  const GoneTets& gone_;
  const OldValues& old_;
  std::unique_ptr<ElementSlopes> slopes_;

 public:
  std::vector<double> made;

 private:
  std::vector<double> covered_;  ///< the part of each tet that old ones of its region cover
};

}  // namespace

std::vector<double> carried_of_elements(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                        const CarryOptions& options, const RunContext& context, CarryReport& report) {
  ElementMeans means(meshes, gone, old, options);
  means.find_all(context);
  means.enter_into(report);
  return std::move(means.made);
}

}  // namespace octafront::adapt
