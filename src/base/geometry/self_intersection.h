#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>

#include "base/geometry/triangle_tree.h"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace octafront {

/// Pairs of triangles (smaller index first) that conflict in the sense of triangles_conflict, exactly, sorted.
/// Degenerate triangles conflict with whatever their boxes meet; drop them first. At most `limit` pairs; where there
/// are more, those returned are the same in every run and on any number of threads.
std::vector<std::array<std::uint32_t, 2>> self_intersections(
    std::span<const Vec3> points, std::span<const Triangle> triangles,
    std::size_t limit = std::numeric_limits<std::size_t>::max(), const RunContext& context = {});

/// The same with a tree over the same triangles at hand.
std::vector<std::array<std::uint32_t, 2>> self_intersections(
    const TriangleTree& tree, std::span<const Triangle> triangles,
    std::size_t limit = std::numeric_limits<std::size_t>::max(), const RunContext& context = {});

}  // namespace octafront
