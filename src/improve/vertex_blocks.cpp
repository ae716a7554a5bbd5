#include "improve/vertex_blocks.h"

#include <algorithm>

namespace octafront::improve {
namespace {

constexpr VertexIndex kLeastBlock = 4096;  ///< vertices: below this most of a block is its rim
constexpr VertexIndex kMostBlocks = 256;

bool neighbours_within(const EditMesh& mesh, std::span<const HalfFace> star, VertexIndex first, VertexIndex last) {
  for (const HalfFace h : star)
    for (const VertexIndex u : mesh.tet(h / 4))
      if (u < first || u >= last) return false;
  return true;
}

}  // namespace

VertexBlocks::VertexBlocks(const EditMesh& mesh, const StarTable& stars, const BoundaryGuide* guide) {
  const auto n = static_cast<VertexIndex>(mesh.vertices());
  const VertexIndex size = std::max(kLeastBlock, n / kMostBlocks + 1);
  std::vector<VertexIndex> waiting;
  for (VertexIndex v = 0; v < n; ++v)
    if (mesh.tet_of(v) != kNone && (!mesh.on_boundary(v) || (guide && guide->may_slide(v)))) waiting.push_back(v);
  for (const VertexIndex shift : {VertexIndex{0}, size / 2}) {
    std::vector<std::vector<VertexIndex>> blocks((n + shift) / size + 1);
    std::vector<char> is_whole(waiting.size());
    parallel_for(waiting.size(), [&](std::size_t i) {
      const VertexIndex block = (waiting[i] + shift) / size;
      const VertexIndex first = block * size < shift ? 0 : block * size - shift, last = (block + 1) * size - shift;
      is_whole[i] = neighbours_within(mesh, stars.of(waiting[i]), first, last);
    });
    std::vector<VertexIndex> left;
    for (std::size_t i = 0; i < waiting.size(); ++i)
      (is_whole[i] ? blocks[(waiting[i] + shift) / size] : left).push_back(waiting[i]);
    stages_.push_back(std::move(blocks));
    waiting = std::move(left);
  }
  stages_.push_back({std::move(waiting)});
}

}  // namespace octafront::improve
