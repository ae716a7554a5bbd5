#pragma once

#include <octafront/vec.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace octafront::mend {

/// Triangles over a closed polygon in space, with its numbers; they run along it.
using Cap = std::vector<std::array<std::uint32_t, 3>>;

/// Whether an edge between two corners of the polygon, not next to each other, is there already.
using IsTaken = std::function<bool(std::uint32_t, std::uint32_t)>;

/// The triangulation without inner vertices of the least area (G. Barequet and M. Sharir, "Filling Gaps in the Boundary
/// of a Polyhedron", 1995) that uses no taken edge where it can do without. Long polygons are halved by short chords
/// first. Cost: n^3 for n <= 256 corners, n^2 beyond.
Cap triangulate_polygon(std::span<const Vec3> polygon, const IsTaken& is_taken);

}  // namespace octafront::mend
