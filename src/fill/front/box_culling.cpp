#include "fill/front/box_culling.h"

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace octafront {

namespace {

/// Four boxes at a time, in what the compiler maps to the vector unit of any x86-64 or arm64.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

Float4 maximum(Float4 a, Float4 b) {
  return a > b ? a : b;
}

unsigned bits_of(Int4 mask) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  return (mask[0] & 1u) | (mask[1] & 2u) | (mask[2] & 4u) | (mask[3] & 8u);
#endif
}

}  // namespace

unsigned cull_boxes_portable(const BoxBlock& boxes, const CullingRegion& region) {
  unsigned hits = 0;
  for (int s = 0; s < BoxBlock::kWidth; s += 4) {
    Int4 overlap = Int4{} - 1;
    Float4 squared{}, height{};
    for (int axis = 0; axis < 3; ++axis) {
      const Float4 lo = *reinterpret_cast<const Float4*>(&boxes.lo[axis][s]);
      const Float4 hi = *reinterpret_cast<const Float4*>(&boxes.hi[axis][s]);
      overlap &= (lo <= region.hi[axis]) & (hi >= region.lo[axis]);
      const Float4 off = maximum(maximum(lo - region.center[axis], region.center[axis] - hi), Float4{});
      squared += off * off;
      height += region.normal[axis] * (region.normal[axis] > 0 ? hi : lo);
    }
    overlap &= (squared <= region.squared_radius) & (height >= region.behind);
    hits |= bits_of(overlap) << s;
  }
  return hits;
}

#ifdef __x86_64__
namespace {

[[gnu::target("avx2")]] unsigned cull_boxes_avx2(const BoxBlock& boxes, const CullingRegion& region) {
  unsigned hits = 0;
  for (int s = 0; s < BoxBlock::kWidth; s += 8) {
    __m256 overlap = _mm256_castsi256_ps(_mm256_set1_epi32(-1)), squared = _mm256_setzero_ps(), height = squared;
    for (int axis = 0; axis < 3; ++axis) {
      const __m256 lo = _mm256_load_ps(&boxes.lo[axis][s]), hi = _mm256_load_ps(&boxes.hi[axis][s]);
      const __m256 center = _mm256_set1_ps(region.center[axis]), normal = _mm256_set1_ps(region.normal[axis]);
      overlap = _mm256_and_ps(overlap, _mm256_cmp_ps(lo, _mm256_set1_ps(region.hi[axis]), _CMP_LE_OQ));
      overlap = _mm256_and_ps(overlap, _mm256_cmp_ps(hi, _mm256_set1_ps(region.lo[axis]), _CMP_GE_OQ));
      const __m256 outside = _mm256_max_ps(_mm256_sub_ps(lo, center), _mm256_sub_ps(center, hi));
      const __m256 off = _mm256_max_ps(outside, _mm256_setzero_ps());
      squared = _mm256_add_ps(squared, _mm256_mul_ps(off, off));
      height = _mm256_add_ps(height, _mm256_mul_ps(normal, region.normal[axis] > 0 ? hi : lo));
    }
    overlap = _mm256_and_ps(overlap, _mm256_cmp_ps(squared, _mm256_set1_ps(region.squared_radius), _CMP_LE_OQ));
    overlap = _mm256_and_ps(overlap, _mm256_cmp_ps(height, _mm256_set1_ps(region.behind), _CMP_GE_OQ));
    hits |= static_cast<unsigned>(_mm256_movemask_ps(overlap)) << s;
  }
  return hits;
}

}  // namespace

const BoxCulling cull_boxes = __builtin_cpu_supports("avx2") ? cull_boxes_avx2 : cull_boxes_portable;
#else
const BoxCulling cull_boxes = cull_boxes_portable;
#endif

}  // namespace octafront
