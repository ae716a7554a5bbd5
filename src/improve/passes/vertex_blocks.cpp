#include "improve/passes/vertex_blocks.h"

#include <algorithm>

namespace octafront::improve {

VertexBlocks::VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t> marks) {
  std::vector<VertexIndex> waiting = start(mesh, guide, marks);
  stars_ = group_by_owner(marks.size(), static_cast<HalfFace>(4 * mesh.slots()), [&](HalfFace h) {
    const VertexIndex v = mesh.tet(h / 4)[h % 4];
    return mesh.alive(h / 4) && (marks[v] & kWorked) ? v : kNoOwner;
  });
  parallel_for(marks.size(), [&](std::size_t v) { mesh.sort_star(stars_[v]); });
  std::vector<std::uint8_t> waits(marks.size(), 0);
  parallel_for(waiting.size(), [&](std::size_t k) { waits[waiting[k]] = 1; });
  for (int stage = 1; stage < kCellStages && !waiting.empty(); ++stage) divide(mesh, stage, waiting, waits);
  stages_.push_back({std::move(waiting)});
}

std::vector<VertexIndex> VertexBlocks::start(const EditMesh& mesh, const BoundaryGuide* guide,
                                             std::vector<std::uint8_t>& marks) {
  const Cells& cells = mesh.cells(0);
  std::vector<std::vector<VertexIndex>> blocks(cells.count), at_rim(cells.count);
  const auto add = [&](VertexIndex v) {
    if (mesh.on_boundary(v) && !(guide && guide->may_slide(v))) marks[v] &= ~kWorked;
    if (marks[v] & kWorked) (marks[v] & kAtRim ? at_rim : blocks)[cells.of[v]].push_back(v);
  };
  const auto taken = std::span(cells.of).first(mesh.vertices_taken());
  const auto first = [&](std::size_t cell) {
    return static_cast<VertexIndex>(std::ranges::lower_bound(taken, cell) - taken.begin());
  };
  parallel_for(cells.count, [&](std::size_t c) {
    for (VertexIndex v = first(c), end = first(c + 1); v < end; ++v) add(v);
  });
  for (auto v = static_cast<VertexIndex>(taken.size()); v < mesh.vertices(); ++v) add(v);
  stages_.push_back(std::move(blocks));
  std::vector<VertexIndex> waiting;
  for (const std::vector<VertexIndex>& some : at_rim) waiting.insert(waiting.end(), some.begin(), some.end());
  return waiting;
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
  parallel_for(cells.count, [&](std::size_t c) {
    const std::span<const VertexIndex> block = by_cell[static_cast<std::uint32_t>(c)];
    blocks[c].assign(block.begin(), block.end());
    for (const VertexIndex v : block) waits[v] = 0;
  });
  stages_.push_back(std::move(blocks));
  waiting.assign(by_cell.left().begin(), by_cell.left().end());
}

}  // namespace octafront::improve
