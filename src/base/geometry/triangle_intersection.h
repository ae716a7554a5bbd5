#pragma once

// Do triangles and segments meet? Exact for all inputs of the range of predicates.h: touching, coplanar and collinear
// cases are decided by signs alone. Boxes and one-sidedness come first, so that most pairs cost a few comparisons.

#include <octafront/ids.h>
#include <octafront/vec.h>

#include <array>
#include <vector>

namespace octafront {

using TriangleCorners = std::array<Vec3, 3>;

/// True if the closed triangles have a point in common. A degenerate triangle counts as meeting whatever its box meets.
bool triangles_meet(const TriangleCorners& s, const TriangleCorners& t);

/// True if the closed triangles meet in anything but the simplex that they share by vertex ids: nothing, a vertex or an
/// edge. Vertices that coincide under different ids conflict; so do a triangle and itself. Triangles that share
/// vertices must not be degenerate.
bool triangles_conflict(const TriangleCorners& s, const Triangle& s_ids, const TriangleCorners& t,
                        const Triangle& t_ids);
bool triangles_conflict(const std::vector<Vec3>& points, const Triangle& s, const Triangle& t);

/// Where a closed segment meets a closed triangle.
struct SegmentHit {
  enum class Kind {
    kMiss,
    kPoint,     ///< one point, the segment not in the plane of the triangle
    kCoplanar,  ///< the segment lies in the plane and meets the triangle somewhere
  };
  enum class Part { kInterior, kEdge, kCorner };
  Kind kind = Kind::kMiss;
  Part part = Part::kInterior;  ///< of kPoint: the part of the triangle that the point lies on
  int index = -1;               ///< of kEdge: the corner opposite the edge; of kCorner: the corner
  int end = -1;                 ///< of kPoint: 0 or 1 if the point is that end of the segment, else -1
  int from_side = 0;            ///< of kPoint: orient3d(triangle, p), or -orient3d(triangle, q) where p is in the plane

  explicit operator bool() const { return kind != Kind::kMiss; }
};

/// The segment may be a point if it does not lie in the plane of the triangle. Requires a triangle that is not
/// degenerate.
SegmentHit segment_triangle_hit(Vec3 p, Vec3 q, const TriangleCorners& t);

}  // namespace octafront
