#include "surface/edits/blocks.h"

#include "base/core/validate.h"
#include "base/geometry/spatial_order.h"

#include <algorithm>

namespace octafront::remeshing {

namespace {

constexpr std::uint32_t kLeastBlock = 4096;  ///< vertices: below this much of a block is its rim
constexpr std::uint32_t kMostBlocks = 256;

}  // namespace

SurfaceBlocks::SurfaceBlocks(const WorkingMesh& mesh) : mesh_(&mesh), rank_(mesh.points.size()) {
  const std::vector<VertexIndex> order = spatial_order(mesh.points);
  parallel_for(order.size(), [&](std::size_t k) { rank_[order[k]] = static_cast<std::uint32_t>(k); });
  const auto n = static_cast<std::uint32_t>(rank_.size());
  // Validation looks at what lies beside a change too.
  size_ = kValidate ? n + 1 : std::max(kLeastBlock, n / kMostBlocks + 1);
}

bool SurfaceBlocks::Block::has_star(VertexIndex v) const {
  if (stage + 1 == kStages) return true;
  bool all = has(v);
  blocks.mesh_->for_each_outgoing(v, [&](HalfEdge h) { all = all && has(blocks.mesh_->end(h)); });
  return all;
}

bool SurfaceBlocks::Block::has_both(HalfEdge h) const {
  if (stage + 1 == kStages) return true;
  const WorkingMesh& m = *blocks.mesh_;
  return has(m.start[h]) && has(m.end(h)) && has(m.apex(h)) && has(m.apex(m.twin[h]));
}

}  // namespace octafront::remeshing
