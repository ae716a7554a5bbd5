#pragma once

#include <octafront/run_context.h>

#include "core/groups.h"
#include "core/parallel.h"
#include "improve/passes.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <vector>

namespace octafront::improve {

/// The inner vertices, and those of the boundary that may slide if a guide is given, with their stars, in an order of
/// blocks in which they may be moved in parallel, the same for any number of threads: for passes that change no
/// connection. Blocks are stretches of the numbering, which follows a space-filling curve. A vertex whose neighbours
/// all lie in its own block shares no element with one of another block. What is left over by the first division is
/// divided anew with the blocks shifted by half, and what is left by that is one block at the end.
class VertexBlocks {
 public:
  /// All of them.
  explicit VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide = nullptr)
      : VertexBlocks(mesh, guide, [](const Shape&) { return true; }) {}
  /// Those with an element around them of which needs_work(its shape) is true, as the mesh is now.
  template <typename NeedsWork>
  VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide, const NeedsWork& needs_work)
      : VertexBlocks(mesh, guide, marks(mesh, needs_work)) {}

  /// The half-faces opposite v of the tets around it, in order of the tets; v must be one of the vertices.
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
  static constexpr VertexIndex kLeastBlock = 4096;  ///< vertices: below this most of a block is its rim
  static constexpr VertexIndex kMostBlocks = 256;
  static constexpr int kShifts = 2;
  static constexpr std::uint8_t kWorked = 1
                                          << kShifts;  ///< in the marks; bit s: neighbours in another block of shift s

  /// How the vertices are divided, by either shift.
  struct Division {
    int bits;
    explicit Division(std::size_t vertices)
        : bits(std::countr_zero(
              std::max(kLeastBlock, std::bit_ceil(static_cast<VertexIndex>(vertices) / kMostBlocks + 1)))) {}
    VertexIndex shift(int s) const { return s == 0 ? 0 : VertexIndex{1} << (bits - 1); }
    std::size_t block_of(VertexIndex v, int s) const { return (v + shift(s)) >> bits; }
  };

  /// One sweep over the tets, which is quicker than star by star.
  template <typename NeedsWork>
  static std::vector<std::uint8_t> marks(const EditMesh& mesh, const NeedsWork& needs_work) {
    const Division division(mesh.vertices());
    std::vector<std::uint8_t> marks(mesh.vertices(), 0);
    parallel_for(mesh.slots(), [&](std::size_t i) {
      const auto t = static_cast<TetIndex>(i);
      if (!mesh.alive(t)) return;
      const Tet& c = mesh.tet(t);
      const VertexIndex least = std::min({c[0], c[1], c[2], c[3]}), most = std::max({c[0], c[1], c[2], c[3]});
      std::uint8_t mark = needs_work(mesh.shape(t)) ? kWorked : 0;
      for (int s = 0; s < kShifts; ++s) mark |= (division.block_of(least, s) != division.block_of(most, s)) << s;
      if (mark == 0) return;
      for (const VertexIndex v : c) {
        const std::atomic_ref shared(marks[v]);
        if ((shared.load(std::memory_order_relaxed) & mark) != mark) shared.fetch_or(mark, std::memory_order_relaxed);
      }
    });
    return marks;
  }

  VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t> marks);

  Groups<HalfFace> stars_;
  std::vector<std::vector<std::vector<VertexIndex>>> stages_;
};

}  // namespace octafront::improve
