#pragma once

// The place of a vertex at which the least score of its star is greatest.

#include "improve/shape/shape.h"

#include <array>
#include <span>

namespace octafront::improve {

/// Climbs from a starting place. Each step takes the scores as linear (gradients by differences, a whole star at once)
/// and maximises  min_i (q_i + g_i . d) - |d|^2 / (2 reach),  whose dual is a quadratic form over the simplex, solved
/// by a few Frank-Wolfe steps. No set of "active" elements has to be guessed, unlike in Freitag & Ollivier-Gooch,
/// "Tetrahedral mesh improvement using swapping and smoothing" (1997), whose aim this shares.
class WorstMaximizer {
 public:
  /// `batch` holds the star, corner 0 being the vertex. Takes up to `steps` steps from `start`, each of which raises
  /// the worst score and satisfies `allowed(place)`, called with the batch evaluated at the place.
  template <typename Allowed>
  void climb(ShapeBatch& batch, Vec3 start, int steps, Allowed&& allowed) {
    climb_along(
        kAxes, [](Vec3&) { return true; }, batch, start, steps, allowed);
  }

  /// The same for a vertex that goes only along the axes (unit vectors, orthogonal), from where `snap(place)` puts it
  /// back on what it has to stay on, or says that it cannot.
  template <typename Snap, typename Allowed>
  void climb_along(std::span<const Vec3> axes, Snap&& snap, ShapeBatch& batch, Vec3 start, int steps,
                   Allowed&& allowed) {
    begin(batch, start);
    for (int step = 0; step < steps; ++step) {
      linearize(batch, axes);
      if (!advance(batch, snap, allowed)) return;
    }
  }

  Vec3 place() const { return at_; }
  double worst() const { return worst_; }
  bool moved() const { return moved_; }

 private:
  static constexpr std::array<Vec3, 3> kAxes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  static constexpr int kShorter = 3;          ///< shorter tries per gradient
  static constexpr double kLeastGain = 2e-3;  ///< predicted gains below this are not worth a try

  void begin(ShapeBatch& batch, Vec3 start);
  void linearize(ShapeBatch& batch, std::span<const Vec3> axes);
  Vec3 best_step() const;
  double predicted(Vec3 d) const;

  template <typename Snap, typename Allowed>
  bool advance(ShapeBatch& batch, Snap&& snap, Allowed&& allowed) {
    for (int shorter = 0; shorter <= kShorter; ++shorter, reach_ *= 0.25) {
      const Vec3 d = best_step();
      const double gain = predicted(d) - worst_;
      if (!(gain > kLeastGain)) return false;
      Vec3 to = at_ + d;
      if (!snap(to)) continue;
      batch.evaluate_star(to);
      const double reached = batch.worst();
      if (!(reached > worst_) || !allowed(to)) continue;
      if (reached - worst_ > 0.5 * gain) reach_ *= 2;
      worst_ = reached;
      at_ = to;
      moved_ = true;
      return true;
    }
    return false;
  }

  Vec3 gradient(int i) const { return {gradient_[0][i], gradient_[1][i], gradient_[2][i]}; }

  Vec3 at_;
  double worst_ = 0, reach_ = 0, difference_ = 0;
  bool moved_ = false;
  int size_ = 0, least_ = 0;
  std::array<double, ShapeBatch::kBatch> quality_;
  std::array<std::array<double, ShapeBatch::kBatch>, 3> gradient_;
};

}  // namespace octafront::improve
