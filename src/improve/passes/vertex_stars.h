#pragma once

#include <octafront/run_context.h>

#include "base/core/groups.h"
#include "improve/passes/passes.h"

#include <vector>

namespace octafront::improve {

/// The inner vertices, and those of the boundary that may slide if a guide is given, with their stars: for passes that
/// change no connection.
class VertexStars {
 public:
  /// Of those with an element around them of which needs_work(its shape) is true, as the mesh is now.
  template <typename NeedsWork>
  VertexStars(const EditMesh& mesh, const BoundaryGuide* guide, const NeedsWork& needs_work) {
    std::vector<std::uint8_t> is_worked(mesh.vertices(), 0);
    for (TetIndex t = 0; t < mesh.slots(); ++t)
      if (mesh.alive(t) && needs_work(mesh.shape(t)))
        for (const VertexIndex v : mesh.tet(t)) is_worked[v] = 1;
    gather(mesh, guide, is_worked);
  }

  /// Calls `work(vertex, star)` for each of them, which tells whether it did anything. The star is the half-faces
  /// opposite the vertex, as from MeshEditor::star().
  template <typename Work>
  PassResult run(const RunContext& context, Work&& work) const {
    PassResult result;
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      if (k % kBetweenChecks == 0) context.check();
      result += work(vertices_[k], stars_[vertices_[k]]);
    }
    return result;
  }

  const std::vector<VertexIndex>& vertices() const { return vertices_; }
  std::span<const HalfFace> star(VertexIndex v) const { return stars_[v]; }

 private:
  static constexpr std::size_t kBetweenChecks = 256;

  void gather(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t>& is_worked);

  std::vector<VertexIndex> vertices_;
  Groups<HalfFace> stars_;
};

}  // namespace octafront::improve
