#include "base/geometry/measures.h"
#include "images/formulas/formulas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace octafront::formulas {

namespace {

constexpr int kMostSteps = 24;
constexpr int kMostHalvings = 60;

Vec3 along_free_axes(Vec3 v, unsigned fixed) {
  for (int axis = 0; axis < 3; ++axis)
    if ((fixed >> axis & 1u) != 0) v[axis] = 0;
  return v;
}

/// Between two places of different signs.
Vec3 bisected(const SpaceFunction& function, Vec3 below, Vec3 above) {
  for (int i = 0; i < kMostHalvings; ++i) {
    const Vec3 middle = 0.5 * (below + above);
    if (middle == below || middle == above) break;
    (function.at(middle) < 0 ? below : above) = middle;
  }
  return above;
}

/// Of Catmull-Rom's spline between the middle two of four values, at t in [0, 1]: their weights, or derivatives of
/// them.
std::array<double, 4> spline_weights(double t, bool derived) {
  const double t2 = t * t, t3 = t2 * t;
  if (derived)
    return {0.5 * (-1 + 4 * t - 3 * t2), 0.5 * (-10 * t + 9 * t2), 0.5 * (1 + 8 * t - 9 * t2), 0.5 * (-2 * t + 3 * t2)};
  return {0.5 * (-t + 2 * t2 - t3), 0.5 * (2 - 5 * t2 + 3 * t3), 0.5 * (t + 4 * t2 - 3 * t3), 0.5 * (t3 - t2)};
}

}  // namespace

Vec3 FormulaFunction::gradient(Vec3 p) const {
  Vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 low = p, high = p;
    low[axis] -= step_;
    high[axis] += step_;
    gradient[axis] = (formula_.at(high) - formula_.at(low)) / (high[axis] - low[axis]);
  }
  return gradient;
}

SampledSpace::SampledSpace(SampledFunction samples) : samples_(std::move(samples)) {
  for (int axis = 0; axis < 3; ++axis)
    cell_[axis] = samples_.box.extent()[axis] / samples_.size[static_cast<std::size_t>(axis)];
}

double SampledSpace::sample(int i, int j, int k) const {
  // Counted from the layer around the box; straight on beyond it.
  const std::array<int, 3> at{i, j, k};
  std::array<int, 3> inner{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    inner[axis] = std::clamp(at[axis], 0, static_cast<int>(samples_.size[axis]) + 1);
  const auto value = [&](const std::array<int, 3>& c) {
    const std::size_t ni = samples_.size[0] + 2, nj = samples_.size[1] + 2;
    return samples_.values[static_cast<std::size_t>(c[0]) +
                           ni * (static_cast<std::size_t>(c[1]) + nj * static_cast<std::size_t>(c[2]))];
  };
  double straight = value(inner);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (at[axis] == inner[axis]) continue;
    std::array<int, 3> before = inner;
    before[axis] += at[axis] < inner[axis] ? 1 : -1;
    straight += value(inner) - value(before);
  }
  return straight;
}

double SampledSpace::value(Vec3 p, int derived) const {
  std::array<int, 3> first{};
  std::array<std::array<double, 4>, 3> weights{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const double at = (p[a] - samples_.box.lo[a]) / cell_[a] + 0.5;  // in samples
    const double floor = std::clamp(std::floor(at), 0.0, static_cast<double>(samples_.size[axis]));
    first[axis] = static_cast<int>(floor) - 1;
    weights[axis] = spline_weights(std::clamp(at - floor, 0.0, 1.0), a == derived);
  }
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i)
        sum += weights[0][i] * weights[1][j] * weights[2][k] *
               sample(first[0] + static_cast<int>(i), first[1] + static_cast<int>(j), first[2] + static_cast<int>(k));
  return derived < 0 ? sum : sum / cell_[derived];
}

Vec3 nearest_zero(const SpaceFunction& function, Vec3 p, unsigned fixed, double reach, double near_enough) {
  Vec3 x = p, below = p, above = p;
  double least = -HUGE_VAL, most = HUGE_VAL;
  double value = function.at(x);
  for (int step = 0; step < kMostSteps && value != 0; ++step) {
    if (value < 0 && value > least) least = value, below = x;
    if (value > 0 && value < most) most = value, above = x;
    const Vec3 gradient = along_free_axes(function.gradient(x), fixed);
    const double steepness = squared_length(gradient);
    if (!(steepness > 0)) break;
    const Vec3 next = x - gradient * (value / steepness);
    if (next == x || !(squared_distance(next, p) <= reach * reach)) break;
    const double there = function.at(next);
    // Doubles end here: no step comes nearer.
    if (std::abs(there) >= std::abs(value)) break;
    const bool is_near = squared_distance(next, x) <= near_enough * near_enough;
    x = next, value = there;
    if (is_near) return x;
  }
  if (std::isfinite(least) && std::isfinite(most)) {
    const Vec3 between = bisected(function, below, above);
    if (std::abs(function.at(between)) < std::abs(value)) return between;
  }
  return std::isfinite(value) ? x : p;
}

}  // namespace octafront::formulas
