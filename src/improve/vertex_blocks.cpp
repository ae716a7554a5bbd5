#include "improve/vertex_blocks.h"

#include <algorithm>
#include <atomic>

namespace octafront::improve {
namespace {

constexpr VertexIndex kLeastBlock = 4096;  ///< vertices: below this most of a block is its rim
constexpr VertexIndex kMostBlocks = 256;

/// Vertices with a neighbour in another block of this size. Tet by tet, which is quicker than star by star.
std::vector<std::uint8_t> rims_of_blocks(const EditMesh& mesh, VertexIndex size, VertexIndex shift) {
  std::vector<std::uint8_t> is_rim(mesh.vertices(), 0);
  parallel_for(mesh.slots(), [&](std::size_t t) {
    if (!mesh.alive(static_cast<TetIndex>(t))) return;
    const Tet& c = mesh.tet(static_cast<TetIndex>(t));
    const auto [least, most] = std::minmax({c[0], c[1], c[2], c[3]});
    if ((least + shift) / size == (most + shift) / size) return;
    for (const VertexIndex v : c) std::atomic_ref(is_rim[v]).store(1, std::memory_order_relaxed);
  });
  return is_rim;
}

}  // namespace

VertexBlocks::VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide) {
  const auto n = static_cast<VertexIndex>(mesh.vertices());
  const VertexIndex size = std::max(kLeastBlock, n / kMostBlocks + 1);
  std::vector<VertexIndex> waiting;
  for (VertexIndex v = 0; v < n; ++v)
    if (mesh.tet_of(v) != kNone && (!mesh.on_boundary(v) || (guide && guide->may_slide(v)))) waiting.push_back(v);
  for (const VertexIndex shift : {VertexIndex{0}, size / 2}) {
    std::vector<std::vector<VertexIndex>> blocks((n + shift) / size + 1);
    const std::vector<std::uint8_t> is_rim = rims_of_blocks(mesh, size, shift);
    std::vector<VertexIndex> left;
    for (const VertexIndex v : waiting) (is_rim[v] ? left : blocks[(v + shift) / size]).push_back(v);
    stages_.push_back(std::move(blocks));
    waiting = std::move(left);
  }
  stages_.push_back({std::move(waiting)});
}

}  // namespace octafront::improve
