#include "base/core/elementary.h"
#include "sizing/sources/budget.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// From the least slope on a step would go nowhere.
constexpr double kFirstSlope = -3, kSteepest = -4, kFlattest = -0.5;
/// Counts that change by less than this part of the least slope stand still.
constexpr double kStandsStill = 0.1;
/// A flatter slope is believed towards larger sizes for so long a step at most, or as long as the first slope makes it:
/// where details of the surface decide, the count falls off a cliff once sizes outgrow them.
constexpr double kFlat = -0.9, kMostBeyond = 0.693;  // twice the size
/// So many steps in turn must have changed nothing.
constexpr int kStillSteps = 2;
/// Smaller steps say nothing: the lattice's cells may double with them, or not.
constexpr double kTellingStep = 0.1;

}  // namespace

CountSearch::CountSearch(double wanted, double scale)
    : wanted_(elementary::log(wanted)), scale_(scale), slope_(kFirstSlope), least_miss_(HUGE_VAL) {}

double CountSearch::factor() const {
  return elementary::exp(scale_);
}

double CountSearch::slope_between(double scale_change, double count_change) {
  return std::clamp(count_change / scale_change, kSteepest, kFlattest);
}

void CountSearch::came_out(double count) {
  before_ = last_;
  last_ = {scale_, elementary::log(count), true};
  (is_above(last_) ? above_ : below_) = last_;
  if (before_.is_known && before_.scale != scale_)
    slope_ = slope_between(scale_ - before_.scale, last_.count - before_.count);
  still_ = did_nothing() ? still_ + 1 : 0;
  is_best_ = std::abs(missing()) < least_miss_;
  if (is_best_) least_miss_ = std::abs(missing());
}

void CountSearch::step() {
  if (!above_.is_known || !below_.is_known)
    step_beyond();
  else if (is_above(before_) == is_above(last_))
    scale_ = 0.5 * (above_.scale + below_.scale);
  else
    scale_ = above_.scale + (below_.scale - above_.scale) * (above_.count - wanted_) / (above_.count - below_.count);
}

void CountSearch::step_beyond() {
  const double most = std::max(kMostBeyond, std::abs(missing() / kFirstSlope));
  const double step = missing() / slope_;
  scale_ += slope_ > kFlat ? std::min(step, most) : step;
}

bool CountSearch::did_nothing() const {
  const double step = last_.scale - before_.scale;
  return before_.is_known && std::abs(step) > kTellingStep &&
         (last_.count - before_.count) / step > kStandsStill * kFlattest;
}

bool CountSearch::stands_still() const {
  return still_ >= kStillSteps;
}

}  // namespace octafront
