#include "improve/curved/local_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace octafront::curved {

namespace {

// A vertex of a smooth surface lies off the polynomial by a small part of its height over the best plane; one of a
// scan, or beside the end of a fillet, by as much as that. A ball of eighty triangles still passes.
constexpr double kTrust = 0.1;
// What has a higher degree bends the shape, and must not make it: between points that are far from each other such a
// polynomial can be anywhere. So that of degree two must say most of it.
constexpr double kMostByHigher = 0.35;
// Points of flat surfaces scatter by rounding: this part of their distance.
constexpr double kFlatPatch = 1e-9;
// Near points say more, for what the polynomial cannot follow grows with the fifth power of the distance. Where two
// points are nearer than this, in parts of the (squared) distance of near ones, they say as much.
constexpr double kNear = 0.2;
// Directions that the points say nothing of (all on two lines, as on the side of a cylinder from CAD) stay straight.
constexpr double kRegularization = 1e-10;
// So many points per unknown, or a lower degree.
constexpr double kPointsPerUnknown = 1.4;

/// Least squares for `kSides` right-hand sides at once, by normal equations of columns scaled to unit length.
template <std::size_t kMost, std::size_t kSides>
class LeastSquares {
 public:
  explicit LeastSquares(std::size_t unknowns) : n_(unknowns) {}

  void add(const std::array<double, kMost>& row, const std::array<double, kSides>& height, double weight) {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += weight * row[i] * row[j];
      for (std::size_t s = 0; s < kSides; ++s) right_[s][i] += weight * row[i] * height[s];
    }
  }

  std::array<std::array<double, kMost>, kSides> solve() {
    scale();
    factor();
    for (auto& right : right_) substitute(right);
    return right_;
  }

 private:
  void scale() {
    for (std::size_t i = 0; i < n_; ++i) scale_[i] = matrix_[i][i] > 0 ? 1 / std::sqrt(matrix_[i][i]) : 0;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < i; ++j) matrix_[i][j] *= scale_[i] * scale_[j];
      matrix_[i][i] = 1 + kRegularization;
    }
  }
  void factor() {  // Cholesky, in place
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = matrix_[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= matrix_[i][k] * matrix_[j][k];
        matrix_[i][j] = i == j ? std::sqrt(std::max(sum, kRegularization)) : sum / matrix_[j][j];
      }
  }
  void substitute(std::array<double, kMost>& x) const {
    for (std::size_t i = 0; i < n_; ++i) {
      x[i] *= scale_[i];
      for (std::size_t k = 0; k < i; ++k) x[i] -= matrix_[i][k] * x[k];
      x[i] /= matrix_[i][i];
    }
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t k = i + 1; k < n_; ++k) x[i] -= matrix_[k][i] * x[k];
      x[i] /= matrix_[i][i];
    }
    for (std::size_t i = 0; i < n_; ++i) x[i] *= scale_[i];
  }

  std::size_t n_;
  std::array<std::array<double, kMost>, kMost> matrix_{};  // lower triangle
  std::array<std::array<double, kMost>, kSides> right_{};
  std::array<double, kMost> scale_{};
};

/// The terms of the polynomial at a place.
std::array<double, 14> terms(double u, double v) {
  const double uu = u * u, uv = u * v, vv = v * v;
  return {u, v, uu, uv, vv, uu * u, uu * v, u * vv, vv * v, uu * uu, uu * uv, uv * uv, uv * vv, vv * vv};
}
std::array<double, 4> terms(double u) {
  return {u, u * u, u * u * u, u * u * u * u};
}

template <std::size_t N>
double value(const std::array<double, N>& coefficients, const std::array<double, N>& terms) {
  double sum = 0;
  for (std::size_t i = 0; i < N; ++i) sum += coefficients[i] * terms[i];
  return sum;
}

/// How near is near: the harmonic mean of the squared distances, which a few far points do not change.
double near_distance(Vec3 vertex, std::span<const Vec3> points) {
  double sum = 0;
  for (const Vec3 p : points) sum += 1 / std::max(squared_length(p - vertex), std::numeric_limits<double>::min());
  return static_cast<double>(points.size()) / sum;
}

/// What a point says: the terms of the polynomial there, and its heights.
template <std::size_t kTerms, std::size_t kSides>
struct Sample {
  std::array<double, kTerms> terms;
  std::array<double, kSides> heights;
  double nearness, squared_distance;
};

