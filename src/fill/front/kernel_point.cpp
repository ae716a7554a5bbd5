#include "fill/front/kernel_point.h"

#include "base/core/random.h"

#include <algorithm>
#include <array>

namespace octafront {

namespace {

/// Constraints violated by less than this (coordinates are scaled to the unit box) are taken to hold: the incremental
/// algorithm would otherwise chase rounding errors of points that lie on them by construction.
constexpr double kSlack = 1e-12;
/// A programme is given up only if the last of its variables misses by more than this: what rounding may leave after
/// three eliminations, each of which divides by a coefficient. Wrong by less, an answer is still looked at by exact
/// predicates; a kernel that is not found is lost.
constexpr double kMiss = 1e-9;

template <int D>
using Vector = std::array<double, D>;

template <int D>
double inner(const Vector<D>& a, const Vector<D>& b) {
  double s = 0;
  for (int i = 0; i < D; ++i) s += a[i] * b[i];
  return s;
}

/// a . x <= b.
template <int D>
struct Constraint {
  Vector<D> a;
  double b;
};

/// Maximises c . x subject to the constraints, of which the first 2 D must bound x. False if there is no such x.
template <int D>
bool maximise(const std::vector<Constraint<D>>& constraints, const Vector<D>& c, Vector<D>& x);

template <>
bool maximise<1>(const std::vector<Constraint<1>>& constraints, const Vector<1>& c, Vector<1>& x) {
  double lo = -1e300, hi = 1e300;
  for (const auto& k : constraints) {
    if (k.a[0] > kSlack)
      hi = std::min(hi, k.b / k.a[0]);
    else if (k.a[0] < -kSlack)
      lo = std::max(lo, k.b / k.a[0]);
    else if (k.b < -kMiss)
      return false;
  }
  if (lo > hi + kMiss) return false;
  x[0] = c[0] >= 0 ? hi : lo;
  return true;
}

template <int D>
bool maximise(const std::vector<Constraint<D>>& constraints, const Vector<D>& c, Vector<D>& x) {
  // The optimum over the first 2 D constraints, an axis-parallel box: a_i = +e_k at 2 k, -e_k at 2 k + 1.
  std::size_t begin = 0;
  for (int k = 0; k < D; ++k)
    x[k] = c[k] >= 0 ? constraints[2 * k].b / constraints[2 * k].a[k]
                     : constraints[2 * k + 1].b / constraints[2 * k + 1].a[k];
  begin = 2 * D;
  for (std::size_t i = begin; i < constraints.size(); ++i) {
    const auto& tight = constraints[i];
    if (inner<D>(tight.a, x) <= tight.b + kSlack) continue;
    // The new optimum lies on the plane of this constraint: eliminate the variable with the largest coefficient.
    int gone = 0;
    for (int k = 1; k < D; ++k)
      if (std::abs(tight.a[k]) > std::abs(tight.a[gone])) gone = k;
    if (std::abs(tight.a[gone]) < kSlack) return false;
    const auto reduce = [&](const Vector<D>& a, double factor) {
      Vector<D - 1> r;
      for (int k = 0, j = 0; k < D; ++k)
        if (k != gone) r[j++] = a[k] - factor * tight.a[k];
      return r;
    };
    std::vector<Constraint<D - 1>> lower;
    lower.reserve(i);
    const auto add = [&](const Constraint<D>& k) {
      const double factor = k.a[gone] / tight.a[gone];
      lower.push_back({reduce(k.a, factor), k.b - factor * tight.b});
    };
    for (int k = 0; k < D; ++k)
      if (k != gone) add(constraints[2 * k]), add(constraints[2 * k + 1]);
    add(constraints[2 * gone]);
    add(constraints[2 * gone + 1]);
    for (std::size_t j = begin; j < i; ++j) add(constraints[j]);
    Vector<D - 1> y;
    if (!maximise<D - 1>(lower, reduce(c, c[gone] / tight.a[gone]), y)) return false;
    double rest = tight.b;
    for (int k = 0, j = 0; k < D; ++k)
      if (k != gone) x[k] = y[j++], rest -= tight.a[k] * x[k];
    x[gone] = rest / tight.a[gone];
  }
  return true;
}

}  // namespace

KernelPoint deepest_point(const std::vector<HalfSpace>& planes, const Box3& box) {
  const Vec3 middle = box.center(), e = box.extent();
  const double half = std::max({e.x, e.y, e.z}) / 2;
  if (!(half > 0)) return {middle, 0};
  // Unknowns: position in the box scaled to [-1, 1]^3, and depth.
  std::vector<Constraint<4>> constraints;
  constraints.reserve(planes.size() + 8);
  for (int k = 0; k < 4; ++k) {
    const double bound = k < 3 ? e[k] / (2 * half) : 4;
    Vector<4> a{};
    a[k] = 1;
    constraints.push_back({a, bound});
    a[k] = -1;
    constraints.push_back({a, bound});
  }
  for (const HalfSpace& p : planes)
    constraints.push_back({{-p.n.x, -p.n.y, -p.n.z, 1}, (dot(p.n, middle) - p.d) / half});
  Random random(0x2545f4914f6cdd1d);
  for (std::size_t i = constraints.size(); i > 9; --i)
    std::swap(constraints[i - 1], constraints[8 + random.below(i - 8)]);
  Vector<4> x{};
  if (!maximise<4>(constraints, {0, 0, 0, 1}, x)) return {middle, -half};
  KernelPoint result{middle + Vec3{x[0], x[1], x[2]} * half, std::numeric_limits<double>::infinity()};
  for (const HalfSpace& p : planes) result.depth = std::min(result.depth, dot(p.n, result.at) - p.d);
  return result;
}

}  // namespace octafront
