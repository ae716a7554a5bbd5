#pragma once

// The working mesh in blocks that threads may change at the same time: the same result for any number of them.

#include "base/geometry/blocks.h"
#include "surface/edits/working_mesh.h"

#include <array>
#include <vector>

namespace octafront::surface {

/// Vertices by blocks: cells of space. What changes triangles of whose corners all are in one block neither changes nor
/// sees what is changed in another. In the last stage one block has all vertices.
class SurfaceBlocks {
 public:
  explicit SurfaceBlocks(const WorkingMesh& mesh);

  static constexpr int kStages = kCellStages + 1;
  /// The block of one stage that an item belongs to, and what it has all of.
  struct Block {
    const SurfaceBlocks& blocks;
    int stage;
    std::uint32_t number;

    bool has(VertexIndex v) const { return blocks.block_of(v, stage) == number; }
    /// Whether all corners of the triangles around v are in the block.
    bool has_star(VertexIndex v) const;
    /// Whether all corners of the two triangles beside h are.
    bool has_both(HalfEdge h) const;
  };

  /// Calls work(block, items, left) for the blocks that have any, those of one stage in parallel. vertex_of(item) tells
  /// the block. What it adds to `left` is tried again in the next stage; in the last one it must do all. Items stand in
  /// the order in which they came.
  template <class Item, class VertexOf, class Work>
  void run(std::vector<Item> items, const VertexOf& vertex_of, const Work& work) const {
    for (int stage = first_stage_; stage < kStages && !items.empty(); ++stage) {
      items = run_in_cells(
          std::span<const Item>(items), stage == kCellStages ? 1 : cells_[stage].count,
          [&](const Item& item) { return block_of(vertex_of(item), stage); },
          [&](std::uint32_t cell, std::span<const Item> of_cell, std::vector<Item>& left) {
            work(Block{*this, stage, cell}, of_cell, left);
          });
    }
  }

 private:
  /// Vertices that came later are in no cell.
  std::uint32_t block_of(VertexIndex v, int stage) const {
    if (stage == kCellStages) return 0;
    return v < cells_[stage].of.size() ? cells_[stage].of[v] : kNoOwner;
  }

  const WorkingMesh* mesh_;
  std::array<Cells, kCellStages> cells_;
  int first_stage_ = 0;  ///< the last if there is one cell only
};

}  // namespace octafront::surface
