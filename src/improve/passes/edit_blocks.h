#pragma once

// A schedule by blocks for passes that change connections: the same result for any number of threads.

#include <octafront/run_context.h>

#include "base/core/parallel.h"
#include "improve/passes/edit_block.h"
#include "improve/passes/passes.h"

#include <vector>

namespace octafront::improve {

/// The elements of one stage, block by block.
class EditBlocks {
 public:
  struct Share {
    EditBlock block;
    std::vector<TetIndex> tets;  ///< to be worked on, by their names
    std::vector<TetIndex> left;  ///< those for which the block was too small
    PassResult result;
  };

  /// Divides the mesh by the cells of the stage; the last stage is the whole mesh. Each block gets those of `tets` that
  /// it owns, and slots for new ones, and for as many new vertices if asked for; the rest is for finish().
  EditBlocks(EditMesh& mesh, std::vector<TetIndex> tets, int stage, bool adds_vertices);
  static constexpr int kStages = kCellStages + 1;

  std::vector<Share>& shares() { return shares_; }
  /// What no block could do; gives unused slots back.
  std::vector<TetIndex> finish();

 private:
  void divide(std::vector<TetIndex> tets, const Cells& cells, bool adds_vertices);

  EditMesh& mesh_;
  std::vector<Share> shares_;
  std::vector<TetIndex> left_;
};

/// Calls work(block, tets, left) for each block, in parallel, stage after stage. It works on the tets, adds to `left`
/// those for which the block was too small (EditBlock::take_cut), and returns what it did.
template <typename Work>
PassResult for_each_block(EditMesh& mesh, std::vector<TetIndex> tets, const RunContext& context, Work&& work,
                          bool adds_vertices = false) {
  PassResult sum;
  for (int stage = 0; stage < EditBlocks::kStages && !tets.empty(); ++stage) {
    EditBlocks blocks(mesh, std::move(tets), stage, adds_vertices);
    auto& shares = blocks.shares();
    parallel_for(shares.size(), [&](std::size_t b) {
      context.check();
      shares[b].result = work(shares[b].block, shares[b].tets, shares[b].left);
    });
    for (const EditBlocks::Share& s : shares) sum += s.result;
    tets = blocks.finish();
  }
  return sum;
}

/// Lets `editor` improve(t) each of the tets with a score below the threshold, and those in its created(); those for
/// which the block was too small go to `left`.
template <typename Editor>
PassResult improve_each(Editor& editor, EditBlock& block, std::vector<TetIndex> queue, float threshold,
                        std::vector<TetIndex>& left) {
  PassResult result;
  const EditMesh& mesh = block.mesh();
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const TetIndex t = queue[k];
    if (!mesh.alive(t) || mesh.shape(t).score >= threshold) continue;
    ++result.tried;
    block.take_cut();
    if (!editor.improve(t)) {
      if (block.take_cut()) left.push_back(t);
      continue;
    }
    ++result.done;
    for (const TetIndex made : editor.created())
      if (mesh.shape(made).score < threshold) queue.push_back(made);
  }
  return result;
}

/// The tets with a score below the threshold, by slot.
std::vector<TetIndex> tets_below(const EditMesh& mesh, float threshold);

}  // namespace octafront::improve
