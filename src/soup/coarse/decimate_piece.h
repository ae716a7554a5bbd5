#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/core/groups.h"
#include "base/geometry/symmetric_matrix.h"
#include "soup/coarse/decimate.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace octafront {

/// The weighted sum of squared distances to planes and lines, as a function of the place (M. Garland, P. Heckbert,
/// "Surface simplification using quadric error metrics", 1997).
struct Quadric {
  SymmetricMatrix a;
  Vec3 b;  ///< the sum is p a p + 2 b p + c
  double c = 0;
  double weight = 0;

  /// Of the plane through p across the unit vector n.
  static Quadric of_plane(Vec3 n, Vec3 p, double weight) {
    const double d = -dot(n, p);
    Quadric q;
    q.a.add(n, weight);
    q.b = n * (weight * d), q.c = weight * d * d, q.weight = weight;
    return q;
  }
  /// Of the line through p along the unit vector u.
  static Quadric of_line(Vec3 u, Vec3 p, double weight) {
    const Vec3 off = p - u * dot(u, p);
    Quadric q;
    q.a.add_even(weight), q.a.add(u, -weight);
    q.b = off * -weight, q.c = weight * dot(off, off), q.weight = weight;
    return q;
  }

  Quadric& operator+=(const Quadric& o) {
    a += o.a, b += o.b, c += o.c, weight += o.weight;
    return *this;
  }

  /// The mean of the squared distances; rounding may make it less than 0.
  double mean(Vec3 p) const { return weight > 0 ? (dot(p, a.times(p)) + 2 * dot(b, p) + c) / weight : 0; }

  /// Where on the way from p along `way` the sum is least: in [0, 1], parts of it.
  double least_along(Vec3 p, Vec3 way) const {
    const double bend = dot(way, a.times(way));
    return bend > 0 ? std::clamp(-dot(way, a.times(p) + b) / bend, 0.0, 1.0) : 0;
  }

  /// Where the sum is least; in directions in which it hardly changes, near `around`.
  Vec3 least(Vec3 around) const {
    constexpr double kPull = 1e-3;  // of the weight: planes of an even surface turn by more than this
    return around - a.damped_solve(a.times(around) + b, kPull * weight);
  }
};

/// What may become of a vertex. One on a line stays on it; a fixed one stays where it is.
enum class VertexRole : std::uint8_t { kFree, kOnLine, kFixed };

/// Part of a complex, with numbers of its own, which is changed without a look at the rest.
struct Piece {
  std::vector<Vec3> points;
  Vec3 origin;  ///< of the places that quadrics are asked at, so that they keep their digits
  std::vector<Quadric> quadric;
  std::vector<VertexRole> role;
  std::vector<std::uint8_t> is_at_rim;  ///< the vertex has triangles that others may see: neither they nor it change
  std::vector<std::uint8_t> is_wanted;  ///< the vertex is to be removed if it can be
  std::vector<Triangle> triangles;      ///< one that is removed has kNone for its first corner
  std::vector<std::uint32_t> sheet;     ///< per triangle: between two sheets lies a line; numbered anew by decimate()

  // As LiveTriangles asks.
  std::size_t triangle_count() const { return triangles.size(); }
  bool is_removed(std::uint32_t t) const { return triangles[t][0] == kNone; }
  const Triangle& triangle(std::uint32_t t) const { return triangles[t]; }
  Vec3 corner(std::uint32_t t, int i) const { return points[triangles[t][i]]; }
};

/// Whether each collapse is tested for what its triangles would cross: slow, and hardly ever needed.
enum class Crossings { kUntested, kTested };

/// Collapses what the limits let go.
void decimate(Piece& piece, const DecimationLimits& limits, Crossings crossings, const RunContext& context);

}  // namespace octafront
