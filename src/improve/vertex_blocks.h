#pragma once

#include <octafront/run_context.h>

#include "core/parallel.h"
#include "improve/passes.h"
#include "improve/star_table.h"

#include <vector>

namespace octafront::improve {

/// The inner vertices, and those of the boundary that may slide if a guide is given, in an order of blocks in which
/// they may be moved in parallel, the same for any number of threads. Blocks are stretches of the numbering, which
/// follows a space-filling curve. A vertex whose neighbours all lie in its own block shares no element with one of
/// another block. What is left over by the first division is divided anew with the blocks shifted by half, and what is
/// left by that is one block at the end.
class VertexBlocks {
 public:
  explicit VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide = nullptr);

  /// Calls `work(vertices)` for each block, which returns what it did; blocks of one stage run in parallel.
  template <typename Work>
  PassResult run(const RunContext& context, Work&& work) const {
    PassResult sum;
    for (const auto& stage : stages_) {
      std::vector<PassResult> results(stage.size());
      parallel_for(stage.size(), [&](std::size_t b) {
        context.check();
        results[b] = work(stage[b]);
      });
      for (const PassResult& r : results) sum += r;
    }
    return sum;
  }

  /// stages()[s][b]: the vertices of block b of stage s.
  const std::vector<std::vector<std::vector<VertexIndex>>>& stages() const { return stages_; }

 private:
  std::vector<std::vector<std::vector<VertexIndex>>> stages_;
};

}  // namespace octafront::improve
