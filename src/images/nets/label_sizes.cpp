#include "base/core/parallel.h"
#include "images/nets/net_steps.h"

#include <algorithm>

namespace octafront::nets {

LabelSizes::LabelSizes(const Lattice& lattice, std::size_t labels) : voxels(labels, 0), volume(labels, 0) {
  constexpr std::size_t kMostSlabs = 64;
  const auto slices = static_cast<std::size_t>(lattice.size(2));
  const std::size_t slabs = std::min(slices, kMostSlabs);
  struct Slab {
    std::vector<std::uint64_t> voxels;
    std::vector<double> volume;
  };
  std::vector<Slab> of(slabs);
  parallel_for(slabs, [&](std::size_t s) {
    Slab& slab = of[s];
    slab.voxels.assign(labels, 0);
    slab.volume.assign(labels, 0);
    std::vector<std::uint64_t> in_slice(labels);
    for (std::size_t k = slices * s / slabs; k < slices * (s + 1) / slabs; ++k) {
      std::fill(in_slice.begin(), in_slice.end(), 0);
      const auto z = static_cast<std::int32_t>(k);
      for (std::int32_t j = 0; j < lattice.size(1); ++j) {
        const Label* row = lattice.row(j, z);
        for (std::int32_t i = 0; i < lattice.size(0); ++i)
          if (row[i] != LabelImage::kNoRegion) {
            ++in_slice[row[i]];
            if (lattice.is_periodic()) slab.volume[row[i]] += lattice.volume(i, j, z);
          }
      }
      for (std::size_t l = 0; l < labels; ++l) {
        slab.voxels[l] += in_slice[l];
        // Where the image goes on, some layers are halves.
        if (!lattice.is_periodic()) slab.volume[l] += static_cast<double>(in_slice[l]) * lattice.volume(0, 0, z);
      }
    }
  });
  for (const Slab& slab : of)
    for (std::size_t l = 0; l < labels; ++l) {
      voxels[l] += slab.voxels[l];
      volume[l] += slab.volume[l];
    }
}

}  // namespace octafront::nets
