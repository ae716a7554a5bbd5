#include "improve/passes/vertex_blocks.h"

namespace octafront::improve {

VertexBlocks::VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t> marks) {
  const auto n = static_cast<VertexIndex>(mesh.vertices());
  std::vector<std::vector<VertexIndex>> blocks(mesh.cells(0).count);
  std::vector<VertexIndex> waiting;
  for (VertexIndex v = 0; v < n; ++v) {
    if (mesh.on_boundary(v) && !(guide && guide->may_slide(v))) marks[v] &= ~kWorked;
    if (marks[v] & kWorked) (marks[v] & kAtRim ? waiting : blocks[mesh.cells(0).of[v]]).push_back(v);
  }
  stages_.push_back(std::move(blocks));
  stars_ = group_by_owner(n, static_cast<HalfFace>(4 * mesh.slots()), [&](HalfFace h) {
    const VertexIndex v = mesh.tet(h / 4)[h % 4];
    return mesh.alive(h / 4) && (marks[v] & kWorked) ? v : kNoOwner;
  });
  parallel_for(n, [&](std::size_t v) { mesh.sort_star(stars_[v]); });
  std::vector<std::uint8_t> waits(n, 0);
  for (const VertexIndex v : waiting) waits[v] = 1;
  for (int stage = 1; stage < kCellStages && !waiting.empty(); ++stage) divide(mesh, stage, waiting, waits);
  stages_.push_back({std::move(waiting)});
}

void VertexBlocks::divide(const EditMesh& mesh, int stage, std::vector<VertexIndex>& waiting,
                          std::vector<std::uint8_t>& waits) {
  const Cells& cells = mesh.cells(stage);
  const ItemsByCell<VertexIndex> by_cell(std::span<const VertexIndex>(waiting), cells.count, [&](VertexIndex v) {
    const bool at_rim = std::ranges::any_of(star(v), [&](HalfFace h) {
      return std::ranges::any_of(mesh.tet(h / 4),
                                 [&](VertexIndex u) { return waits[u] && cells.of[u] != cells.of[v]; });
    });
    return at_rim ? kNoOwner : cells.of[v];
  });
  std::vector<std::vector<VertexIndex>> blocks(cells.count);
  for (std::uint32_t c = 0; c < cells.count; ++c) {
    blocks[c].assign(by_cell[c].begin(), by_cell[c].end());
    for (const VertexIndex v : blocks[c]) waits[v] = 0;
  }
  stages_.push_back(std::move(blocks));
  waiting.assign(by_cell.left().begin(), by_cell.left().end());
}

}  // namespace octafront::improve
