#include "improve/vertex_blocks.h"

namespace octafront::improve {

VertexBlocks::VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t> marks) {
  const auto n = static_cast<VertexIndex>(mesh.vertices());
  std::vector<VertexIndex> waiting;
  for (VertexIndex v = 0; v < n; ++v) {
    if (mesh.on_boundary(v) && !(guide && guide->may_slide(v))) marks[v] &= ~kWorked;
    if (marks[v] & kWorked) waiting.push_back(v);
  }
  stars_ = group_by_owner(n, static_cast<HalfFace>(4 * mesh.slots()), [&](HalfFace h) {
    const VertexIndex v = mesh.tet(h / 4)[h % 4];
    return mesh.alive(h / 4) && (marks[v] & kWorked) ? v : kNoOwner;
  });
  const Division division(n);
  for (int s = 0; s < kShifts; ++s) {
    std::vector<std::vector<VertexIndex>> blocks(division.block_of(n, s) + 1);
    std::vector<VertexIndex> left;
    for (const VertexIndex v : waiting) (marks[v] >> s & 1 ? left : blocks[division.block_of(v, s)]).push_back(v);
    stages_.push_back(std::move(blocks));
    waiting = std::move(left);
  }
  stages_.push_back({std::move(waiting)});
}

}  // namespace octafront::improve
