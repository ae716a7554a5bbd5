#pragma once

#include <octafront/no_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/vec.h>

#include <limits>

namespace octafront {

/// How thick bodies are, and the shortest of their edges: what small elements must fit into. Lengths in input units;
/// infinite: there is none.
struct SmallestFeatures {
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  /// From a place of a wall straight into the body to the wall that faces it, the least of all places; walls that meet
  /// at more than about 45 degrees do not face each other.
  double thickness = kNone;
  Vec3 thinnest_at;  ///< the place
  /// A tenth, and half, of the area is over walls no thicker than this.
  double thin_tenth = kNone, thin_half = kNone;
  /// The length of a line between corners along which faces or patches meet, the shortest of all.
  double shortest_edge = kNone;
  Vec3 shortest_at;  ///< the vertex of it nearest to its middle
};

/// Looks at some ten thousand places spread evenly over the surface, of a surface of very many triangles at as many of
/// them. `feature_angle`: degrees by which faces turn along an edge. Requires a clean surface (surface_mesh.h).
SmallestFeatures smallest_features(const SurfaceMesh& surface, double feature_angle = 40,
                                   const RunContext& context = no_context());

}  // namespace octafront
