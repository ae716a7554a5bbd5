#include "improve/shuffle.h"

#include <utility>

namespace octafront::improve {

void SlotShuffle::operator()(MeshOfPieces& mesh) {
  constexpr std::size_t kFree = 10;
  for (std::size_t k = 0; k < kFree; ++k) {
    mesh.tets_.push_back({kNone, kNone, kNone, kNone});
    if (mesh.has_regions_) mesh.region_.push_back(0);
    if (mesh.remembers_) mesh.origin_.came.push_back(0);
  }
  for (std::size_t k = mesh.tets_.size(); k > 1; --k) {
    const std::size_t other = random_.below(k);
    std::swap(mesh.tets_[k - 1], mesh.tets_[other]);
    if (mesh.has_regions_) std::swap(mesh.region_[k - 1], mesh.region_[other]);
    if (mesh.remembers_) std::swap(mesh.origin_.came[k - 1], mesh.origin_.came[other]);
  }
}

}  // namespace octafront::improve
