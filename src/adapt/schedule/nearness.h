#pragma once

// How far walls that were changed are from the smooth surface that they stand for, or from the one that was given, both
// ways, and where too far.

#include <octafront/surface_mesh.h>

#include "adapt/ground/ground.h"
#include "adapt/piece/piece.h"
#include "base/geometry/triangle_tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::adapt {

/// Bounds on the greatest distance of a point of one surface to the other, whichever is greater: lower <= distance <=
/// upper; input units.
struct Deviation {
  double lower = 0, upper = 0;
  Vec3 place;  ///< `lower` away from the other surface
};

/// The surface that the walls that may change stand for, smooth or given, as triangles that are far nearer to it than
/// `tolerance`. Const and safe on any number of threads.
class SmoothWalls {
 public:
  /// `frozen`: as of AdaptRules; walls between frozen vertices are not looked at. Requires tolerance > 0.
  SmoothWalls(const Ground& ground, std::span<const std::uint8_t> frozen, double tolerance);

  /// Of the walls that came.
  Deviation of_old() const { return distance_of(old_, kResolution); }
  /// Of the walls of a mesh made of them, more exactly where it is not clear whether they keep the bound. They include
  /// what the triangles here differ from the smooth surface.
  Deviation of(const Parts& mesh, double bound) const { return of(walls_of(mesh).surface, bound); }
  Deviation of(const SurfaceMesh& walls, double bound) const;
  /// The wall triangles with places farther than `bound` from here, and those that are nearest to places here that are
  /// farther than it from any.
  std::vector<Triangle> strays(const Parts& mesh, double bound) const;
  std::vector<Triangle> strays(const SurfaceMesh& walls, double bound) const;

 private:
  /// How well distances are known, in parts of tolerance_: at first, and where that decides.
  static constexpr double kResolution = 1, kFineResolution = 0.2;
  struct WallsOfParts {
    SurfaceMesh surface;  ///< without unused points
    std::vector<VertexIndex> vertex;
  };
  static WallsOfParts walls_of(const Parts& mesh);
  void add_given(const Ground& ground, std::span<const std::uint8_t> frozen, SurfaceMesh& all);
  Deviation distance_of(const SurfaceMesh& walls, double resolution) const;

  double tolerance_;
  SurfaceMesh old_, smooth_;
  TriangleTree tree_;  ///< of smooth_, and of what was given and stands for no wall that may change
};

}  // namespace octafront::adapt
