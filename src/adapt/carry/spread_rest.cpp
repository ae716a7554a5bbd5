#include "adapt/carry/carry.h"
#include "adapt/carry/sums.h"
#include "base/core/groups.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace octafront::adapt {
namespace {

/// Parts of the integral of magnitudes that are rounding: nothing is spread for them.
constexpr double kRoundingOfIntegral = 1e-15;
/// Parts of it by which a volume may differ from rounding: of the same body a constant stays what it is.
constexpr double kRoundingOfVolumes = 1e-12;
/// Each round fills elements up to the end of the range, or ends it.
constexpr int kMostFillings = 60;

/// One component in one region.
class RegionBalance {
 public:
  RegionBalance(const MeshPair& meshes, std::span<const TetIndex> changed, std::size_t components, std::size_t k,
                std::vector<double>& made)
      : changed_(changed), components_(components), k_(k), made_(made) {
    for (const TetIndex t : changed_) volumes_.push_back(volume_in(meshes.now, t));
  }

  void widen(double value) { least_ = std::min(least_, value), greatest_ = std::max(greatest_, value); }

  void add_old(double volume, double value, bool is_gone) {
    widen(value);
    if (is_gone) wanted_.add(volume * value), scale_ += std::abs(volume * value);
  }

  /// Returns how far beyond the range values went.
  double balance() {
    if (changed_.empty() || !(least_ <= greatest_)) return 0;
    CarefulSum volume;
    for (const double v : volumes_) volume.add(v);
    const double all = volume.value(), wanted = wanted_.value(), leeway = kRoundingOfVolumes * scale_;
    if (wanted > all * greatest_ + leeway || wanted < all * least_ - leeway) return shift(lacking() / all);
    fill();
    return 0;
  }

 private:
  double& value(TetIndex t) { return made_[t * components_ + k_]; }

  double lacking() {
    CarefulSum sum = wanted_;
    for (std::size_t i = 0; i < changed_.size(); ++i) sum.add(-volumes_[i] * value(changed_[i]));
    return sum.value();
  }

  bool has_room(double value, double rest) const { return rest > 0 ? value < greatest_ : value > least_; }

  /// Evenly, over those that have room; false: none has.
  bool move_within(double rest) {
    CarefulSum room;
    for (std::size_t i = 0; i < changed_.size(); ++i)
      if (has_room(value(changed_[i]), rest)) room.add(volumes_[i]);
    if (room.value() <= 0) return false;
    const double step = rest / room.value();
    bool has_moved = false;
    for (const TetIndex t : changed_) {
      const double before = value(t);
      if (has_room(before, rest)) value(t) = std::clamp(before + step, least_, greatest_);
      has_moved = has_moved || value(t) != before;
    }
    return has_moved;
  }

  void fill() {
    for (const TetIndex t : changed_) value(t) = std::clamp(value(t), least_, greatest_);
    for (int round = 0; round < kMostFillings; ++round) {
      const double rest = lacking();
      if (std::abs(rest) <= kRoundingOfIntegral * scale_ || !move_within(rest)) return;
    }
  }

  /// Differences between values stay.
  double shift(double step) {
    double beyond = 0;
    for (const TetIndex t : changed_) {
      value(t) += step;
      beyond = std::max({beyond, value(t) - greatest_, least_ - value(t)});
    }
    return beyond;
  }

  std::span<const TetIndex> changed_;
  std::size_t components_, k_;
  std::vector<double>& made_;
  std::vector<double> volumes_;
  CarefulSum wanted_;
  double scale_ = 0, least_ = std::numeric_limits<double>::infinity(), greatest_ = -least_;
};

}  // namespace

std::vector<double> spread_rest(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                std::vector<double>& made, const OldValues* at_points) {
  const MatchedRegions& regions = meshes.regions;
  const auto changed = group_by_owner(
      regions.count(), static_cast<std::uint32_t>(meshes.now.tets.size()),
      [&](std::uint32_t t) { return meshes.same.old_tet_of_new[t] == kNone ? regions.of_new(t) : kNoOwner; });
  std::vector<double> beyond(old.components, 0);
  for (std::size_t k = 0; k < old.components; ++k) {
    std::vector<RegionBalance> balances;
    for (std::uint32_t r = 0; r < regions.count(); ++r)
      balances.emplace_back(meshes, changed[r], old.components, k, made);
    for (TetIndex t = 0; t < meshes.before.tets.size(); ++t)
      balances[regions.of_old(t)].add_old(volume_in(meshes.before, t), old.values[t * old.components + k],
                                          gone.is_gone(t));
    if (at_points != nullptr)
      for (std::size_t i = k; i < at_points->values.size(); i += old.components)
        balances[regions.of_old(static_cast<TetIndex>(i / at_points->components))].widen(at_points->values[i]);
    for (RegionBalance& balance : balances) beyond[k] = std::max(beyond[k], balance.balance());
  }
  return beyond;
}

}  // namespace octafront::adapt
