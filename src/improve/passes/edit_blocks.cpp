#include "improve/passes/edit_blocks.h"

#include "base/core/parallel.h"

#include <algorithm>
#include <functional>

namespace octafront::improve {
namespace {

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

EditBlocks::EditBlocks(EditMesh& mesh, std::vector<TetIndex> tets, int stage, bool adds_vertices) : mesh_(mesh) {
  // A slot without a tet may get another one: it must not be taken for what was to be worked on.
  std::erase_if(tets, [&](TetIndex t) { return !mesh_.alive(t); });
  // New vertices get the lowest numbers that are free, block by block.
  std::sort(mesh_.free_points_.begin(), mesh_.free_points_.end(), std::greater<>());
  if (stage == kCellStages || mesh.cells(stage).count <= 1)
    shares_.push_back({EditBlock(mesh), std::move(tets), {}, {}});
  else
    divide(std::move(tets), mesh.cells(stage), adds_vertices);
  parallel_for(
      shares_.size(), [&](std::size_t k) { mesh_.sort_by_name(shares_[k].tets); }, Split::kSingly);
}

void EditBlocks::divide(std::vector<TetIndex> tets, const Cells& cells, bool adds_vertices) {
  const ItemsByCell<TetIndex> by_cell(std::span<const TetIndex>(tets), cells.count,
                                      [&](TetIndex t) { return cells.holding(mesh_.tet(t)); });
  left_.assign(by_cell.left().begin(), by_cell.left().end());
  const auto room_for = [](std::size_t count) { return count == 0 ? 0 : kRoom + count / kBlockRoomPart; };
  std::size_t room = 0;
  const std::size_t vertices = adds_vertices ? tets.size() - left_.size() : 0;
  for (std::uint32_t c = 0; c < cells.count; ++c) room += room_for(by_cell[c].size());
  if (mesh_.complex_.free.size() < room) mesh_.reserve_tets(room - mesh_.complex_.free.size());
  if (mesh_.free_points_.size() < vertices) mesh_.reserve_points(vertices - mesh_.free_points_.size());
  for (std::uint32_t c = 0; c < cells.count; ++c) {
    const std::span<const TetIndex> own = by_cell[c];
    if (own.empty()) continue;
    EditBlock block(mesh_, cells, c, take_last(mesh_.complex_.free, room_for(own.size())),
                    take_last(mesh_.free_points_, adds_vertices ? own.size() : 0));
    shares_.push_back({std::move(block), {own.begin(), own.end()}, {}, {}});
  }
}

std::vector<TetIndex> EditBlocks::finish() {
  for (std::size_t k = shares_.size(); k-- > 0;) {
    EditBlock& block = shares_[k].block;
    left_.insert(left_.end(), shares_[k].left.begin(), shares_[k].left.end());
    if (block.whole_) continue;
    const auto give_back = [](const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); };
    give_back(block.free_tets_, mesh_.complex_.free);
    give_back(block.free_points_, mesh_.free_points_);
    if (!mesh_.taken_) continue;
    give_back(block.gone_, mesh_.taken_->gone);
    give_back(block.region_of_gone_, mesh_.taken_->region_of_gone);
  }
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
