#pragma once

// For arithmetic without branches that is compiled once for each width of vector unit and chosen at run time. All
// widths give the same bits: no contraction, no reassociation.

/// Of functions that are part of each of the versions.
#if defined(__GNUC__)
#define OCTAFRONT_KERNEL inline __attribute__((always_inline))
#else
#define OCTAFRONT_KERNEL inline
#endif

/// Whether there are versions by __attribute__((target("avx2"))).
#if defined(__x86_64__) && defined(__GNUC__)
#define OCTAFRONT_HAS_AVX2_KERNELS
#endif

namespace octafront {

/// What is to be read soon: memory brings it meanwhile.
OCTAFRONT_KERNEL void fetch_soon([[maybe_unused]] const void* at) {
#if defined(__GNUC__)
  __builtin_prefetch(at);
#endif
}

// What vector units have an instruction for; std::min and std::max take references.
OCTAFRONT_KERNEL double greater(double a, double b) {
  return a > b ? a : b;
}
OCTAFRONT_KERNEL double lesser(double a, double b) {
  return a < b ? a : b;
}

#ifdef OCTAFRONT_HAS_AVX2_KERNELS
inline bool has_avx2() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2");
}
#endif

}  // namespace octafront
