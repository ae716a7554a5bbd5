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

/// What a cap has least of: turns at its edges and area, or area alone.
enum class Least { kBend, kArea };

/// A triangulation without inner vertices that bends little: of least sum of edge length times turn of the normal, over
/// its inner edges and the rim, plus its area over the size of the polygon (after G. Barequet and M. Sharir, "Filling
/// Gaps in the Boundary of a Polyhedron", 1995, and P. Liepa, "Filling Holes in Meshes", 2003). It uses no taken edge
/// where it can do without. `beyond`: unit normals of what lies beyond edge i, from corner i to the next one; zero
/// where nothing does. Long polygons are halved by short chords first. Cost: n^3 for n <= 256 corners, n^2 beyond.
Cap triangulate_polygon(std::span<const Vec3> polygon, std::span<const Vec3> beyond, const IsTaken& is_taken,
                        Least least = Least::kBend);

}  // namespace octafront::mend
