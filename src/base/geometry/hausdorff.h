#pragma once

#include "base/geometry/triangle_tree.h"

#include <cstdint>

namespace octafront {

struct SurfaceMesh;

/// Bounds on a Hausdorff distance, in input units: lower <= distance <= upper, to rounding.
struct HausdorffBounds {
  double lower = 0, upper = 0;
  Vec3 place;                 ///< the point of one surface that is `lower` away from the other
  std::uint64_t samples = 0;  ///< nearest-point queries made
};

/// The greatest distance of a point of `from` to `to`. Triangles of `from` are divided until upper - lower is at most
/// `tolerance` or the pieces have no edge longer than it (then upper - lower is at most twice the tolerance). On a
/// piece the distance is at most that of a corner plus the distance to the other corners, and at most the greatest
/// distance of its corners to any one triangle of `to`, for that distance is convex: flat parts that agree need no
/// division. Requires tolerance > 0, e.g. 1e-4 times the diagonal. Infinite if only `to` is empty.
HausdorffBounds one_sided_hausdorff(const SurfaceMesh& from, const TriangleTree& to, double tolerance);

/// The greater of both one-sided distances.
HausdorffBounds hausdorff_distance(const SurfaceMesh& a, const SurfaceMesh& b, double tolerance);

}  // namespace octafront
