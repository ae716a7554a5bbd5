#include "base/core/freed_memory.h"

#include <cstddef>
#include <cstdlib>  // which tells of glibc

#ifdef __GLIBC__
#include <malloc.h>
#if __GLIBC_PREREQ(2, 33)
#define OCTAFRONT_KNOWS_FREED_MEMORY
#endif
#endif

namespace octafront {

void return_freed_memory() {
#ifdef OCTAFRONT_KNOWS_FREED_MEMORY
  // Pages that come back are cleared anew: less than this costs more time than it is worth.
  constexpr std::size_t kWorthIt = std::size_t{128} << 20;
  if (mallinfo2().fordblks > kWorthIt) malloc_trim(0);
#endif
}

}  // namespace octafront
