#pragma once

#include <octafront/run_context.h>

#include "base/blocks/blocks.h"
#include "base/core/shared_value.h"
#include "improve/passes/passes.h"

#include <algorithm>
#include <vector>

namespace octafront::improve {

/// The inner vertices, and those of the boundary that may slide if a guide is given, with their stars, in an order of
/// blocks in which they may be moved in parallel, the same for any number of threads: for passes that change no
/// connection. In a stage no vertex has a neighbour in another block: a block is what lies in one cell of the stage, of
/// what the stages before left; what all of them leave is one block at the end.
class VertexBlocks {
 public:
  /// All of them.
  explicit VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide = nullptr)
      : VertexBlocks(mesh, guide, [](const Shape&) { return true; }) {}
  /// Those with an element around them of which needs_work(its shape) is true, as the mesh is now.
  template <typename NeedsWork>
  VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide, const NeedsWork& needs_work)
      : VertexBlocks(mesh, guide, marks(mesh, needs_work)) {}

  /// The half-faces opposite v of the tets around it, as from EditBlock::star(); v must be one of the vertices.
  std::span<const HalfFace> star(VertexIndex v) const { return stars_[v]; }

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
  static constexpr std::uint8_t kWorked = 1, kAtRim = 2;  ///< in the marks; kAtRim: of a block of the first stage

  /// Makes the blocks of the first stage, of the vertices that may move; gives those at rims.
  std::vector<VertexIndex> start(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t>& marks);
  /// Makes blocks of the stage, of those that wait and have no neighbour in another cell that does; they wait no more.
  void divide(const EditMesh& mesh, int stage, std::vector<VertexIndex>& waiting, std::vector<std::uint8_t>& waits);

  /// One sweep over the tets, which is quicker than star by star.
  template <typename NeedsWork>
  static std::vector<std::uint8_t> marks(const EditMesh& mesh, const NeedsWork& needs_work) {
    const Cells& cells = mesh.cells(0);
    std::vector<std::uint8_t> marks(mesh.vertices(), 0);
    parallel_for(mesh.slots(), [&](std::size_t i) {
      const auto t = static_cast<TetIndex>(i);
      if (!mesh.alive(t)) return;
      const Tet& c = mesh.tet(t);
      const std::uint8_t mark = (needs_work(mesh.shape(t)) ? kWorked : 0) | (cells.holding(c) == kNoOwner ? kAtRim : 0);
      if (mark == 0) return;
      for (const VertexIndex v : c) {
        const SharedValue shared(marks[v]);
        if ((shared.load() & mark) != mark) shared.add_bits(mark);
      }
    });
    return marks;
  }

  VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t> marks);

  Groups<HalfFace> stars_;
  std::vector<std::vector<std::vector<VertexIndex>>> stages_;
};

}  // namespace octafront::improve
