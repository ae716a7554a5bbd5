#include "cad/shapes/nurbs.h"

#include <algorithm>

namespace octafront::cad {

namespace {

/// OpenCASCADE allows no more.
constexpr std::size_t kMostDegree = 25;

/// The basis functions that are not zero at t, with two derivatives: of poles first to first + degree.
struct Basis {
  std::size_t first = 0;
  std::array<std::array<double, kMostDegree + 1>, 3> n{};
};

std::size_t span_of(const Knots& k, double t) {
  const std::size_t poles = k.poles();
  const auto begin = k.knots.begin() + k.degree, end = k.knots.begin() + static_cast<std::ptrdiff_t>(poles);
  const auto above = std::upper_bound(begin, end, t);
  std::size_t span = static_cast<std::size_t>(above - k.knots.begin()) - 1;
  while (span > k.degree && k.knots[span + 1] <= k.knots[span]) --span;  // the end of the last knots
  return span;
}

/// Values of all degrees up to p, as a triangle; derivatives are differences of those of lower degrees.
Basis basis_at(const Knots& k, double t) {
  const std::size_t p = k.degree, span = span_of(k, t);
  Basis basis;
  basis.first = span - p;
  std::array<double, kMostDegree + 2> value{}, below{}, two_below{};
  value[p] = 1;  // place i stands for function span - p + i
  for (std::size_t d = 1; d <= p; ++d) {
    if (d + 1 > p) below = value;
    if (d + 2 > p && d + 1 <= p) two_below = value;
    std::array<double, kMostDegree + 2> next{};
    for (std::size_t i = p - d; i <= p; ++i) {
      const std::size_t j = span - p + i;
      const double left = k.knots[j + d] - k.knots[j], right = k.knots[j + d + 1] - k.knots[j + 1];
      next[i] = (left > 0 ? (t - k.knots[j]) / left * value[i] : 0) +
                (right > 0 ? (k.knots[j + d + 1] - t) / right * value[i + 1] : 0);
    }
    value = next;
  }
  const auto derived = [&](const std::array<double, kMostDegree + 2>& lower, std::size_t degree) {
    std::array<double, kMostDegree + 2> d{};
    for (std::size_t i = 0; i <= p; ++i) {
      const std::size_t j = span - p + i;
      const double left = k.knots[j + degree] - k.knots[j], right = k.knots[j + degree + 1] - k.knots[j + 1];
      d[i] = static_cast<double>(degree) * ((left > 0 ? lower[i] / left : 0) - (right > 0 ? lower[i + 1] / right : 0));
    }
    return d;
  };
  const auto first = derived(below, p);
  std::array<double, kMostDegree + 2> second{};
  if (p >= 2) second = derived(derived(two_below, p - 1), p);
  for (std::size_t i = 0; i <= p; ++i) basis.n[0][i] = value[i], basis.n[1][i] = first[i], basis.n[2][i] = second[i];
  return basis;
}

struct Homogeneous {
  Vec3 p;
  double w = 0;
};

/// From derivatives of p w and w to those of p.
Vec3 quotient(const Homogeneous& a, Vec3 p, double w) {
  return (a.p - a.w * p) / w;
}

}  // namespace

CurveJet jet(const CurveRecord& curve, double t) {
  const Basis b = basis_at(curve.knots, t);
  std::array<Homogeneous, 3> sum{};
  for (std::size_t i = 0; i <= curve.knots.degree; ++i) {
    const double w = curve.weights.empty() ? 1 : curve.weights[b.first + i];
    for (std::size_t d = 0; d < 3; ++d) {
      const double n = b.n[d][i] * w;
      sum[d].p += n * curve.poles[b.first + i], sum[d].w += n;
    }
  }
  const double w = sum[0].w;
  const Vec3 p = sum[0].p / w, d = quotient(sum[1], p, w);
  return {p, d, (sum[2].p - 2 * sum[1].w * d - sum[2].w * p) / w};
}

SurfaceJet jet(const SurfaceRecord& surface, Uv at) {
  const Basis bu = basis_at(surface.u_knots, at.u), bv = basis_at(surface.v_knots, at.v);
  const std::size_t across = surface.v_knots.poles();
  // Sums by (derivatives by u, derivatives by v).
  Homogeneous s00, s10, s01, s20, s11, s02;
  for (std::size_t i = 0; i <= surface.u_knots.degree; ++i) {
    std::array<Homogeneous, 3> row{};
    for (std::size_t j = 0; j <= surface.v_knots.degree; ++j) {
      const std::size_t pole = (bu.first + i) * across + bv.first + j;
      const double w = surface.weights.empty() ? 1 : surface.weights[pole];
      for (std::size_t d = 0; d < 3; ++d) {
        const double n = bv.n[d][j] * w;
        row[d].p += n * surface.poles[pole], row[d].w += n;
      }
    }
    const auto add = [&](Homogeneous& to, std::size_t du, std::size_t dv) {
      to.p += bu.n[du][i] * row[dv].p, to.w += bu.n[du][i] * row[dv].w;
    };
    add(s00, 0, 0), add(s10, 1, 0), add(s01, 0, 1), add(s20, 2, 0), add(s11, 1, 1), add(s02, 0, 2);
  }
  const double w = s00.w;
  SurfaceJet jet;
  jet.p = s00.p / w;
  jet.u = quotient(s10, jet.p, w);
  jet.v = quotient(s01, jet.p, w);
  jet.uu = (s20.p - 2 * s10.w * jet.u - s20.w * jet.p) / w;
  jet.vv = (s02.p - 2 * s01.w * jet.v - s02.w * jet.p) / w;
  jet.uv = (s11.p - s10.w * jet.v - s01.w * jet.u - s11.w * jet.p) / w;
  return jet;
}

}  // namespace octafront::cad
