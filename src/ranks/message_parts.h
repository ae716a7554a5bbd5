#pragma once

// ranks: MPI behind the interface Ranks (octafront/mpi.h), in a library of its own.

#include <algorithm>
#include <cstddef>

namespace octafront {

/// Calls send(first, count) for parts of a message of so many bytes.
template <class Send>
void in_parts(std::size_t bytes, std::size_t most, const Send& send) {
  for (std::size_t first = 0; first < bytes; first += most)
    send(first, static_cast<int>(std::min(most, bytes - first)));
}

}  // namespace octafront
