#include "improve/shape.h"

#include "geometry/predicates.h"

// The kernel is plain arithmetic without branches, compiled once for each width of vector unit and chosen at run time.
// All versions give the same bits: no contraction, no reassociation.

namespace octafront::improve {
namespace {

#if defined(__GNUC__)
#define OCTAFRONT_INLINE inline __attribute__((always_inline))
#else
#define OCTAFRONT_INLINE inline
#endif

OCTAFRONT_INLINE double greater(double a, double b) {
  return a > b ? a : b;
}
OCTAFRONT_INLINE double lesser(double a, double b) {
  return a < b ? a : b;
}

constexpr double kTiny = 1e-300;  // keeps flat elements from dividing zero by zero

/// Twice the areas of the four faces of an element, with their inward normals, and what beta is made of.
struct Faces {
  Vec3 na, nb, nc, nd;
  double la, lb, lc, ld;
};

OCTAFRONT_INLINE Faces faces_of_edges(Vec3 u, Vec3 v, Vec3 w) {
  Faces f;
  f.nb = cross(v, w), f.nc = cross(w, u), f.nd = cross(u, v);
  f.na = -(f.nb + f.nc + f.nd);  // area normals of a closed surface sum to zero
  f.la = std::sqrt(squared_length(f.na) + kTiny), f.lb = std::sqrt(squared_length(f.nb) + kTiny);
  f.lc = std::sqrt(squared_length(f.nc) + kTiny), f.ld = std::sqrt(squared_length(f.nd) + kTiny);
  return f;
}

OCTAFRONT_INLINE double beta_of(const Faces& f, Vec3 u, Vec3 v, Vec3 w) {
  const double det = dot(f.nd, w);
  const Vec3 center = squared_length(u) * f.nb + squared_length(v) * f.nc + squared_length(w) * f.nd;
  const double beta =
      6 * det * std::abs(det) / ((f.la + f.lb + f.lc + f.ld) * std::sqrt(squared_length(center) + kTiny));
  // Where the centre of a flat element cancels to nothing, rounding alone decides the quotient.
  return greater(lesser(1, beta), -1);
}

OCTAFRONT_INLINE void shape_of_edges(Vec3 u, Vec3 v, Vec3 w, double& beta, double& small, double& large,
                                     double& quality) {
  const Faces f = faces_of_edges(u, v, w);
  beta = beta_of(f, u, v, w);
  const double ia = 1 / f.la, ib = 1 / f.lb, ic = 1 / f.lc, id = 1 / f.ld;
  const double ab = dot(f.na, f.nb) * (ia * ib), ac = dot(f.na, f.nc) * (ia * ic), ad = dot(f.na, f.nd) * (ia * id),
               bc = dot(f.nb, f.nc) * (ib * ic), bd = dot(f.nb, f.nd) * (ib * id), cd = dot(f.nc, f.nd) * (ic * id);
  // The cosine of a dihedral angle is minus the product of the unit normals.
  // Rounding may take them below zero, and a NaN from their root would pass every comparison.
  small = greater(1 + lesser(lesser(lesser(ab, ac), lesser(ad, bc)), lesser(bd, cd)), 0);
  large = greater(1 - greater(greater(greater(ab, ac), greater(ad, bc)), greater(bd, cd)), 0);
  const double positive = std::sqrt(lesser(beta * beta, lesser(kSmallWeight * small, kLargeWeight * large)));
  quality = beta > 0 ? positive : lesser(beta, 0);
}

OCTAFRONT_INLINE void star_kernel(ShapeBatch& s, Vec3 apex) {
  const int n = s.size;
  for (int i = 0; i < n; ++i) {
    const Vec3 b{s.corner[1][0][i], s.corner[1][1][i], s.corner[1][2][i]};
    const Vec3 c{s.corner[2][0][i], s.corner[2][1][i], s.corner[2][2][i]};
    const Vec3 d{s.corner[3][0][i], s.corner[3][1][i], s.corner[3][2][i]};
    shape_of_edges(b - apex, c - apex, d - apex, s.beta[i], s.small[i], s.large[i], s.quality[i]);
  }
}

OCTAFRONT_INLINE void star_beta_kernel(ShapeBatch& s, Vec3 apex) {
  const int n = s.size;
  for (int i = 0; i < n; ++i) {
    const Vec3 b{s.corner[1][0][i], s.corner[1][1][i], s.corner[1][2][i]};
    const Vec3 c{s.corner[2][0][i], s.corner[2][1][i], s.corner[2][2][i]};
    const Vec3 d{s.corner[3][0][i], s.corner[3][1][i], s.corner[3][2][i]};
    const Vec3 u = b - apex, v = c - apex, w = d - apex;
    s.beta[i] = beta_of(faces_of_edges(u, v, w), u, v, w);
  }
}

OCTAFRONT_INLINE void element_kernel(ShapeBatch& s) {
  const int n = s.size;
  for (int i = 0; i < n; ++i) {
    const Vec3 a{s.corner[0][0][i], s.corner[0][1][i], s.corner[0][2][i]};
    const Vec3 b{s.corner[1][0][i], s.corner[1][1][i], s.corner[1][2][i]};
    const Vec3 c{s.corner[2][0][i], s.corner[2][1][i], s.corner[2][2][i]};
    const Vec3 d{s.corner[3][0][i], s.corner[3][1][i], s.corner[3][2][i]};
    shape_of_edges(b - a, c - a, d - a, s.beta[i], s.small[i], s.large[i], s.quality[i]);
  }
}

struct Kernels {
  void (*star)(ShapeBatch&, Vec3);
  void (*star_beta)(ShapeBatch&, Vec3);
  void (*elements)(ShapeBatch&);
};

void star_plain(ShapeBatch& s, Vec3 apex) {
  star_kernel(s, apex);
}
void star_beta_plain(ShapeBatch& s, Vec3 apex) {
  star_beta_kernel(s, apex);
}
void elements_plain(ShapeBatch& s) {
  element_kernel(s);
}

#if defined(__x86_64__) && defined(__GNUC__)
__attribute__((target("avx2"))) void star_avx2(ShapeBatch& s, Vec3 apex) {
  star_kernel(s, apex);
}
__attribute__((target("avx2"))) void star_beta_avx2(ShapeBatch& s, Vec3 apex) {
  star_beta_kernel(s, apex);
}
__attribute__((target("avx2"))) void elements_avx2(ShapeBatch& s) {
  element_kernel(s);
}

Kernels best_kernels() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) return {star_avx2, star_beta_avx2, elements_avx2};
  return {star_plain, star_beta_plain, elements_plain};
}
#else
Kernels best_kernels() {
  return {star_plain, star_beta_plain, elements_plain};
}
#endif

