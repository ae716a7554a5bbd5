#pragma once

#include <octafront/run_context.h>
#include <octafront/vec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::io {

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