template <std::size_t kTerms, std::size_t kSides>
using Solution = std::array<std::array<double, kTerms>, kSides>;

/// The first `unknowns` terms.
template <std::size_t kTerms, std::size_t kSides>
Solution<kTerms, kSides> solved(std::span<const Sample<kTerms, kSides>> samples, std::size_t unknowns) {
  LeastSquares<kTerms, kSides> system(unknowns);
  for (const auto& s : samples) system.add(s.terms, s.heights, s.nearness * s.nearness);
  return system.solve();
}

/// Weighted sum of squares of what is left over.
template <std::size_t kTerms, std::size_t kSides>
double misfit(std::span<const Sample<kTerms, kSides>> samples, const Solution<kTerms, kSides>& solution) {
  double sum = 0;
  for (const auto& s : samples)
    for (std::size_t side = 0; side < kSides; ++side) {
      const double left = s.heights[side] - value(solution[side], s.terms);
      sum += s.nearness * left * left;
    }
  return sum;
}

/// The polynomial of the highest degree that the points can carry, if it is to be trusted. `unknowns`: of degrees one,
/// two, and so on.
template <std::size_t kTerms, std::size_t kSides, std::size_t kDegrees>
bool fit(std::span<const Sample<kTerms, kSides>> samples, const std::array<std::size_t, kDegrees>& unknowns,
         Solution<kTerms, kSides>& solution) {
  const auto carry = [&](std::size_t n) {
    return static_cast<double>(samples.size()) >= kPointsPerUnknown * static_cast<double>(n);
  };
  if (!carry(unknowns[1])) return false;
  std::size_t degree = kDegrees - 1;
  while (!carry(unknowns[degree])) --degree;
  double rounding = 0;
  for (const auto& s : samples) rounding += s.nearness * s.squared_distance;
  rounding *= kFlatPatch * kFlatPatch;
  const double height = misfit(samples, solved(samples, unknowns[0]));
  if (misfit(samples, solved(samples, unknowns[1])) > kMostByHigher * kMostByHigher * height + rounding) return false;
  solution = solved(samples, unknowns[degree]);
  return misfit(samples, solution) <= kTrust * kTrust * height + rounding;
}

}  // namespace

Vec3 SurfaceFit::at(Vec3 p) const {
  if (!trusted) return p;
  const Vec3 l = frame.local(p);
  return frame.origin + l.x * frame.u + l.y * frame.v + value(coefficient, terms(l.x, l.y)) * frame.n;
}

SurfaceFit fit_surface(Vec3 vertex, Vec3 normal, std::span<const Vec3> around) {
  SurfaceFit made{frame_at(vertex, normal), {}, false};
  const double near = kNear * near_distance(vertex, around);
  std::vector<Sample<14, 1>> samples;
  samples.reserve(around.size());
  for (const Vec3 p : around) {
    const Vec3 l = made.frame.local(p);
    samples.push_back({terms(l.x, l.y), {l.z}, 1 / (squared_length(l) + near), squared_length(l)});
  }
  Solution<14, 1> solution{};
  made.trusted = fit<14, 1, 4>(samples, {2, 5, 9, 14}, solution);
  made.coefficient = solution[0];
  return made;
}

Vec3 CurveFit::at(Vec3 p) const {
  if (!trusted) return p;
  const double u = frame.local(p).x;
  const auto t = terms(u);
  return frame.origin + u * frame.u + value(in_v, t) * frame.v + value(in_n, t) * frame.n;
}

CurveFit fit_curve(Vec3 vertex, Vec3 tangent, std::span<const Vec3> around) {
  const Frame across = frame_at(vertex, tangent);
  CurveFit made{{vertex, tangent, across.u, across.v}, {}, {}, false};
  const double near = kNear * near_distance(vertex, around);
  std::vector<Sample<4, 2>> samples;
  for (const Vec3 p : around) {
    const Vec3 l = made.frame.local(p);
    samples.push_back({terms(l.x), {l.y, l.z}, 1 / (squared_length(l) + near), squared_length(l)});
  }
  Solution<4, 2> solution{};
  made.trusted = fit<4, 2, 4>(samples, {1, 2, 3, 4}, solution);
  made.in_v = solution[0];
  made.in_n = solution[1];
  return made;
}

}  // namespace octafront::curved
