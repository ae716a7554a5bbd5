#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/vec.h>

#include "base/core/parallel.h"
#include "base/core/shared_value.h"

#include <cstddef>
#include <span>
#include <vector>

namespace octafront {

/// Keeps the points v, or what there is of each, with number[v] != kNone, in their order. On return number[v] is where
/// point v went.
template <class Point>
void keep_numbered(std::vector<Point>& points, std::vector<VertexIndex>& number) {
  VertexIndex next = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (number[v] == kNone) continue;
    points[next] = points[v];
    number[v] = next++;
  }
  points.resize(next);
}

/// Replaces each vertex of the rows (triangles, tets, edges) by its new number.
template <class Rows>
void renumber(Rows& rows, const std::vector<VertexIndex>& number) {
  parallel_for(rows.size(), [&](std::size_t i) {
    for (VertexIndex& v : rows[i]) v = number[v];
  });
}

/// Points taken out of others, numbered as they come.
class PointsTaken {
 public:
  explicit PointsTaken(std::span<const Vec3> from) : from_(from), number_(from.size(), kNone) {}

  /// A row of theirs (triangle, tet) by its numbers in `to`, which gets the points that it has not yet.
  template <class Row>
  Row take(Row row, std::vector<Vec3>& to) {
    for (VertexIndex& v : row) {
      if (number_[v] == kNone) number_[v] = static_cast<VertexIndex>(to.size()), to.push_back(from_[v]);
      v = number_[v];
    }
    return row;
  }

 private:
  std::span<const Vec3> from_;
  std::vector<VertexIndex> number_;
};

/// Gives each vertex of the rows a number: 0.
template <class Rows>
void mark_used(const Rows& rows, std::vector<VertexIndex>& number) {
  parallel_for(rows.size(), [&](std::size_t i) {
    for (const VertexIndex v : rows[i]) SharedValue(number[v]).store(0);
  });
}

/// Points that no triangle uses go; the first `kept` stay where they are, used or not.
void drop_unused_points(std::vector<Vec3>& points, std::vector<Triangle>& triangles, std::size_t kept = 0);

}  // namespace octafront
