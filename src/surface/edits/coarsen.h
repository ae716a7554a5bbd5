#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/edits/local_guards.h"
#include "surface/edits/working_mesh.h"

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

struct CoarsenCounts {
  std::uint64_t collapses = 0, flips = 0;
  std::uint64_t input_vertices_left = 0;
};

/// Collapses the input's own vertices into the points of the front, with Delaunay flips between passes, until none is
/// left (but those on seams) that connections, features and normals let go. Those left become free (or stay on their
/// curve).
void remove_input_vertices(WorkingMesh& mesh, const SizeField& sizes, const RunContext& context, CoarsenCounts& counts);

}  // namespace octafront::surface
