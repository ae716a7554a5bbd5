#pragma once

// How far walls that were changed are from the smooth surface that they stand for, or from the one that was given, both
// ways, and where too far.

#include <octafront/surface_mesh.h>

#include "adapt/ground/ground.h"
#include "adapt/passes/piece.h"
#include "adapt/schedule/parts.h"
#include "base/geometry/triangle_tree.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::adapt {

/// Bounds on the greatest distance of a point of one surface to the other, whichever is greater: lower <= distance <=
/// upper; input units.
struct Deviation {
  double lower = 0, upper = 0;
  Vec3 place;        ///< `lower` away from the other surface
  double bound = 0;  ///< what is to be kept

  /// Beyond 1 the bound is not kept.
  double excess() const { return bound > 0 ? upper / bound : upper > 0 ? HUGE_VAL : 0; }
};
/// The greatest excess; 0 if there are none.
double excess_of(std::span<const Deviation> deviations);
/// The deviation of the greatest excess; nothing if there are none.
Deviation worst_of(std::span<const Deviation> deviations);

/// How far walls may stray, and which stay.
struct WallBounds {
  std::vector<double> tolerance;         ///< per part of walls; > 0; input units
  std::vector<std::uint8_t> strict;      ///< per part: walls that strayed farther when they came are no excuse
  std::span<const std::uint8_t> kept;    ///< per part: they stay, and are not looked at; empty: none
  std::span<const std::uint8_t> frozen;  ///< as of AdaptRules: walls between frozen vertices are not looked at
};

/// The surface that the walls that may change stand for, smooth or given, as triangles that are far nearer to it than
/// the tolerance. Walls of one tolerance are a group, which is measured by itself.
class SmoothWalls {
 public:
  SmoothWalls(const Ground& ground, const WallBounds& bounds);

  /// Of the walls of a mesh made of those that came, per group, more exactly where it is not clear whether they keep
  /// the bound. They include what the triangles here differ from the smooth surface. Where the bound is not kept, and
  /// not strict, it becomes what the walls kept that came.
  std::vector<Deviation> of(const Parts& mesh) { return of(walls_of(mesh).surface); }
  /// Of the walls that came.
  std::vector<Deviation> of_old();
  /// `walls.patch`: the parts.
  std::vector<Deviation> of(const SurfaceMesh& walls);

  /// A triangle with places farther from here than a share of the bound of its group, or that is nearest to a place
  /// here that is farther than it from any.
  struct Stray {
    Triangle corners;
    double bound;  ///< of its group
  };
  /// Those of no edge longer than `least_edge` times the bound do not stray because they are large.
  std::vector<Stray> strays(const Parts& mesh, double share, double least_edge) const;
  std::vector<Stray> strays(const SurfaceMesh& walls, double share, double least_edge) const;

 private:
  /// How well distances are known, in parts of tolerance_: at first, and where that decides.
  static constexpr double kResolution = 1, kFineResolution = 0.2;
  struct Group {
    double tolerance = 0;  ///< by which the smooth surface is divided, and distances known
    double bound = 0;
    bool excused = false;  ///< walls that came count already, or are no excuse
    SurfaceMesh old, smooth;
  };
  /// Those that may change.
  WallsOfParts walls_of(const Parts& mesh) const;
  bool stays(const Triangle& corners, std::uint32_t part) const;
  void make_groups();
  void add_given(const Ground& ground, SurfaceMesh& all);
  Deviation of_old(const Group& group) const;
  void excuse(Group& group);
  Deviation distance_of(const Group& group, const SurfaceMesh& walls, const TriangleTree& tree,
                        double resolution) const;
  /// The triangles of each group; those alone have points.
  std::vector<SurfaceMesh> divided_in_groups(const SurfaceMesh& walls) const;

  WallBounds bounds_;
  std::vector<std::uint32_t> group_;  ///< per part
  std::vector<Group> groups_;
  TriangleTree tree_;  ///< of all that is smooth, and of what was given and stands for no wall that may change
};

/// Asks for smaller elements at these triangles, whatever the metric wants: such that the longest edge of each is
/// divided. Returns the vertices that ask.
std::vector<VertexIndex> ask_for_smaller(std::vector<Vertex>& vertices, std::span<const SmoothWalls::Stray> strays);
/// Gives a vertex another metric than that of its place.
void ask_for(Vertex& vertex, const Metric& metric);

}  // namespace octafront::adapt
