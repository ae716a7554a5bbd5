#pragma once

#include "surface/edits/working_mesh.h"

#include <cstdint>
#include <vector>

namespace octafront::surface {

/// Changes of the working mesh in which feature lines may merge and corners vanish, which WorkingMesh alone forbids:
/// for places that are too narrow for an element. Patches never vanish, and vertices marked as fixed stay.
class LineEdits {
 public:
  /// `is_fixed`: by vertex; those beyond its end are not. All must outlive this.
  LineEdits(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed);

  /// Whether the start of h may vanish at its end: points of lines at points of lines, corners at corners.
  bool may_collapse(HalfEdge h) const;
  void collapse(HalfEdge h);

  /// Whether the edge of h may turn; a feature line along it then runs through the apex of h.
  bool may_flip(HalfEdge h) const;
  void flip(HalfEdge h);

  bool must_stay(VertexIndex v) const { return v < is_fixed_.size() && is_fixed_[v]; }

 private:
  bool patches_remain(HalfEdge h) const;
  void settle(VertexIndex v);

  WorkingMesh& mesh_;
  const std::vector<std::uint8_t>& is_fixed_;
  std::vector<std::uint32_t> patch_size_;  ///< triangles in each patch
};

}  // namespace octafront::surface
