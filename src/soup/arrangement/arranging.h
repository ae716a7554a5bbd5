#pragma once

// The steps of the arrangement.

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include "base/geometry/exact_point.h"
#include "soup/arrangement/arrange.h"

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

namespace octafront::arrangement {

/// Points of an arrangement: those of the input first, then exact ones.
class PointTable {
 public:
  explicit PointTable(std::span<const Vec3> points) : points_(points) {}
  std::uint32_t size() const { return static_cast<std::uint32_t>(points_.size() + exact_.size()); }
  std::uint32_t inputs() const { return static_cast<std::uint32_t>(points_.size()); }
  Place place(std::uint32_t p) const {
    if (p < points_.size()) return {points_[p]};
    const ExactPoint& x = exact_[p - points_.size()];
    return {x.at, &x.place};
  }
  std::uint32_t add(ExactPoint x) {
    exact_.push_back(std::move(x));
    return size() - 1;
  }

 private:
  std::span<const Vec3> points_;
  std::deque<ExactPoint> exact_;
};

/// What a triangle has in common with another one that is not in its plane.
struct Contact {
  std::uint32_t triangle, other;
  std::uint32_t a, b;  ///< points of the table: ends of a segment, or b is kNone
};

struct Contacts {
  std::vector<Contact> all;                            ///< both ways, in the order of the pairs
  std::vector<std::array<std::uint32_t, 2>> coplanar;  ///< pairs in one plane
};

/// What pairs of triangles that conflict (base/geometry/self_intersection.h) have in common. Requires triangles that
/// are not degenerate and points without equals.
Contacts find_contacts(PointTable& table, std::span<const Triangle> triangles,
                       std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context);

/// Triangles divided along what they have in common, on exact points.
struct Divided {
  std::vector<Triangle> triangles;  ///< of points of the table
  std::vector<std::vector<Origin>> origins;
};

/// Divides triangles by their conflicts `pairs`; what touches none comes out as it is. Adds points to the table; equal
/// points have one number in the result.
Divided divide(PointTable& table, std::span<const Triangle> triangles,
               std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context);

/// Triangles on their way, each with its origins in the input.
struct Soup {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::vector<Origin>> origins;
};

/// Brings together what nearly meets among the triangles of `pairs`: vertices nearer to each other than `reach` become
/// the first of them; edges and faces go through vertices that are nearer to them than that (they are divided there,
/// with all triangles at an edge). Triangles may lose their area. Returns the farthest that a vertex went; what is
/// divided moves by `reach` at most. Cost: O(n log n).
double snap(Soup& soup, std::span<const std::array<std::uint32_t, 2>> pairs, double reach);

}  // namespace octafront::arrangement
