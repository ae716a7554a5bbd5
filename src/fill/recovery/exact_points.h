#pragma once

#include <octafront/ids.h>

#include "base/core/groups.h"
#include "base/geometry/homogeneous.h"
#include "base/geometry/predicates.h"

#include <array>
#include <span>
#include <vector>

namespace octafront::recovery {

using exact::BigFloat;

using exact::Homogeneous;

/// The vertices of the recovery: given points, which are doubles, and Steiner points on edges and facets, whose exact
/// place is a rational. All signs are exact.
class ExactPoints {
 public:
  /// A point with double coordinates.
  VertexIndex add(Vec3 p);
  /// The point a + t (b - a). Requires that 1 - t does not round.
  VertexIndex add_between(VertexIndex a, VertexIndex b, double t);
  /// The point where the line (p, q) meets the plane (a, b, c). Requires that p and q are strictly on two sides of it.
  VertexIndex add_crossing(VertexIndex p, VertexIndex q, VertexIndex a, VertexIndex b, VertexIndex c);
  /// The point where the lines (p, q) and (x, y) cross. Requires that they do, inside both segments.
  VertexIndex add_crossing(VertexIndex p, VertexIndex q, VertexIndex x, VertexIndex y);
  /// Another point at the place of v.
  VertexIndex add_copy(VertexIndex v);
  /// Forgets the last point.
  void pop();
  /// Four vertices of one plane have sign 0 without arithmetic. `plane[f]` is the plane of triangle f; points between
  /// two others inherit the planes that these share. Requires that no Steiner point exists yet.
  void set_planes(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& plane);
  /// Steiner point v lies on this plane.
  void add_plane(VertexIndex v, std::uint32_t plane);
  std::uint32_t plane_of(std::size_t triangle) const { return plane_of_triangle_[triangle]; }

  /// Vertex v becomes the double point p.
  void move(VertexIndex v, Vec3 p);

  VertexIndex size() const { return static_cast<VertexIndex>(point_.size()); }
  /// The point itself, or the nearest doubles of a Steiner point (relative error below 2^-50).
  Vec3 at(VertexIndex v) const { return point_[v]; }
  bool is_double(VertexIndex v) const { return v < first_steiner_ || steiner_[v - first_steiner_].coordinate.empty(); }

  /// Words of 64 bits that its longest coordinate takes; 1 of a double point.
  std::size_t words(VertexIndex v) const;

  /// The sign of orient3d (base/geometry/predicates.h) of four vertices.
  int orient(VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) const {
    if (a < first_steiner_ && b < first_steiner_ && c < first_steiner_ && d < first_steiner_) {
      return orient3d(point_[a], point_[b], point_[c], point_[d]);
    }
    return orient_steiner(a, b, c, d);
  }
  /// The same with the double point p as the last one.
  int orient(VertexIndex a, VertexIndex b, VertexIndex c, Vec3 p) const;

 private:
  struct Steiner {
    std::vector<BigFloat> coordinate;   ///< four; empty for a double point
    Vec3 rest;                          ///< what the rounded point lacks of the exact one, again rounded
    std::vector<std::uint32_t> planes;  ///< sorted
    std::array<Edge, 2> lines{Edge{kNone, kNone}, Edge{kNone, kNone}};  ///< through two vertices each
  };
  using Planes = std::span<const std::uint32_t>;

  int orient_steiner(VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) const;
  /// What the rounded point lacks of the exact one.
  Vec3 rest_of(VertexIndex v) const { return v < first_steiner_ ? Vec3{} : steiner_[v - first_steiner_].rest; }
  int orient_exact(const std::array<VertexIndex, 4>& v) const;
  Homogeneous homogeneous(VertexIndex v) const;
  VertexIndex add(Homogeneous h, std::vector<std::uint32_t> planes);
  Planes planes_of(VertexIndex v) const;
  std::vector<std::uint32_t> shared_planes(VertexIndex a, VertexIndex b) const;
  bool share_line(const std::array<VertexIndex, 4>& v) const;
  bool share_plane(const std::array<VertexIndex, 4>& v) const;

  std::vector<Vec3> point_;
  VertexIndex first_steiner_ = kNone;
  std::vector<Steiner> steiner_;  ///< from first_steiner_ on
  std::vector<std::uint32_t> plane_of_triangle_;
  Groups<> planes_at_;  ///< per vertex, sorted
};

}  // namespace octafront::recovery
