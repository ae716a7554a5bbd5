#pragma once

#include <octafront/vec.h>

#include <array>
#include <functional>

namespace octafront {

class SizeFunction;  // what stands behind a SizeField: the library's own

/// The edge length wanted at each point, in input units: continuous, positive, and graded,
///   |h(x) - h(y)| <= gradation * |x - y|.
/// Example: h = 1 on a wall and gradation 0.3 give h = 4 at distance 10.
///
/// A value type that shares its immutable data; copies are cheap and safe to use from many threads.
class SizeField {
 public:
  /// The same size everywhere. Requires h > 0.
  static SizeField uniform(double h);
  /// Any function; the caller answers for its gradation. `lo` and `hi` bound its values (it is clamped to them).
  static SizeField from_function(std::function<double(Vec3)> h, double lo, double hi);

  /// The wanted edge length at p. Outside the background grid: the value at the nearest point of it.
  double at(Vec3 p) const;
  /// The metric that asks for this edge length at p: a symmetric 3 x 3 matrix M in 1 / (input unit)^2. An edge, a
  /// vector e, has the wanted length where e^T M e = 1. Sizes are the same in all directions: M is the identity /
  /// at(p)^2.
  std::array<std::array<double, 3>, 3> metric_at(Vec3 p) const;
  double min_size() const;
  double max_size() const;

  SizeField(const SizeField& other) noexcept;
  SizeField& operator=(SizeField other) noexcept;
  ~SizeField();

 private:
  friend class SizeFunction;
  explicit SizeField(const SizeFunction& function) noexcept;

  const SizeFunction* function_;  // counted; see sizing/field/size_function.h
};

}  // namespace octafront
