#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>

#include "base/geometry/exact_point.h"

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

}  // namespace octafront::arrangement
