#include "base/core/system_memory.h"

#include "base/core/parallel.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>  // which tells of glibc

#ifdef __GLIBC__
#include <malloc.h>
#if __GLIBC_PREREQ(2, 33)
#define OCTAFRONT_KNOWS_FREED_MEMORY
#endif
#endif
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace octafront {

void return_freed_memory() {
#ifdef OCTAFRONT_KNOWS_FREED_MEMORY
  // Pages that come back are cleared anew: less than this costs more time than it is worth.
  constexpr std::size_t kWorthIt = std::size_t{512} << 20;
  if (mallinfo2().fordblks > kWorthIt) malloc_trim(0);
#endif
}

void take_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
  constexpr std::size_t kAtOnce = std::size_t{1} << 20, kLargestPage = std::size_t{1} << 16;
  if (bytes < kAtOnce) return;
  const std::size_t before = kLargestPage - reinterpret_cast<std::uintptr_t>(begin) % kLargestPage;
  char* const first = static_cast<char*>(begin) + before;
  bytes -= before;
  parallel_for(
      (bytes + kAtOnce - 1) / kAtOnce,
      [&](std::size_t i) { madvise(first + i * kAtOnce, std::min(kAtOnce, bytes - i * kAtOnce), MADV_POPULATE_WRITE); },
      Split::kSingly);
#endif
}

}  // namespace octafront
