#include "adapt/metric/metric.h"

#include "base/core/elementary.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octafront::adapt {
namespace {

/// Jacobi's method squares what is off the diagonal with each sweep.
constexpr int kMostSweeps = 30;

using Matrix = std::array<std::array<double, 3>, 3>;

/// One rotation that makes a[p][q] vanish; the columns of `v` turn along.
void rotate(Matrix& a, Matrix& v, int p, int q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = std::isfinite(theta * theta)
                       ? (theta < 0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1))
                       : 0.5 / theta;
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  const int r = 3 - p - q;
  const double apq = a[p][q], arp = a[r][p], arq = a[r][q];
  a[p][p] -= t * apq, a[q][q] += t * apq;
  a[p][q] = a[q][p] = 0;
  a[r][p] = a[p][r] = c * arp - s * arq;
  a[r][q] = a[q][r] = s * arp + c * arq;
  for (auto& row : v) {
    const double vp = row[p], vq = row[q];
    row[p] = c * vp - s * vq, row[q] = s * vp + c * vq;
  }
}

template <class Function>
Metric with_values(const Metric& m, const Function& function) {
  Eigen e = eigen(m);
  for (double& value : e.value) value = function(value);
  return e.tensor();
}

/// `to` with limits on its values in the coordinates in which `from` is 1; itself if they change nothing.
template <class Limited>
Metric limited(const Metric& from, const Metric& to, bool& same, const Limited& limited) {
  const Metric root = root_of(from);
  Eigen change = eigen(between(inverse(root), to));
  same = true;
  for (double& value : change.value) {
    const double had = std::exchange(value, limited(value));
    same &= value == had;
  }
  return same ? to : between(root, change.tensor());
}

}  // namespace

Metric root_of(const Metric& m) {
  return with_values(m, [](double x) { return std::sqrt(std::max(x, 1e-300)); });
}

Metric between(const Metric& s, const Metric& t) {
  const std::array<Vec3, 3> columns{{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
  const auto entry = [&](std::size_t i, std::size_t j) { return dot(columns[i], t.times(columns[j])); };
  return {entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)};
}

Metric inverse(const Metric& m) {
  const double d = 1 / m.determinant();
  return {d * (m.yy * m.zz - m.yz * m.yz), d * (m.xz * m.yz - m.xy * m.zz), d * (m.xy * m.yz - m.xz * m.yy),
          d * (m.xx * m.zz - m.xz * m.xz), d * (m.xy * m.xz - m.xx * m.yz), d * (m.xx * m.yy - m.xy * m.xy)};
}

Metric Eigen::tensor() const {
  Metric m{0, 0, 0, 0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    const Vec3 v = vector[i];
    m = m + value[i] * Metric{v.x * v.x, v.x * v.y, v.x * v.z, v.y * v.y, v.y * v.z, v.z * v.z};
  }
  return m;
}

Eigen eigen(const Metric& m) {
  Matrix a{{{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}}};
  Matrix v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < kMostSweeps && (a[0][1] != 0 || a[0][2] != 0 || a[1][2] != 0); ++sweep)
    for (const auto& [p, q] : {std::array{0, 1}, std::array{0, 2}, std::array{1, 2}}) {
      // What is less than the rounding of both values does not count.
      if (std::abs(a[p][q]) <= 1e-17 * std::sqrt(std::abs(a[p][p] * a[q][q]))) a[p][q] = a[q][p] = 0;
      rotate(a, v, p, q);
    }
  Eigen e;
  for (int i = 0; i < 3; ++i) e.value[i] = a[i][i], e.vector[i] = {v[0][i], v[1][i], v[2][i]};
  return e;
}

Metric log_of(const Metric& m) {
  return with_values(m, [](double x) { return elementary::log(std::max(x, 1e-300)); });
}
Metric exp_of(const Metric& log) {
  return with_values(log, [](double x) { return elementary::exp(x); });
}

Metric intersection(const Metric& a, const Metric& b) {
  const Metric root = root_of(a);
  Eigen change = eigen(between(inverse(root), b));
  bool is_within = true, is_finer = true;
  for (double& value : change.value) {
    is_within &= value <= 1;
    is_finer &= value >= 1;
    value = std::max(value, 1.0);
  }
  // Exactly one of them where it is finer everywhere: what is done twice changes nothing then.
  return is_within ? a : is_finer ? b : between(root, change.tensor());
}

bool is_metric(const Metric& m) {
  const bool is_positive = m.xx > 0 && m.xx * m.yy - m.xy * m.xy > 0 && m.determinant() > 0;
  return is_positive && std::isfinite(m.determinant()) && std::isfinite(m.xx + m.yy + m.zz + m.xy + m.xz + m.yz);
}

double lengths::far_log_mean(double a, double b) {
  const double u = (a - b) / (a + b), s = u * u;
  if (s < 0.03) {
    const double series =
        1 + s * (1.0 / 3 + s * (1.0 / 5 + s * (1.0 / 7 + s * (1.0 / 9 + s * (1.0 / 11 + s * (1.0 / 13 + s / 15))))));
    return 0.5 * (a + b) / series;
  }
  if (a == 0 || b == 0) return 0;
  return (a - b) / elementary::log(a / b);
}

Metric implied_metric(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double volume = dot(cross(u, v), w);
  const Vec3 p = cross(v, w) / volume, q = cross(w, u) / volume, r = cross(u, v) / volume, sum = p + q + r;
  // Edges of the regular tetrahedron at one corner have products of 1 and of 1/2.
  const auto entry = [&](int i, int j) { return 0.5 * (p[i] * p[j] + q[i] * q[j] + r[i] * r[j] + sum[i] * sum[j]); };
  return {entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)};
}

Metric step_towards(const Metric& from, const Metric& to, double ratio, bool& arrived) {
  return limited(from, to, arrived, [most = ratio * ratio](double value) { return std::min(value, most); });
}

Metric within(const Metric& from, const Metric& to, double least, double most) {
  bool same = true;
  // Squared lengths of `from` over those of `to`.
  return limited(from, to, same, [=](double value) {
    return std::clamp(value, 1 / (most * most), least > 0 ? 1 / (least * least) : HUGE_VAL);
  });
}

double density_of(const Metric& m) {
  return std::sqrt(std::max(m.determinant(), 0.0));
}

double quality_of_score(double score) {
  if (!(score > 0)) return 0;
  const double root = elementary::cbrt(score);
  return root * root;
}

}  // namespace octafront::adapt
