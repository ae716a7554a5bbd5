#pragma once

// The place of a vertex at which its star falls short of good elements the least, in sum. Where the boundary forces a
// bad element, the worst of a star says nothing about the others; a sum does.

#include "base/core/elementary.h"
#include "improve/shape/shape.h"

#include <algorithm>

namespace octafront::improve {

/// Elements of this score lack nothing.
inline constexpr double kComfort = 0.4;
/// Scores well below this are all alike: a forced element may halve its own if others gain.
inline constexpr double kHopeless = 0.01;

/// What an element lacks: 0 from kComfort on, 1.7 at 0.1, 13.8 if flat. The logarithm makes the step from 0.05 to 0.1
/// worth more than that from 0.3 to 0.35.
inline double root_of_lack(double score) {
  if (score >= kComfort) return 0;
  // Inverted elements, which are met on the way to a place, go on with the slope at 0.
  const double inverted = std::min(score, 0.0) / kHopeless;
  return elementary::log((kComfort + kHopeless) / (std::max(score, 0.0) + kHopeless)) - inverted;
}
inline double lack_of(double score) {
  const double root = root_of_lack(score);
  return root * root;
}

/// Sum over the elements of a batch, as evaluated.
inline double lack_of(const ShapeBatch& batch) {
  double sum = 0;
  for (int i = 0; i < batch.size; ++i) sum += lack_of(batch.quality[i]);
  return sum;
}

/// Damped Gauss-Newton steps (Levenberg 1944, Marquardt 1963) on the square sum of what the elements of a star lack.
class LackDescent {
 public:
  /// `batch` holds the star, corner 0 being the vertex. Takes up to `steps` steps from `start`, each of which lowers
  /// the sum and satisfies `allowed(place)`, called with the batch evaluated at the place.
  template <typename Allowed>
  void descend(ShapeBatch& batch, Vec3 start, int steps, Allowed&& allowed) {
    begin(batch, start);
    for (int step = 0; step < steps && lack_ > 0; ++step) {
      linearize(batch);
      bool lower = false;
      for (int tries = 0; tries < kTries && !lower; ++tries) {
        const Vec3 to = at_ + damped_step();
        batch.evaluate_star(to);
        const double reached = lack_of(batch);
        lower = reached < lack_ * kFall && allowed(to);
        damping_ *= lower ? kLessDamping : kMoreDamping;
        if (!lower) continue;
        lack_ = reached;
        at_ = to;
        moved_ = true;
      }
      if (!lower) return;
    }
  }

  Vec3 place() const { return at_; }
  double lack() const { return lack_; }
  bool moved() const { return moved_; }

 private:
  static constexpr int kTries = 4;        ///< steps of more damping per gradient
  static constexpr double kFall = 0.999;  ///< a step must lower the sum to this part of it
  static constexpr double kLessDamping = 0.2, kMoreDamping = 8;

  void begin(ShapeBatch& batch, Vec3 start);
  void linearize(ShapeBatch& batch);
  Vec3 damped_step() const;

  Vec3 at_, slope_;
  double bend_[3][3];
  double lack_ = 0, difference_ = 0, damping_ = 0, farthest_ = 0;
  bool moved_ = false;
  double residual_[ShapeBatch::kBatch], gradient_[3][ShapeBatch::kBatch];
};

}  // namespace octafront::improve
