#pragma once

#include <octafront/size_field.h>

#include "base/core/stage.h"
#include "sizing/sources/budget.h"

#include <cmath>
#include <cstddef>
#include <optional>

namespace octafront::surface {

/// The elements that sizes may come to, by the prediction, and what was given up for it. Refers to the surface.
class ElementBudget {
 public:
  /// `most`: HUGE_VAL: there is no budget.
  ElementBudget(const SurfaceMesh& surface, double most, const Stage& stage)
      : surface_(surface), most_(most), stage_(stage) {}

  bool is_limited() const { return std::isfinite(most_); }
  double most() const { return most_; }
  /// Elements by these sizes. The first call takes the time of a walk through the surface.
  double expected(const SizeField& sizes);
  /// `finer` as far as the budget goes, nowhere above `first`; in this round.
  SizeField affordable(const SizeField& finer, const SizeField& first, int round);

  bool is_spent() const { return floor_ > 0; }
  int spent_in_round() const { return spent_in_round_; }
  /// Says what was given up: `far` places lie farther from the input than `deviation`.
  void note(std::size_t far, double farthest, double deviation) const;

 private:
  const SurfaceMesh& surface_;
  double most_;
  const Stage& stage_;
  std::optional<TetPrediction> expected_;  ///< made when it is needed
  double asked_ = 0, floor_ = 0;           ///< elements, and the least size that is left; 0: nothing was given up
  int spent_in_round_ = 0;
};

}  // namespace octafront::surface
