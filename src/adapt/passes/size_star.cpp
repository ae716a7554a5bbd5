#include "adapt/passes/size_star.h"

#include "adapt/passes/piece.h"
#include "base/core/vector_units.h"
#include "base/geometry/predicates.h"

namespace octafront::adapt {

struct SizeStarKernels {
  static OCTAFRONT_KERNEL Vec3 at(const double (&rows)[3][SizeStar::kRow], std::size_t k) {
    return {rows[0][k], rows[1][k], rows[2][k]};
  }
  static OCTAFRONT_KERNEL void scores(SizeStar& s, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 a = at(s.corner_[0], k), b = at(s.corner_[1], k), c = at(s.corner_[2], k), d = at(s.corner_[3], k);
      s.worth_[k] = metric_score(detail::orient3d_det(a, b, c, d), a, b, c, d);
    }
  }
  static OCTAFRONT_KERNEL void slopes(SizeStar& s, std::size_t n, Vec3 x, double wanted, double pull) {
    for (std::size_t k = 0; k < n; ++k) {
      const Slope of =
          slope_of(RoundMetric{}, 1, wanted, pull, x, at(s.face_[0], k), at(s.face_[1], k), at(s.face_[2], k));
      s.slope_[0][k] = of.gradient.x, s.slope_[1][k] = of.gradient.y, s.slope_[2][k] = of.gradient.z;
      s.slope_[3][k] = of.hessian.xx, s.slope_[4][k] = of.hessian.xy, s.slope_[5][k] = of.hessian.xz;
      s.slope_[6][k] = of.hessian.yy, s.slope_[7][k] = of.hessian.yz, s.slope_[8][k] = of.hessian.zz;
    }
  }
};

namespace {

void scores_plain(SizeStar& s, std::size_t n) {
  SizeStarKernels::scores(s, n);
}
void slopes_plain(SizeStar& s, std::size_t n, Vec3 x, double wanted, double pull) {
  SizeStarKernels::slopes(s, n, x, wanted, pull);
}

#ifdef OCTAFRONT_HAS_AVX2_KERNELS
__attribute__((target("avx2"))) void scores_avx2(SizeStar& s, std::size_t n) {
  SizeStarKernels::scores(s, n);
}
__attribute__((target("avx2"))) void slopes_avx2(SizeStar& s, std::size_t n, Vec3 x, double wanted, double pull) {
  SizeStarKernels::slopes(s, n, x, wanted, pull);
}
const auto scores_kernel = has_avx2() ? scores_avx2 : scores_plain;
const auto slopes_kernel = has_avx2() ? slopes_avx2 : slopes_plain;
#else
const auto scores_kernel = scores_plain;
const auto slopes_kernel = slopes_plain;
#endif

}  // namespace

void SizeStar::add(const std::array<Vec3, 4>& corners, int at) {
  const std::size_t k = size_++;
  at_[k] = at;
  for (std::size_t i = 0; i < 4; ++i)
    corner_[i][0][k] = corners[i].x, corner_[i][1][k] = corners[i].y, corner_[i][2][k] = corners[i].z;
  const Triangle face = face_of({0, 1, 2, 3}, at);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 p = corners[face[i]];
    face_[i][0][k] = p.x, face_[i][1][k] = p.y, face_[i][2][k] = p.z;
  }
}

/// How many to evaluate: the last one again and again until vectors are full.
std::size_t SizeStar::fill_up() {
  const std::size_t n = (size_ + kVector - 1) / kVector * kVector;
  for (std::size_t k = size_; k < n; ++k) {
    for (auto& axes : corner_)
      for (auto& row : axes) row[k] = row[size_ - 1];
    for (auto& axes : face_)
      for (auto& row : axes) row[k] = row[size_ - 1];
  }
  return n;
}

void SizeStar::evaluate(Vec3 at) {
  for (std::size_t k = 0; k < size_; ++k) {
    auto& corner = corner_[at_[k]];
    corner[0][k] = at.x, corner[1][k] = at.y, corner[2][k] = at.z;
  }
  scores_kernel(*this, fill_up());
}

float SizeStar::score(std::size_t k) const {
  return score_by_shape(worth_[k], corner(0, k), corner(1, k), corner(2, k), corner(3, k));
}

Slope SizeStar::slope_at(Vec3 at, double wanted, double pull) {
  slopes_kernel(*this, fill_up(), at, wanted, pull);
  double sum[kSums] = {};
  for (std::size_t k = 0; k < size_; ++k)
    for (std::size_t i = 0; i < kSums; ++i) sum[i] += slope_[i][k];
  return {{sum[0], sum[1], sum[2]}, {sum[3], sum[4], sum[5], sum[6], sum[7], sum[8]}};
}

}  // namespace octafront::adapt
