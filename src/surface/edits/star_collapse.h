#pragma once

#include "surface/edits/local_guards.h"

namespace octafront::surface {

/// Judges what becomes of the triangles around a vertex if it moves along one of its edges and vanishes.
class StarCollapse {
 public:
  explicit StarCollapse(const WorkingMesh& mesh) : mesh_(mesh) {}

  /// Looks at the star of v. On a curve the triangles on either side of it count as a star each.
  void gather(VertexIndex v);
  /// The half-edges that leave v, counter-clockwise.
  const std::vector<HalfEdge>& ring() const { return ring_; }
  /// Least squared quality of the star's triangles as they are.
  double quality_now() const;
  /// Least squared quality of the triangles after a move along ring()[towards]; 0 if one would turn too far, or if it
  /// is not better than `least`.
  double quality_after(std::size_t towards, const TurnLimits& limits, double least) const;
  /// Length of the longest new edge after that move, in wanted sizes.
  double longest_after(std::size_t towards) const;

 private:
  const WorkingMesh& mesh_;
  std::vector<HalfEdge> ring_;
  std::vector<Vec3> stars_;
};

}  // namespace octafront::surface
