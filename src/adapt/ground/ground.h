#pragma once

// adapt/ground: what the walls of a mesh stand for when it comes: the smooth surface and the smooth lines through them,
// or a surface that is given. Tells where new vertices of walls and lines belong, and how far new triangles are from
// it.

#include <octafront/surface_mesh.h>

#include "adapt/ground/given.h"
#include "base/core/flat_map.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/features.h"
#include "improve/curved/smooth_surface.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace octafront::adapt {

/// The walls of a mesh as triangles, and the lines where they end, meet or bend.
struct Walls {
  SurfaceMesh surface;              ///< `patch`: the number of the part; turned the same way as far as that goes
  std::vector<std::uint8_t> outer;  ///< per triangle: nothing lies in front of it
  EdgeTable edges;                  ///< of the triangles
  Features lines;
  std::vector<std::uint32_t> path;  ///< per line edge: the line it belongs to
};

/// Turns inner walls such that neighbours within a part look the same way, where they can, and makes the edges.
void turn_alike(Walls& walls);

/// Per line edge the number of its path: edges that are `alike` between vertices where lines end, meet or bend, which
/// become `lines.corners`. Paths are numbered in the order of their first edges.
std::vector<std::uint32_t> find_paths(std::size_t vertices, Features& lines,
                                      const std::function<bool(std::uint32_t, std::uint32_t)>& alike);

/// Const and safe on any number of threads.
class Ground {
 public:
  /// The reference surface and curves of these walls: `given` where it is near them, their own smooth surface
  /// elsewhere. `given` may be null, and must outlive this.
  explicit Ground(Walls walls, const GivenSurface* given = nullptr);

  /// The surface that was given; null: none.
  const GivenSurface* given() const { return given_; }
  /// Whether a triangle of the walls stands for the given surface; others for their own smooth one.
  bool is_covered(std::uint32_t triangle) const { return given_ && covered_[triangle] != 0; }
  /// The corner of the given surface where a corner of the walls belongs.
  std::optional<Vec3> corner(VertexIndex v) const;

  /// The place on the reference surface of a part that is nearest to p; none if it is farther than `reach`, or turned
  /// away from `normal`. The outer boundary must face outward, interfaces and sheets may face either way.
  std::optional<Vec3> on_surface(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach) const {
    std::uint32_t near = kNone;
    return on_surface(p, part, outer, normal, reach, near);
  }
  /// `near`: a triangle of the walls that may be near, or kNone; becomes the one found.
  std::optional<Vec3> on_surface(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach,
                                 std::uint32_t& near) const;
  /// The same on the reference curve of a path.
  std::optional<Vec3> on_line(Vec3 p, std::uint32_t path, double reach) const;

  /// Sharp bends of the reference surface where the old triangles are that surface, for no smooth one goes through
  /// their vertices: edges within one part and on no curve at which an edge across, of the length wanted(place,
  /// direction), would cut off more than the part's `tolerance`. Ascending.
  std::vector<Edge> kinks(const std::function<double(Vec3, Vec3)>& wanted, std::span<const double> tolerance) const;

  /// How triangles of a part lie to it, at the worst of the places looked at: middles of triangles and of edges.
  struct Truth {
    double distance = 0;  ///< input units; infinite where the part is not within reach
    double cosine = 1;    ///< of the angle between a triangle and the surface at its middle
  };
  /// `near`: a triangle of the walls that may be near, or kNone.
  Truth truth_of(const TriangleCorners& t, std::uint32_t part, bool outer, double reach,
                 std::uint32_t near = kNone) const;
  /// The same at one place of a triangle with this normal. `near`: a triangle of the walls that may be near, or kNone;
  /// becomes the one found.
  Truth truth_at(Vec3 place, Vec3 normal, std::uint32_t part, bool outer, double reach, std::uint32_t& near) const;

  /// The smooth surface of a triangle of the walls, as triangles whose middles, and those of their edges, are within
  /// `tolerance` of it, or which are a thousandth of the whole.
  std::vector<TriangleCorners> divided(std::uint32_t triangle, double tolerance) const;
  /// The same of a triangle of the given surface, and which of them `stands` for walls of the mesh, by their corners
  /// and middles.
  struct GivenPieces {
    std::vector<TriangleCorners> standing, others;
  };
  GivenPieces divided_given(std::uint32_t triangle, double tolerance, const std::function<bool(Vec3)>& stands) const;
  /// The triangle of the walls nearest to a place of the given surface, if that is within reach of it; kNone.
  std::uint32_t wall_at(Vec3 on_given) const;

  const Walls& walls() const { return walls_; }
  const TriangleTree& tree() const { return tree_; }

 private:
  /// `near`: of nearest_that(); becomes the triangle found.
  std::optional<curved::Foot> foot(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach,
                                   std::uint32_t& near) const;

  /// How far from the ground edges so long can be that have their ends to both sides of this edge.
  double cut_off(std::size_t edge, double length) const;
  /// The way (unit) from the middle of an edge into one of its triangles along the ground, across the edge.
  Vec3 way_from(HalfEdge h) const;
  /// The smooth surface over a place of the walls, and over one of a triangle by its barycentric weights.
  Vec3 smooth_over(const curved::Foot& foot) const;
  Vec3 smooth_at(std::uint32_t triangle, Vec3 weights) const;
  /// The place of the smooth or the given surface that belongs to p.
  struct Home {
    Vec3 at;
    Vec3 normal;  ///< of any length
  };
  std::optional<Home> home(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach,
                           std::uint32_t& near) const;
  /// For a place of a line that the given surface does not have: on its surface, where a side of the line has it.
  Vec3 beside_line(Vec3 p, std::uint32_t edge) const;

  /// How far the given surface may be from a place of an edge or a triangle with an edge so long.
  double reach_of(double longest_edge) const;
  void find_covered();
  void find_corners();

  Walls walls_;
  FlatMap<Edge, std::uint32_t> line_at_;  ///< per sorted edge of a line its number
  std::vector<std::uint8_t> has_line_;    ///< per triangle: one of its sides lies on a line
  TriangleTree tree_;
  curved::SmoothSurface smooth_;
  const GivenSurface* given_;
  std::vector<std::uint8_t> covered_, line_covered_;       ///< per triangle, per line edge; empty: nothing was given
  std::vector<std::pair<VertexIndex, Vec3>> corner_home_;  ///< ascending
  double farthest_ = 0;  ///< walls that are covered may be so far from where they belong
};

}  // namespace octafront::adapt
