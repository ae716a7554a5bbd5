#pragma once

// The input as the ground of the surface front: points on it and walks across it (walk.h), what
// deviates from it, turns or crosses (deviation, turning, crossings), places where its own triangles stay
// (kept_places). Takes the input, changes nothing.

#include "base/mesh/half_edge_mesh.h"
#include "base/mesh/known_surface.h"

namespace octafront::surface {

/// The input surface, as something to walk on.
struct InputSurface {
  HalfEdgeMesh mesh;
  std::vector<Vec3> face_normal;         ///< unit; zero where degenerate
  std::vector<Vec3> vertex_normal;       ///< unit, weighted by area; zero at tips, around which faces look every way
  std::vector<std::uint8_t> on_feature;  ///< per vertex: some feature edge ends there
  std::vector<std::uint32_t> patch;      ///< per triangle
  /// Triangles of patches from here on are backs: see seams.h.
  std::uint32_t first_back = kNone;

  bool is_back(std::size_t triangle) const { return patch[triangle] >= first_back; }
  bool is_seam(HalfEdge h) const { return is_back(h / 3) != is_back(mesh.twin[h] / 3); }
  bool on_seam(VertexIndex v) const {
    bool found = false;
    if (first_back != kNone) mesh.for_each_outgoing(v, [&](HalfEdge h) { found = found || is_seam(h); });
    return found;
  }

  bool is_smooth_at(VertexIndex v) const { return !on_feature[v] && vertex_normal[v] != Vec3{}; }

  /// Smooth normal at a point of a face: interpolated between vertex normals, where the corner is a tip or lies on a
  /// feature the face's own.
  Vec3 normal_at(std::uint32_t face, Vec3 p) const;
};

/// Normals of the faces and vertices of its mesh.
void find_normals(InputSurface& input);
/// Adjacency and normals; no feature edge is marked yet.
InputSurface make_input_surface(const SurfaceMesh& surface, const EdgeTable& edges);
/// Replaces the feature edges. Seams are features whatever `edges` say.
void set_features(InputSurface& input, const std::vector<Edge>& edges);

/// A point of the input surface and a face that it lies in.
struct SurfacePoint {
  Vec3 p;
  std::uint32_t face = kNone;
};

enum class WalkEnd { kArrived, kFeature, kLost };

/// Where a walk ends that leaves `from` in the direction `direction` (unit), along the section of the surface with the
/// plane through direction and `normal`, when it first is at `distance` from its start. It never crosses a feature
/// edge: kFeature then, and `result` is the crossing point, in the face before it.
WalkEnd walk(const InputSurface& input, SurfacePoint from, Vec3 direction, Vec3 normal, double distance,
             SurfacePoint& result);

/// The same from the vertex that half-edge `corner` leaves, into its triangle; `direction` lies in the triangle's
/// plane.
WalkEnd walk_from_vertex(const InputSurface& input, HalfEdge corner, Vec3 direction, double distance,
                         SurfacePoint& result);

}  // namespace octafront::surface
