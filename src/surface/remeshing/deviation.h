#pragma once

#include <octafront/surface_mesh.h>

#include "geometry/triangle_tree.h"
#include "surface/remeshing/walk.h"

#include <functional>
#include <vector>

namespace octafront::remeshing {

/// Where two surfaces lie too far apart.
struct FarPlace {
  Vec3 at;                         ///< on either of them
  SurfacePoint on_input;           ///< the place itself, or the nearest point to it that faces alike
  double distance = 0;             ///< to the other surface
  std::uint32_t triangle = kNone;  ///< of the made surface, there or nearest
  bool within = false;             ///< inside a triangle of the input, not at its corners or the middles of its edges
};

/// What is looked at of triangles of the input that are not much longer than those made there: whatever part of them
/// may be far, or their corners, between which there is little. Nets of voxels consist of such.
enum class Fine { kParts, kCorners };

/// What is looked at.
struct Scope {
  Fine fine = Fine::kParts;
  std::function<bool(Vec3)> asked = {};  ///< only points where this is true, of both surfaces; empty: all
};

/// Places where two surfaces are farther apart than `limit`, looked for at the centroids, edge midpoints and vertices
/// of `made`, and at the vertices and edge midpoints of `input` and wherever else it may lie beyond the limit; no
/// deeper where it is known to lie beyond `far`. `input_tree` is over the triangles of `input`.
std::vector<FarPlace> places_beyond(double limit, double far, const SurfaceMesh& made, const SurfaceMesh& input,
                                    const TriangleTree& input_tree, const Scope& scope = {});

/// The points of the input that lie under the middles of these triangles and of their edges, however near.
std::vector<FarPlace> places_under(const std::vector<std::uint32_t>& triangles, const SurfaceMesh& made,
                                   const TriangleTree& input_tree);

}  // namespace octafront::remeshing
