#pragma once

#include "images/nets/lattice.h"

#include <cstdint>
#include <vector>

namespace octafront::nets {

/// How many voxels each label has, and their volume in straight space.
struct LabelSizes {
  std::vector<std::uint64_t> voxels;
  std::vector<double> volume;

  LabelSizes(const Lattice& lattice, std::size_t labels);
};

}  // namespace octafront::nets
