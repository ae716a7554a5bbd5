#pragma once

// adapt/metric: metric tensors as a language for wanted elements: lengths, worth, means, products of them. Takes
// numbers and points, leaves numbers; knows nothing of how a mesh is changed.
//
// A metric M asks for elements whose edges e have e^T M e = 1: its eigenvectors are directions, its eigenvalues
// 1 / h^2 of the lengths wanted along them. A size is the metric I / h^2.

#include <octafront/metric.h>
#include <octafront/size_field.h>
#include <octafront/vec.h>

#include "base/core/vector_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace octafront::adapt {

using octafront::Metric;

/// m.times(e) and m.squared(e), inlined everywhere: most of what lengths and scores cost.
OCTAFRONT_KERNEL Vec3 times(const Metric& m, Vec3 e) {
  return {m.xx * e.x + m.xy * e.y + m.xz * e.z, m.xy * e.x + m.yy * e.y + m.yz * e.z,
          m.xz * e.x + m.yz * e.y + m.zz * e.z};
}
OCTAFRONT_KERNEL double squared(const Metric& m, Vec3 e) {
  return dot(e, times(m, e));
}

/// Requires a determinant that is not 0.
Metric inverse(const Metric& m);

/// Eigenvalues, and unit eigenvectors that belong to them; in no order. By Jacobi's rotations: the same bits anywhere.
struct Eigen {
  std::array<double, 3> value;
  std::array<Vec3, 3> vector;

  /// The tensor with these values along the vectors.
  Metric tensor() const;
};
Eigen eigen(const Metric& m);

/// The symmetric square root: in its coordinates what fits the metric is regular.
Metric root_of(const Metric& m);
/// s t s, for symmetric s and t.
Metric between(const Metric& s, const Metric& t);

/// The matrix logarithm of a metric, and back: means of metrics are means of their logarithms (V. Arsigny, P. Fillard,
/// X. Pennec, N. Ayache, "Log-Euclidean metrics for fast and simple calculus on diffusion tensors", 2006).
Metric log_of(const Metric& m);
Metric exp_of(const Metric& log);

/// What asks for no longer elements than both, in the directions in which both are diagonal.
Metric intersection(const Metric& a, const Metric& b);

/// Finite, and positive definite.
bool is_metric(const Metric& m);

namespace lengths {
double far_log_mean(double a, double b);
}
/// (a - b) / ln(a / b), what lies between a and b > 0 as the length of an edge does whose ends ask for a and b; a if
/// they are equal. To 1e-12.
OCTAFRONT_KERNEL double log_mean(double a, double b) {
  const double sum = a + b, difference = a - b, s = difference * difference;
  // ln(a / b) = 2 artanh((a - b) / (a + b)).
  if (s > 1e-4 * sum * sum) return lengths::far_log_mean(a, b);
  if (sum == 0) return 0;
  const double u = s / (sum * sum);
  return 0.5 * sum * (1 - u * (1.0 / 3 + u * (4.0 / 45 + u * (44.0 / 945))));
}

/// The length of the edge e in the metrics of its two ends, after the measures of the Unstructured Grid Adaptation
/// Working Group: 1 is what is wanted.
OCTAFRONT_KERNEL double metric_length(Vec3 e, const Metric& a, const Metric& b) {
  return log_mean(std::sqrt(squared(a, e)), std::sqrt(squared(b, e)));
}

/// The area of the triangle between two edges in a metric.
inline double metric_area(const Metric& m, Vec3 u, Vec3 w) {
  const double uw = dot(u, m.times(w));
  return 0.5 * std::sqrt(std::max(m.squared(u) * m.squared(w) - uw * uw, 0.0));
}

/// Edges within these lengths fit the metric; longer ones are split, shorter ones collapsed.
inline constexpr double kLongest = 1.4142135623730951, kShortest = 0.70710678118654757;

/// What the density of a metric, sqrt(det M), makes of a volume of 1: elements of volume sqrt(2) / 12 / density are
/// wanted.
double density_of(const Metric& m);

/// metric_score() by six volumes and the sum of the squared edges.
OCTAFRONT_KERNEL double score_of_sums(double six_volumes, double sum) {
  // 1 for six edges of length 1 and six volumes of 1 / sqrt 2: 6^(3/2) sqrt 2.
  constexpr double kRegular = 20.784609690826528;
  return kRegular * six_volumes / (sum * std::sqrt(sum) + 1e-300);
}
/// The quality of a tetrahedron to the power 3/2: volume over (mean squared edge)^(3/2), both in this metric, 1 for one
/// that is regular there, not positive where it is flat or inverted. The Working Group takes the metric of the corner
/// of greatest density. `six_volumes`: the determinant of its edges.
OCTAFRONT_KERNEL double metric_score(double six_volumes, const Metric& m, double density, Vec3 a, Vec3 b, Vec3 c,
                                     Vec3 d) {
  return score_of_sums(six_volumes * density, squared(m, b - a) + squared(m, c - a) + squared(m, d - a) +
                                                  squared(m, c - b) + squared(m, d - b) + squared(m, d - c));
}
/// The same in a metric of size, which has no say.
OCTAFRONT_KERNEL double metric_score(double six_volumes, Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 e = b - a, f = c - a, g = d - a, h = c - b, i = d - b, j = d - c;
  return score_of_sums(six_volumes, dot(e, e) + dot(f, f) + dot(g, g) + dot(h, h) + dot(i, i) + dot(j, j));
}
/// The quality itself, from that score.
double quality_of_score(double score);

/// The metric in which all six edges of a positive tetrahedron are 1.
Metric implied_metric(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

/// The metric nearest to `to` whose lengths are, in every direction, at most `ratio` times those of `from`; where they
/// are less there is no limit, for what is flat by chance must not ask for small elements. `arrived` becomes true if
/// that is `to` itself.
Metric step_towards(const Metric& from, const Metric& to, double ratio, bool& arrived);

/// The metric nearest to `to` whose lengths are, in every direction, from `least` to `most` times those of `from`;
/// 0 <= least <= 1 <= most.
Metric within(const Metric& from, const Metric& to, double least, double most);

/// Whoever knows the metric everywhere.
class MetricField {
 public:
  virtual ~MetricField() = default;
  /// The metric at p. `hint` tells where a search begins, and is told where this one ended: of a point nearby, or 0.
  /// Safe on any number of threads; depends on the place alone, to rounding.
  virtual Metric at(Vec3 p, std::uint32_t& hint) const = 0;
  /// Whether it asks for the same length in all directions, everywhere.
  virtual bool is_isotropic() const { return false; }
};

/// A size field as metrics.
class SizeMetric : public MetricField {
 public:
  explicit SizeMetric(SizeField sizes) : sizes_(std::move(sizes)) {}
  Metric at(Vec3 p, std::uint32_t&) const override { return Metric::of_size(sizes_.at(p)); }
  bool is_isotropic() const override { return true; }

 private:
  SizeField sizes_;
};

}  // namespace octafront::adapt
