#include "curved/local_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>

namespace octafront::curved {

namespace {

// A vertex of a smooth surface lies off the polynomial by a small part of the height of the surface's own curvature;
// one of a scan, or beside the end of a fillet, by as much as that. A ball of forty triangles still passes.
constexpr double kTrust = 0.1;
// Points of flat surfaces scatter by rounding: this part of their distance.
constexpr double kFlat = 1e-9;
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

/// Unknowns of the highest degree that so many points can carry, of those given from high to low; 0: not even a plane.
std::size_t affordable(std::size_t points, std::initializer_list<std::size_t> unknowns) {
  for (const std::size_t n : unknowns)
    if (static_cast<double>(points) >= kPointsPerUnknown * static_cast<double>(n)) return n;
  return 0;
}

/// How near is near: the harmonic mean of the squared distances, which a few far points do not change.
double near_distance(Vec3 vertex, std::span<const Vec3> points) {
  double sum = 0;
  for (const Vec3 p : points) sum += 1 / std::max(squared_length(p - vertex), std::numeric_limits<double>::min());
  return static_cast<double>(points.size()) / sum;
}

/// What is left over, against the part of the heights that is not linear; both weighted sums of squares.
struct Misfit {
  double left = 0, curved = 0, reach = 0;
  bool is_small() const { return left <= std::max(kTrust * kTrust * curved, kFlat * kFlat * reach); }
};

}  // namespace

Frame frame_at(Vec3 origin, Vec3 normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  const Vec3 least = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 u = normalized(cross(normal, least));
  return {origin, u, cross(normal, u), normal};
}

Vec3 SurfaceFit::at(Vec3 p) const {
  if (!trusted) return p;
  const Vec3 l = frame.local(p);
  return frame.origin + l.x * frame.u + l.y * frame.v + value(coefficient, terms(l.x, l.y)) * frame.n;
}

SurfaceFit fit_surface(Vec3 vertex, Vec3 normal, std::span<const Vec3> around) {
  SurfaceFit fit{frame_at(vertex, normal), {}, false};
  const std::size_t unknowns = affordable(around.size(), {14, 9, 5});
  if (unknowns == 0) return fit;
  const double near = near_distance(vertex, around);
  const auto nearness = [&](Vec3 p) { return 1 / (squared_length(p - vertex) + kNear * near); };
  LeastSquares<14, 1> system(unknowns);
  for (const Vec3 p : around) {
    const Vec3 l = fit.frame.local(p);
    system.add(terms(l.x, l.y), {l.z}, nearness(p) * nearness(p));
  }
  fit.coefficient = system.solve()[0];
  Misfit misfit;
  for (const Vec3 p : around) {
    const Vec3 l = fit.frame.local(p);
    const double w = nearness(p), left = l.z - value(fit.coefficient, terms(l.x, l.y)),
                 curved = l.z - fit.coefficient[0] * l.x - fit.coefficient[1] * l.y;
    misfit.left += w * left * left;
    misfit.curved += w * curved * curved;
    misfit.reach += w * squared_length(l);
  }
  fit.trusted = misfit.is_small();
  return fit;
}

Vec3 CurveFit::at(Vec3 p) const {
  if (!trusted) return p;
  const double u = frame.local(p).x;
  const auto t = terms(u);
  return frame.origin + u * frame.u + value(in_v, t) * frame.v + value(in_n, t) * frame.n;
}

CurveFit fit_curve(Vec3 vertex, Vec3 tangent, std::span<const Vec3> around) {
  const Frame across = frame_at(vertex, tangent);
  CurveFit fit{{vertex, tangent, across.u, across.v}, {}, {}, false};
  const std::size_t unknowns = affordable(around.size(), {4, 3, 2});
  if (unknowns == 0) return fit;
  const double near = near_distance(vertex, around);
  const auto nearness = [&](Vec3 p) { return 1 / (squared_length(p - vertex) + kNear * near); };
  LeastSquares<4, 2> system(unknowns);
  for (const Vec3 p : around) {
    const Vec3 l = fit.frame.local(p);
    system.add(terms(l.x), {l.y, l.z}, nearness(p) * nearness(p));
  }
  const auto solution = system.solve();
  fit.in_v = solution[0];
  fit.in_n = solution[1];
  Misfit misfit;
  for (const Vec3 p : around) {
    const Vec3 l = fit.frame.local(p);
    const auto t = terms(l.x);
    const double w = nearness(p), left_v = l.y - value(fit.in_v, t), left_n = l.z - value(fit.in_n, t);
    const double curved_v = l.y - fit.in_v[0] * l.x, curved_n = l.z - fit.in_n[0] * l.x;
    misfit.left += w * (left_v * left_v + left_n * left_n);
    misfit.curved += w * (curved_v * curved_v + curved_n * curved_n);
    misfit.reach += w * squared_length(l);
  }
  fit.trusted = misfit.is_small();
  return fit;
}

}  // namespace octafront::curved
