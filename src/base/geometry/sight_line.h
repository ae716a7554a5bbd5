#pragma once

#include <octafront/ids.h>

#include "base/geometry/triangle_side.h"
#include "base/geometry/triangle_tree.h"

#include <optional>
#include <span>
#include <vector>

namespace octafront {

/// Lines parallel to an axis, and the triangles that they cross, in exact order. A line is moved by an infinitesimal
/// across its direction, so that it crosses no edge and no vertex.
class SightLines {
 public:
  /// Keeps the spans.
  SightLines(std::span<const Vec3> points, std::span<const Triangle> triangles)
      : points_(points), triangles_(triangles), tree_(points, triangles) {}

  struct Crossing {
    std::uint32_t triangle;
    bool faces_up;  ///< its normal points along the axis

    Side below() const { return faces_up ? behind(triangle) : front_of(triangle); }
    Side above() const { return faces_up ? front_of(triangle) : behind(triangle); }
  };

  /// All crossings of the line through p along an axis, in the order along it.
  std::vector<Crossing> crossings(Vec3 p, int axis) const;
  /// The first side that is seen from p along the axis; nullopt: none, to infinity. Requires that p lies on no
  /// triangle.
  std::optional<Side> first_side(Vec3 p, int axis) const;

  /// A point and an axis such that the line through it crosses the triangle in its inside; nullopt if rounding leaves
  /// no such point.
  struct Line {
    Vec3 p;
    int axis;
  };
  std::optional<Line> line_through(std::uint32_t triangle) const;

  const TriangleTree& tree() const { return tree_; }

 private:
  TriangleCorners corners(std::uint32_t t) const {
    const auto [a, b, c] = triangles_[t];
    return {points_[a], points_[b], points_[c]};
  }

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  TriangleTree tree_;
};

}  // namespace octafront
