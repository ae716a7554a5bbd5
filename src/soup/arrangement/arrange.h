#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// An input triangle that a triangle is a part of.
struct Origin {
  std::uint32_t triangle;
  bool reversed;  ///< it faces the other way
  friend bool operator==(const Origin&, const Origin&) = default;
};

/// Triangles that meet in shared vertices and edges only.
struct Arrangement {
  std::vector<Vec3> points;                 ///< those of the input first, each at its place (equal ones, and of those
                                            ///< brought together: only the first is used)
  std::vector<Triangle> triangles;          ///< in the order of their first origins
  std::vector<std::uint32_t> first_origin;  ///< one per triangle and one more: where its origins begin
  std::vector<Origin> origins;              ///< ascending for each triangle; the first one is not reversed
  std::uint64_t crossing_pairs = 0;         ///< of the input
  std::uint64_t degenerate = 0;             ///< input triangles without area, left out
  std::uint64_t new_points = 0;
  int passes = 0;           ///< of rounding
  double largest_move = 0;  ///< of a point that was brought to another one

  std::span<const Origin> origins_of(std::size_t triangle) const {
    return {origins.data() + first_origin[triangle], origins.data() + first_origin[triangle + 1]};
  }
};

/// Divides triangles where they cross, touch or overlap; of what lies on each other one triangle stays, with the
/// origins of all. Triangles that conflict with none come out with their corners. New points are exact intersections,
/// rounded to doubles; where that makes new crossings these are resolved in turn until none is left. Where it goes on
/// making some, what nearly meets there is brought together, from a reach of 1e-13 of the diagonal on: only then may
/// input points move, too (`largest_move`). The result depends on the input alone.
///
/// Cost: O(n log n) for n triangles, plus what the pairs that conflict need, some 20 microseconds each. Throws
/// InputError if rounding finds no end, with places; Cancelled.
Arrangement arrange(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                    const RunContext& context = {});

}  // namespace octafront
