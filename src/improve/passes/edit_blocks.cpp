#include "improve/passes/edit_blocks.h"

#include "base/core/parallel.h"

#include <algorithm>

namespace octafront::improve {
namespace {

constexpr VertexIndex kLeastEditBlock = 4096;  ///< vertices: below this most of a block is its rim
constexpr VertexIndex kMostEditBlocks = 256;
/// Slots reserved for each block: some, and a part of the number of elements that it works on. Passes make little more
/// than they take away; what finds no slot is left as it is.
constexpr std::size_t kRoom = 64;
constexpr std::size_t kBlockRoomPart = 4;

/// Takes the last `count` of a list, in the order in which they would come off it.
template <typename Index>
std::vector<Index> take_last(std::vector<Index>& from, std::size_t count) {
  std::vector<Index> taken(from.end() - static_cast<std::ptrdiff_t>(count), from.end());
  from.resize(from.size() - count);
  return taken;
}

}  // namespace

EditBlocks::EditBlocks(EditMesh& mesh, const std::vector<TetIndex>& tets, int stage, bool adds_vertices) : mesh_(mesh) {
  const auto n = static_cast<VertexIndex>(mesh.original_.size());
  const VertexIndex size = std::max(kLeastEditBlock, n / kMostEditBlocks + 1);
  if (stage + 1 == kStages || n <= size) {
    shares_.push_back({EditBlock(mesh), tets, {}, {}});
    return;
  }
  divide(tets, size, stage == 0 ? 0 : size / 2, adds_vertices);
}

void EditBlocks::divide(const std::vector<TetIndex>& tets, VertexIndex size, VertexIndex shift, bool adds_vertices) {
  const auto n = static_cast<VertexIndex>(mesh_.original_.size());
  std::vector<std::vector<TetIndex>> own((n + shift) / size + 1);
  std::size_t room = 0, vertices = 0;
  for (const TetIndex t : tets) {
    if (!mesh_.alive(t)) continue;
    const auto block_of = [&](VertexIndex v) { return (mesh_.key_[v] + shift) / size; };
    const Tet& c = mesh_.tet(t);
    const VertexIndex b = block_of(c[0]);
    const bool whole = block_of(c[1]) == b && block_of(c[2]) == b && block_of(c[3]) == b;
    (whole ? own[b] : left_).push_back(t);
    vertices += whole && adds_vertices;
  }
  for (const auto& o : own) room += o.empty() ? 0 : kRoom + o.size() / kBlockRoomPart;
  if (mesh_.complex_.free.size() < room) mesh_.reserve_tets(room - mesh_.complex_.free.size());
  if (mesh_.free_points_.size() < vertices) mesh_.reserve_points(vertices - mesh_.free_points_.size());
  for (VertexIndex b = 0; b < own.size(); ++b) {
    if (own[b].empty()) continue;
    const VertexIndex first = b * size < shift ? 0 : b * size - shift, last = (b + 1) * size - shift;
    EditBlock block(mesh_, first, last - first, take_last(mesh_.complex_.free, kRoom + own[b].size() / kBlockRoomPart),
                    take_last(mesh_.free_points_, adds_vertices ? own[b].size() : 0));
    shares_.push_back({std::move(block), std::move(own[b]), {}, {}});
  }
}

std::vector<TetIndex> EditBlocks::finish() {
  for (std::size_t k = shares_.size(); k-- > 0;) {
    EditBlock& block = shares_[k].block;
    left_.insert(left_.end(), shares_[k].left.begin(), shares_[k].left.end());
    if (block.whole_) continue;
    mesh_.complex_.last_mark = std::max(mesh_.complex_.last_mark, block.mark_);
    mesh_.complex_.free.insert(mesh_.complex_.free.end(), block.free_tets_.begin(), block.free_tets_.end());
    mesh_.free_points_.insert(mesh_.free_points_.end(), block.free_points_.begin(), block.free_points_.end());
  }
  std::sort(left_.begin(), left_.end());
  return std::move(left_);
}

std::vector<TetIndex> tets_below(const EditMesh& mesh, float threshold) {
  constexpr std::size_t kRange = 16384;
  return parallel_collect<TetIndex>(mesh.slots(), kRange,
                                    [&](std::size_t begin, std::size_t end, std::vector<TetIndex>& found) {
                                      for (auto t = static_cast<TetIndex>(begin); t < end; ++t)
                                        if (mesh.shape(t).score < threshold) found.push_back(t);
                                    });
}

}  // namespace octafront::improve
