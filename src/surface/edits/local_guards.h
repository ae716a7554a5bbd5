#pragma once

#include "surface/edits/surface_blocks.h"
#include "surface/edits/working_mesh.h"

namespace octafront::surface {

/// How far triangles may turn when the mesh changes around them; cosines.
struct TurnLimits {
  double star = 0.5;     ///< against the mean normal of the triangles that they replace
  double surface = 0.2;  ///< against the input's normal at their vertices
};

/// Square of the mean-ratio quality of a triangle with this area vector (twice its area): 1 if equilateral, 0 if flat.
inline double squared_quality(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = b - a, v = c - a, w = c - b;
  const double l = squared_length(u) + squared_length(v) + squared_length(w);
  return l > 0 ? 12 * squared_length(cross(u, v)) / (l * l) : 0;
}

/// True if a new triangle with this area vector may replace a part of the star with area vector `star`.
inline bool turns_little(Vec3 area_vector, Vec3 star, double cosine) {
  const double along = dot(area_vector, star);
  return along > 0 && along * along >= cosine * cosine * squared_length(area_vector) * squared_length(star);
}

/// True if the triangle faces along the input's normal at its vertices inside patches.
bool faces_outward(const WorkingMesh& mesh, Vec3 area_vector, const VertexIndex (&vertices)[3], double cosine);

/// Whether the angles opposite the edge of h sum to 180 degrees at most.
bool is_delaunay(const WorkingMesh& mesh, HalfEdge h);

/// Whether both triangles that a flip of h would make face as the surface does.
bool flip_is_sound(const WorkingMesh& mesh, HalfEdge h, const TurnLimits& limits);

/// Turns every edge that is not Delaunay, may turn and soundly so, until none is left (bounded). `edges` is where to
/// begin; it is consumed. Returns the number of flips.
std::uint64_t make_delaunay(WorkingMesh& mesh, std::vector<HalfEdge>& edges, const TurnLimits& limits);
/// The same block by block. REQUIRES edges that are there.
std::uint64_t make_delaunay(WorkingMesh& mesh, const SurfaceBlocks& blocks, std::vector<HalfEdge> edges,
                            const TurnLimits& limits);

}  // namespace octafront::surface