const Kernels kKernels = best_kernels();

}  // namespace

void ShapeBatch::evaluate_star(Vec3 apex) {
  kKernels.star(*this, apex);
}

void ShapeBatch::evaluate() {
  kKernels.elements(*this);
}

double ShapeBatch::worst() const {
  double least = 1;
  for (int i = 0; i < size; ++i) least = lesser(quality[i], least);
  return least;
}

bool ShapeBatch::star_acceptable(Vec3 apex, const Floor& floor) const {
  for (int i = 0; i < size; ++i) {
    const Shape s = shape(i);
    if (!floor.below(s)) return false;
    if (s.beta >= kCertainBeta) continue;
    const Vec3 b{corner[1][0][i], corner[1][1][i], corner[1][2][i]};
    const Vec3 c{corner[2][0][i], corner[2][1][i], corner[2][2][i]};
    const Vec3 d{corner[3][0][i], corner[3][1][i], corner[3][2][i]};
    if (orient3d(apex, b, c, d) <= 0) return false;
  }
  return true;
}

double ShapeBatch::deficit() const {
  double sum[4] = {0, 0, 0, 0};
  int i = 0;
  for (; i + 4 <= size; i += 4)
    for (int k = 0; k < 4; ++k) sum[k] += (1 - beta[i + k]) * (1 - beta[i + k]);
  for (int k = 0; i < size; ++i, ++k) sum[k] += (1 - beta[i]) * (1 - beta[i]);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

double ShapeBatch::deficit_at(Vec3 apex) {
  kKernels.star_beta(*this, apex);
  return deficit();
}

double ShapeBatch::mean_edge(Vec3 apex) const {
  double sum = 0;
  for (int i = 0; i < size; ++i) sum += distance(apex, {corner[1][0][i], corner[1][1][i], corner[1][2][i]});
  return sum / size;
}

Shape shape_of(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  double beta, small, large, quality;
  shape_of_edges(b - a, c - a, d - a, beta, small, large, quality);
  return {static_cast<float>(beta), static_cast<float>(small), static_cast<float>(large), static_cast<float>(quality)};
}

}  // namespace octafront::improve
