#pragma once

// Which way a vertex has to go for its elements to lack less.

#include "adapt/metric/metric.h"
#include "base/core/vector_units.h"
#include "base/geometry/measures.h"

#include <cmath>

namespace octafront::adapt {

/// The unit tensor, which costs nothing.
struct RoundMetric {};
OCTAFRONT_KERNEL Vec3 times(const RoundMetric&, Vec3 e) {
  return e;
}
OCTAFRONT_KERNEL double squared(const RoundMetric&, Vec3 e) {
  return dot(e, e);
}
OCTAFRONT_KERNEL Metric tensor_of(const RoundMetric&) {
  return {};
}
OCTAFRONT_KERNEL const Metric& tensor_of(const Metric& m) {
  return m;
}

/// Slope and curvature of what an element lacks, 1 / score - 1, times kScale, as its vertex moves.
struct Slope {
  /// What S^(3/2) / D is for a regular element: see slope_of().
  static constexpr double kScale = 20.784609690826528;

  Vec3 gradient{};
  Metric hessian{0, 0, 0, 0, 0, 0};

  void operator+=(const Slope& o) { gradient += o.gradient, hessian = hessian + o.hessian; }
};

/// Of the element with the corners x, a, b, c. With S the sum of squared edges and D the six volumes, both in the
/// metric `m` of this density, 1 / score is S^(3/2) / D times a constant; D is linear. A volume that is not as
/// `wanted`, a density, is worth `pull` of D + 1 / D - 2. `M`: Metric, or RoundMetric.
template <class M>
OCTAFRONT_KERNEL Slope slope_of(const M& m, double density, double wanted, double pull, Vec3 x, Vec3 a, Vec3 b,
                                Vec3 c) {
  constexpr double kSqrt2 = 1.4142135623730951;
  const Vec3 xa = x - a, xb = x - b, xc = x - c, ba = b - a, ca = c - a, cb = c - b;
  const double sum =
      squared(m, xa) + squared(m, xb) + squared(m, xc) + squared(m, ba) + squared(m, ca) + squared(m, cb);
  const Vec3 n = -density * cross(ba, ca), g = 2.0 * times(m, 3.0 * x - (a + b + c));
  const double d = 1 / dot(n, xa), root = std::sqrt(sum), f = sum * root * d;
  // f' = f (3/2 g / S - n / D), f'' = f (9 M / S + 3/4 g g' / S^2 - 3/2 (g n' + n g') / (S D) + 2 n n' / D^2).
  const Vec3 u = (1 / sum) * g, w = d * n;
  // Of D + 1 / D, with D = 1 as is wanted: f' = (D - 1 / D) w, f'' = 2 / D w w'.
  const double size = kSqrt2 * wanted / d, of_size = pull * Slope::kScale;
  const double ww = 2 * (f + of_size / size), mm = 9 * f / sum;
  const Metric t = tensor_of(m);
  const double uu = 0.75 * f, uw = -1.5 * f;
  return {f * (1.5 * u - w) + of_size * (size - 1 / size) * w,
          {mm * t.xx + uu * u.x * u.x + 2 * uw * u.x * w.x + ww * w.x * w.x,
           mm * t.xy + uu * u.x * u.y + uw * (u.x * w.y + w.x * u.y) + ww * w.x * w.y,
           mm * t.xz + uu * u.x * u.z + uw * (u.x * w.z + w.x * u.z) + ww * w.x * w.z,
           mm * t.yy + uu * u.y * u.y + 2 * uw * u.y * w.y + ww * w.y * w.y,
           mm * t.yz + uu * u.y * u.z + uw * (u.y * w.z + w.y * u.z) + ww * w.y * w.z,
           mm * t.zz + uu * u.z * u.z + 2 * uw * u.z * w.z + ww * w.z * w.z}};
}

}  // namespace octafront::adapt
