#include "improve/shape/maximize_worst.h"

#include <algorithm>

namespace octafront::improve {
namespace {

constexpr double kFirstReach = 0.15;       ///< in squared edge lengths
constexpr double kWorstDifference = 1e-6;  ///< step of the differences, in edge lengths
constexpr int kDualSteps = 24;
constexpr double kDualGap = 1e-3;

}  // namespace

void WorstMaximizer::begin(ShapeBatch& batch, Vec3 start) {
  at_ = start;
  moved_ = false;
  size_ = batch.size;
  const double edge = batch.mean_edge(start);
  reach_ = kFirstReach * edge * edge;
  difference_ = kWorstDifference * edge;
}

void WorstMaximizer::linearize(ShapeBatch& batch, std::span<const Vec3> axes) {
  batch.evaluate_star(at_);
  least_ = 0;
  for (int i = 0; i < size_; ++i) {
    quality_[i] = batch.quality[i];
    if (quality_[i] < quality_[least_]) least_ = i;
  }
  worst_ = quality_[least_];
  for (auto& g : gradient_) std::fill_n(g.begin(), size_, 0.0);
  for (const Vec3 axis : axes) {
    const Vec3 beside = at_ + difference_ * axis;
    const double by = dot(beside - at_, axis);
    batch.evaluate_star(beside);
    for (int i = 0; i < size_; ++i) {
      const double slope = by != 0 ? (batch.quality[i] - quality_[i]) / by : 0;
      for (int k = 0; k < 3; ++k) gradient_[k][i] += slope * axis[k];
    }
  }
}

double WorstMaximizer::predicted(Vec3 d) const {
  double least = 1;
  for (int i = 0; i < size_; ++i) least = std::min(least, quality_[i] + dot(gradient(i), d));
  return least;
}

Vec3 WorstMaximizer::best_step() const {
  Vec3 g = gradient(least_);
  double q = quality_[least_];
  for (int k = 0; k < kDualSteps; ++k) {
    int least = 0;
    double least_value = 2;
    const Vec3 d = reach_ * g;
    for (int i = 0; i < size_; ++i) {
      const double value = quality_[i] + (gradient_[0][i] * d.x + gradient_[1][i] * d.y + gradient_[2][i] * d.z);
      if (value < least_value) least_value = value, least = i;
    }
    const double gap = q + dot(g, d) - least_value;
    if (!(gap > kDualGap)) break;
    const Vec3 towards = gradient(least) - g;
    const double curvature = reach_ * squared_length(towards);
    const double s = gap < curvature ? gap / curvature : 1;
    g += s * towards;
    q += s * (quality_[least] - q);
  }
  return reach_ * g;
}

}  // namespace octafront::improve
