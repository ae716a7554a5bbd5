#include "surface/edits/surface_blocks.h"

#include "base/core/validate.h"

namespace octafront::surface {

namespace {

constexpr std::size_t kMostOfBlock = 8192;  ///< vertices: with few much of a block is its rim

}  // namespace

SurfaceBlocks::SurfaceBlocks(const WorkingMesh& mesh) : mesh_(&mesh) {
  // Validation looks at what lies beside a change too.
  if (kValidate || mesh.points.size() <= kMostOfBlock) {
    first_stage_ = kCellStages;
    return;
  }
  Box3 box;
  for (const Vec3& p : mesh.points) box.add(p);
  for (int stage = 0; stage < kCellStages; ++stage)
    cells_[stage] = cells_of(mesh.points, cube_of_stage(box, stage), kMostOfBlock);
}

bool SurfaceBlocks::Block::has_star(VertexIndex v) const {
  if (stage == kCellStages) return true;
  bool all = has(v);
  blocks.mesh_->for_each_outgoing(v, [&](HalfEdge h) { all = all && has(blocks.mesh_->end(h)); });
  return all;
}

bool SurfaceBlocks::Block::has_both(HalfEdge h) const {
  if (stage == kCellStages) return true;
  const WorkingMesh& m = *blocks.mesh_;
  return has(m.start[h]) && has(m.end(h)) && has(m.apex(h)) && has(m.apex(m.twin[h]));
}

}  // namespace octafront::surface
