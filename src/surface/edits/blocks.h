#pragma once

// The working mesh in blocks that threads may change at the same time: the same result for any number of them.

#include "base/core/buckets.h"
#include "base/core/parallel.h"
#include "surface/edits/working_mesh.h"

#include <vector>

namespace octafront::remeshing {

/// Vertices by blocks: stretches of a space-filling curve. What changes triangles of whose corners all are in one block
/// neither changes nor sees what is changed in another. In the second stage the stretches are shifted by half; in the
/// third one block has all vertices.
class SurfaceBlocks {
 public:
  explicit SurfaceBlocks(const WorkingMesh& mesh);

  static constexpr int kStages = 3;
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
    for (int stage = first_stage(); stage < kStages && !items.empty(); ++stage) {
      const Buckets<Item> by_block(items.size(), count(stage), [&](std::size_t i, const auto& add) {
        add(block_of(vertex_of(items[i]), stage), items[i]);
      });
      std::vector<std::vector<Item>> left(by_block.size());
      parallel_for(
          by_block.size(),
          [&](std::size_t b) {
            const Block block{*this, stage, static_cast<std::uint32_t>(b)};
            if (!by_block[b].empty()) work(block, by_block[b], left[b]);
          },
          Split::kSingly);
      items.clear();
      for (const std::vector<Item>& of_block : left) items.insert(items.end(), of_block.begin(), of_block.end());
    }
  }

 private:
  std::uint32_t block_of(VertexIndex v, int stage) const {
    if (stage + 1 == kStages) return 0;
    // Vertices that came later are in no block.
    if (v >= rank_.size()) return static_cast<std::uint32_t>(count(stage) - 1);
    return (rank_[v] + (stage == 0 ? 0 : size_ / 2)) / size_;
  }
  std::size_t count(int stage) const { return stage + 1 == kStages ? 1 : (rank_.size() + size_ / 2) / size_ + 2; }
  int first_stage() const { return rank_.size() > size_ ? 0 : kStages - 1; }

  const WorkingMesh* mesh_;
  std::vector<std::uint32_t> rank_;  ///< per vertex: its place on the curve
  std::uint32_t size_;
};

}  // namespace octafront::remeshing
