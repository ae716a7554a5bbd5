#pragma once

#include <octafront/run_context.h>

#include "nets/net.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// What keeps a net from being a complex, exactly, found in layers of the lattice so that memory stays small.
class ConflictSearch {
 public:
  /// `world`: the vertices, which may be a mirror image. `on_edges_of_many`: those that may be on edges of more than
  /// two quads.
  ConflictSearch(const Net& net, std::span<const Vec3> world, bool is_mirrored,
                 std::span<const std::uint8_t> on_edges_of_many);

  /// The quads at fault: those with triangles that cross others or are without area, and those around edges where the
  /// regions do not come in their turn. Ascending, each once.
  std::vector<std::uint32_t> all(const RunContext& context) const;
  /// The same of the quads near moved vertices.
  std::vector<std::uint32_t> near(const std::vector<VertexIndex>& moved, const RunContext& context) const;

 private:
  struct Part;
  void search(const Part& part, std::vector<std::uint32_t>& bad, const RunContext& context) const;
  void find_crossings(const Part& part, std::vector<std::uint32_t>& bad, const RunContext& context) const;
  void find_disorder(const Part& part, std::vector<std::uint32_t>& bad) const;

  const Net& net_;
  std::span<const Vec3> world_;
  bool is_mirrored_;
  std::span<const std::uint8_t> many_;
};

}  // namespace octafront::nets
