#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>

#include "base/geometry/sight_line.h"
#include "soup/cells/side_graph.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace octafront {

/// The cells into which triangles divide space. Cell 0 is the unbounded one, the others are numbered by their first
/// triangle. A triangle with the same cell on both sides does not close.
class Cells {
 public:
  /// Requires triangles that meet in shared vertices and edges only. Keeps the spans. Exact; O(n log n). Throws
  /// Cancelled, InputError for pieces so thin that no double lies inside any of their triangles.
  Cells(std::span<const Vec3> points, std::span<const Triangle> triangles, const RunContext& context = {});

  std::uint32_t count() const { return count_; }
  /// In front of a triangle, and behind it.
  std::array<std::uint32_t, 2> sides_of(std::size_t triangle) const {
    return {cell_[2 * triangle], cell_[2 * triangle + 1]};
  }
  /// One per cell; 0 for the unbounded one.
  std::vector<double> volumes() const;

  /// The cell around a point; nullopt if it lies on a triangle, or so near that nobody can mean one side.
  std::optional<std::uint32_t> at(Vec3 p) const;

  /// A way from one point to another, or to infinity, that goes through no wall: along the walls and through the holes
  /// between them, as points of a polygon. Requires that both lie in one cell. Empty if no wall is in sight from p.
  std::vector<Vec3> way(Vec3 from, std::optional<Vec3> to) const;

  /// Pieces of the surface that hang together over edges, per triangle.
  const std::vector<std::uint32_t>& piece() const { return graph_.piece; }
  std::uint32_t pieces() const { return graph_.pieces; }

 private:
  std::vector<std::vector<Side>> links() const;

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  cells::SideGraph graph_;
  SightLines lines_;
  std::vector<std::array<Side, 2>> seen_;  ///< sides that face each other along a line; kNone: infinity
  std::vector<std::uint32_t> cell_;        ///< per side
  std::uint32_t count_ = 0;
};

}  // namespace octafront
