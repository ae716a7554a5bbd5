#include "improve/shape.h"

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

OCTAFRONT_INLINE void shape_of_edges(Vec3 u, Vec3 v, Vec3 w, double& beta, double& small, double& large,
                                     double& quality) {
  // Inward area normals of the faces opposite the four corners; those of a closed surface sum to zero.
  const Vec3 nb = cross(v, w), nc = cross(w, u), nd = cross(u, v), na = -(nb + nc + nd);
  const double det = dot(nd, w);
  constexpr double kTiny = 1e-300;  // keeps flat elements from dividing zero by zero
  const double la = std::sqrt(squared_length(na) + kTiny), lb = std::sqrt(squared_length(nb) + kTiny),
               lc = std::sqrt(squared_length(nc) + kTiny), ld = std::sqrt(squared_length(nd) + kTiny);
  const Vec3 center = squared_length(u) * nb + squared_length(v) * nc + squared_length(w) * nd;
  const double radius = std::sqrt(squared_length(center) + kTiny);
  beta = 6 * det * std::abs(det) / ((la + lb + lc + ld) * radius);
  const double ia = 1 / la, ib = 1 / lb, ic = 1 / lc, id = 1 / ld;
  const double ab = dot(na, nb) * (ia * ib), ac = dot(na, nc) * (ia * ic), ad = dot(na, nd) * (ia * id),
               bc = dot(nb, nc) * (ib * ic), bd = dot(nb, nd) * (ib * id), cd = dot(nc, nd) * (ic * id);
  // The cosine of a dihedral angle is minus the product of the unit normals.
  small = 1 + lesser(lesser(lesser(ab, ac), lesser(ad, bc)), lesser(bd, cd));
  large = 1 - greater(greater(greater(ab, ac), greater(ad, bc)), greater(bd, cd));
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
  void (*elements)(ShapeBatch&);
};

void star_plain(ShapeBatch& s, Vec3 apex) {
  star_kernel(s, apex);
}
void elements_plain(ShapeBatch& s) {
  element_kernel(s);
}

#if defined(__x86_64__) && defined(__GNUC__)
__attribute__((target("avx2"))) void star_avx2(ShapeBatch& s, Vec3 apex) {
  star_kernel(s, apex);
}
__attribute__((target("avx2"))) void elements_avx2(ShapeBatch& s) {
  element_kernel(s);
}

Kernels best_kernels() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) return {star_avx2, elements_avx2};
  return {star_plain, elements_plain};
}
#else
Kernels best_kernels() {
  return {star_plain, elements_plain};
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

Floor ShapeBatch::floor() const {
  Floor f;
  for (int i = 0; i < size; ++i) f.add(shape(i));
  return f;
}

Shape shape_of(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  double beta, small, large, quality;
  shape_of_edges(b - a, c - a, d - a, beta, small, large, quality);
  return {static_cast<float>(beta), static_cast<float>(small), static_cast<float>(large), static_cast<float>(quality)};
}

}  // namespace octafront::improve
