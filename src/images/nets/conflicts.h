#pragma once

#include <octafront/run_context.h>

#include "images/nets/net.h"
#include "images/nets/shelters.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// Quads at fault, ascending, each once.
struct Conflicts {
  /// Quads with triangles that cross others or have no area, and quads around an edge where they do not follow each
  /// other in the order of the regions between them.
  std::vector<std::uint32_t> invalid;
  /// Quads that leave a region only a sharp wedge between them, or lie at sharp corners of curves: no good element fits
  /// into such places. Quads whose vertices may not yield are not among them.
  std::vector<std::uint32_t> sharp;
  bool empty() const { return invalid.empty() && sharp.empty(); }
};

/// What keeps a net from being a complex, exactly, and from being a good one, found in layers of the lattice so that
/// memory stays small.
class ConflictSearch {
 public:
  /// `x`, `world`: the vertices in straight space and in the world. `may_yield`: per vertex, whether the vertex may be
  /// asked to go back where the net is sharp.
  ConflictSearch(const Net& net, const Lattice& lattice, std::span<const Vec3> x, std::span<const Vec3> world,
                 std::span<const std::uint8_t> may_yield);

  Conflicts all(const RunContext& context) const;
  /// The same of the quads near moved vertices.
  Conflicts near(const std::vector<VertexIndex>& moved, const RunContext& context) const;

 private:
  struct Part;
  struct CurveEnd;
  void search(const Part& part, Conflicts& found, const RunContext& context) const;
  std::vector<std::uint32_t> quads_that_may_cross(const Part& part) const;
  void find_crossings(const Part& part, Conflicts& found, const RunContext& context) const;
  void find_around_edges(const Part& part, Conflicts& found) const;
  void find_sharp_corners(std::vector<CurveEnd> ends, Conflicts& found) const;
  void find_folds(const Part& part, Conflicts& found) const;
  void add_sharp(std::uint32_t quad, Conflicts& found) const;

  const Net& net_;
  Shelters shelters_;
  std::span<const Vec3> world_;
  bool is_mirrored_;
  std::span<const std::uint8_t> may_yield_;
};

}  // namespace octafront::nets
