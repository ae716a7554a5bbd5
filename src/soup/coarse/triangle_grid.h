#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/core/elementary.h"
#include "base/geometry/triangle_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace octafront {

/// Small triangles by the cell of a grid that their middle lies in: cheap to change, and to ask what a small box meets.
class TriangleGrid {
 public:
  /// `edge`: no triangle will have a longer edge, but those that there are now.
  TriangleGrid(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles, double edge)
      : next_(triangles.size()), cell_(triangles.size()) {
    Box3 box;
    for (const Triangle& t : triangles) {
      const TriangleCorners at{points[t[0]], points[t[1]], points[t[2]]};
      const Vec3 middle = middle_of(at);
      box.add(middle);
      for (const Vec3& p : at) reach_ = std::max(reach_, distance(p, middle));
    }
    reach_ = std::max(reach_, edge) * (1 + 1e-12);
    lo_ = box.lo;
    const Vec3 extent = box.extent();
    // Not more cells than triangles need, however small the edge is beside the box.
    const double most = elementary::cbrt(8.0 * static_cast<double>(triangles.size()));
    side_ = std::max(edge, std::max({extent.x, extent.y, extent.z}) / std::max(1.0, most));
    for (int i = 0; i < 3; ++i) cells_[i] = 1 + static_cast<int>(extent[i] / side_);
    head_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2], kNone);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      put(t, cell_at({points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]}));
  }

  /// Calls visit(t, its corners) for the triangles that may meet the box, until one says false; returns false then.
  template <class Mesh, class Visit>
  bool for_each_near(const Box3& box, const Mesh& mesh, const Visit& visit) {
    const Vec3 reach{reach_, reach_, reach_};
    const std::array<int, 3> lo = clamped(box.lo - reach), hi = clamped(box.hi + reach);
    for (int k = lo[2]; k <= hi[2]; ++k)
      for (int j = lo[1]; j <= hi[1]; ++j)
        for (int i = lo[0]; i <= hi[0]; ++i)
          if (!for_each_in(head_[number(i, j, k)], box, mesh, visit)) return false;
    return true;
  }

  void move(std::uint32_t t, const TriangleCorners& at) {
    const std::uint32_t cell = cell_at(at);
    if (cell == cell_[t]) return;
    std::uint32_t* link = &head_[cell_[t]];
    while (*link != t) link = &next_[*link];
    *link = next_[t];
    put(t, cell);
  }

 private:
  template <class Mesh, class Visit>
  bool for_each_in(std::uint32_t& head, const Box3& box, const Mesh& mesh, const Visit& visit) {
    for (std::uint32_t* link = &head; *link != kNone;) {
      const std::uint32_t t = *link;
      if (mesh.is_removed(t)) {
        *link = next_[t];
        continue;
      }
      const Triangle& ids = mesh.triangles[t];
      const TriangleCorners at{mesh.points[ids[0]], mesh.points[ids[1]], mesh.points[ids[2]]};
      if (box_of(at).overlaps(box) && !visit(t, at)) return false;
      link = &next_[t];
    }
    return true;
  }

  static Vec3 middle_of(const TriangleCorners& t) { return (t[0] + t[1] + t[2]) / 3.0; }

  std::array<int, 3> clamped(Vec3 p) const {
    std::array<int, 3> cell{};
    for (int i = 0; i < 3; ++i)
      cell[i] = static_cast<int>(std::clamp((p[i] - lo_[i]) / side_, 0.0, static_cast<double>(cells_[i] - 1)));
    return cell;
  }
  std::uint32_t number(int i, int j, int k) const {
    return static_cast<std::uint32_t>((k * cells_[1] + j) * cells_[0] + i);
  }
  std::uint32_t cell_at(const TriangleCorners& at) const {
    const auto [i, j, k] = clamped(middle_of(at));
    return number(i, j, k);
  }
  void put(std::uint32_t t, std::uint32_t cell) {
    cell_[t] = cell;
    next_[t] = head_[cell];
    head_[cell] = t;
  }

  Vec3 lo_;
  double side_ = 1, reach_ = 0;
  std::array<int, 3> cells_{};
  std::vector<std::uint32_t> head_, next_, cell_;
};

}  // namespace octafront
