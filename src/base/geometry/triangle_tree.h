#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/core/raw_vector.h"
#include "base/geometry/triangle_box.h"
#include "base/geometry/triangle_intersection.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// A tree of axis-parallel boxes over triangles: nearest points, boxes, segments, rays, inside or outside.
/// Holds its own copy of the coordinates. Deterministic; built in O(n log n); queries are const and thread-safe.
class TriangleTree {
 public:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  /// REQUIRES finite coordinates.
  TriangleTree(std::span<const Vec3> points, std::span<const Triangle> triangles);
  explicit TriangleTree(const SurfaceMesh& surface);

  bool empty() const { return items_.empty(); }
  Box3 box() const { return empty() ? Box3{} : nodes_[0].box; }

  /// Corners of a triangle, by its index in the list that the tree was made from.
  const TriangleCorners& corners(std::uint32_t triangle) const { return items_[item_of_triangle_[triangle]].corners; }

  struct Nearest {
    Vec3 point;
    std::uint32_t triangle = kNone;  ///< kNone: nothing nearer than the limit
    double squared_distance = kFar;
  };
  /// The nearest point of the triangles to p; among equally near triangles any, but always the same one.
  /// Only looks for points with squared distance below `limit_squared`: a good limit makes the search short.
  Nearest nearest(Vec3 p, double limit_squared = kFar) const;
  /// Whether some triangle has a point nearer to p than the distance: ends at the first one found.
  bool is_within(Vec3 p, double distance) const;

  /// Calls visit(triangle) for each triangle that meets the closed box, in an order that depends on the tree only.
  /// Never misses one; see triangle_overlaps_box.
  template <class Visit>
  void for_each_overlapping(const Box3& box, Visit&& visit) const {
    for_each_leaf([&](const Box3& b) { return b.overlaps(box); },
                  [&](const Item& item) {
                    if (triangle_overlaps_box(item.corners, box)) visit(item.triangle);
                  });
  }

  /// Calls visit(triangle, corners) for each triangle whose box meets the closed box, until one says false; returns
  /// false if one did. The box may shrink meanwhile.
  template <class Visit>
  bool for_each_box_near(const Box3& box, Visit&& visit) const {
    bool on = true;
    for_each_leaf([&](const Box3& b) { return on && b.overlaps(box); },
                  [&](const Item& item) {
                    if (on && box_of(item.corners).overlaps(box)) on = visit(item.triangle, item.corners);
                  });
    return on;
  }

  /// Calls visit(triangle, hit) for each triangle that the closed segment pq meets, exactly; see segment_triangle_hit.
  template <class Visit>
  void for_each_hit(Vec3 p, Vec3 q, Visit&& visit) const {
    for_each_leaf([&](const Box3& b) { return segment_overlaps_box(p, q, b); },
                  [&](const Item& item) {
                    if (!box_of(item.corners).overlaps({min(p, q), max(p, q)})) return;
                    if (const SegmentHit hit = segment_triangle_hit(p, q, item.corners)) visit(item.triangle, hit);
                  });
  }

  /// Calls visit(triangle, corners) for each triangle in a leaf whose box the triangle `t` meets; never misses one that
  /// meets it.
  template <class Visit>
  void for_each_near(const TriangleCorners& t, Visit&& visit) const {
    for_each_leaf([&](const Box3& b) { return triangle_overlaps_box(t, b); },
                  [&](const Item& item) { visit(item.triangle, item.corners); });
  }

  struct RayHit {
    double t = kFar;                 ///< the hit is origin + t * direction
    std::uint32_t triangle = kNone;  ///< kNone: no hit up to t_max
  };
  /// The first triangle that a ray from `origin` hits with 0 <= t <= t_max, in floating point: rays do not slip through
  /// edges between triangles, but t has rounding errors.
  RayHit first_hit(Vec3 origin, Vec3 direction, double t_max = kFar) const;

  enum class Location { kOutside, kOnSurface, kInside };
  /// Where p lies in a closed surface, exactly: inside if a ray crosses it an odd number of times.
  Location locate(Vec3 p) const;
  bool contains(Vec3 p) const { return locate(p) == Location::kInside; }
  /// How often a closed surface winds around p, which must not lie on it, exactly: 1 inside an outward surface.
  int winding_number(Vec3 p) const;

  /// Where a search would pass by a triangle, or a box is not that of what lies below it (base/core/validate.h).
  std::optional<std::string> first_inconsistency() const;

 private:
  friend class SelfIntersectionSearch;
  static constexpr std::uint32_t kLeafSize = 4;

  struct Item {
    TriangleCorners corners;
    std::uint32_t triangle;
  };
  // Children lie side by side, since searches look at both.
  struct Node {
    Box3 box;
    std::uint32_t first = 0;  // leaf: its first item; inner: its left child, then the right one
    std::uint32_t count = 0;  // items of a leaf; 0: inner
  };
  struct Crossings {
    bool on_surface = false;
    int count = 0, winding = 0;
  };
  struct Builder;

  Crossings crossings(Vec3 p) const;

  template <class Key, class Visit>
  void descend(const double& limit, Key&& key, Visit&& visit) const;

  template <class Enter, class Visit>
  void for_each_leaf(Enter&& enter, Visit&& visit) const {
    if (empty()) return;
    std::array<std::uint32_t, kMaxDepth> stack;
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!enter(node.box)) continue;
      if (node.count == 0) {
        stack[depth++] = node.first + 1;
        stack[depth++] = node.first;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(items_[i]);
    }
  }

  // Splits are at the median, so depth is at most log2 of 2^32 triangles.
  static constexpr int kMaxDepth = 64;

  RawVector<Node> nodes_;
  RawVector<Item> items_;
  RawVector<std::uint32_t> item_of_triangle_;
};

/// Over points, or segments: as triangles with corners that are one, numbered as the list.
TriangleTree tree_of_points(std::span<const Vec3> points, std::span<const VertexIndex> list);
TriangleTree tree_of_segments(std::span<const Vec3> points, std::span<const Edge> segments);

}  // namespace octafront
