#pragma once

#include <octafront/run_context.h>
#include <octafront/vec.h>

#include "base/geometry/predicates.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::io {

struct Point2 {
  double x, y;
  friend bool operator==(const Point2&, const Point2&) = default;
};

inline int turn(Point2 a, Point2 b, Point2 c) {
  return orient2d(a.x, a.y, b.x, b.y, c.x, c.y);
}

/// Points of a plane that are taken away one by one, and are asked for by triangle: a balanced k-d tree.
class PlanePoints {
 public:
  /// Those of `points` that `members` names; `points` must outlive the tree.
  PlanePoints(const std::vector<Point2>& points, std::vector<std::uint32_t> members);

  bool has(std::uint32_t point) const { return place_of_[point] != kGone; }
  void remove(std::uint32_t point);

  /// Whether `holds` is true of any point left in the closed triangle, which turns left; may ask for others near by.
  template <class Holds>
  bool any_in(const std::array<Point2, 3>& triangle, const Holds& holds) const {
    return any_below(root(), triangle, holds);
  }

 private:
  struct Box {
    Point2 lo, hi;
  };
  /// A node of the implicit tree: its children halve its range of members_.
  struct Node {
    std::uint32_t index, begin, end;

    bool is_leaf() const { return end - begin <= kLeaf; }
    std::uint32_t middle() const { return begin + (end - begin) / 2; }
    Node low() const { return {2 * index + 1, begin, middle()}; }
    Node high() const { return {2 * index + 2, middle(), end}; }
  };
  static constexpr std::uint32_t kLeaf = 8, kGone = 0xffffffff;

  Node root() const { return {0, 0, static_cast<std::uint32_t>(members_.size())}; }
  void build(Node node, bool by_x);

  static bool apart(const Box& box, const std::array<Point2, 3>& triangle) {
    for (int i = 0; i < 3; ++i) {
      const Point2 a = triangle[i], b = triangle[(i + 1) % 3];
      // The corner of the box that lies farthest to the left of the side.
      if (turn(a, b, {a.y > b.y ? box.hi.x : box.lo.x, a.x < b.x ? box.hi.y : box.lo.y}) < 0) return true;
    }
    return false;
  }

  template <class Holds>
  bool any_below(Node node, const std::array<Point2, 3>& triangle, const Holds& holds) const {
    if (left_[node.index] == 0 || apart(boxes_[node.index], triangle)) return false;
    if (!node.is_leaf()) return any_below(node.low(), triangle, holds) || any_below(node.high(), triangle, holds);
    return std::any_of(members_.begin() + node.begin, members_.begin() + node.end,
                       [&](std::uint32_t point) { return has(point) && holds(point); });
  }

  const std::vector<Point2>& points_;
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> place_of_;  ///< in members_, or kGone
  std::vector<std::uint32_t> left_;      ///< per node: points not taken away
  std::vector<Box> boxes_;               ///< per node
};

/// Divides a polygon into triangles that keep its orientation and do not overlap. Appends to `out` triples of positions
/// in `corners`. Where a fan about corner 0 does that (all strictly convex polygons), it is a fan; others are clipped
/// ear by ear in the plane of coordinates that the polygon faces most, with exact signs; corners in the middle of a
/// straight side stay corners. Polygons with holes cut open along a doubled edge are fine. Corners equal to the one
/// before are left out. False if the polygon crosses itself: the triangles then overlap where it does. O(n) for a fan,
/// else O(n log n) on most polygons. Throws Cancelled if `context` asks for it.
bool triangulate_polygon(std::span<const Vec3> corners, std::vector<std::array<std::uint32_t, 3>>& out,
                         const RunContext& context = {});

/// Polygons that no fan divides and that have more corners than this would take too long.
inline constexpr std::size_t kMostPolygonCorners = 200000;

/// Whether triangulate_polygon makes a fan of it.
bool fans_out(std::span<const Vec3> corners);

}  // namespace octafront::io
