#pragma once

// Holes: their rims, and what goes over them.

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/mesh/edge_table.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace octafront::mend {

/// The edge between two vertices as a key of hash tables.
constexpr std::uint64_t edge_key(VertexIndex a, VertexIndex b) {
  const auto [low, high] = sorted_edge(a, b);
  return std::uint64_t{low} << 32 | high;
}

/// The rim of a hole: its vertices in the order that triangles which close it run along it, none of them twice.
struct Loop {
  std::vector<VertexIndex> vertices;
  std::vector<std::uint32_t> triangles;  ///< at the rim, from each vertex to the next one
};

/// The closed chains of open edges, in the order of their first half-edges. Requires that neighbouring triangles agree;
/// where they do not, and where open edges end at edges of more than two triangles, there is no loop.
std::vector<Loop> find_loops(std::span<const Triangle> triangles, const EdgeTable& table);

/// Per triangle, whether it is of a fin: a strip with nothing but rim, which no cap makes a body. Of a piece that hangs
/// together by edges of two triangles all vertices lie on edges of another number; some of these are open, and either
/// the others are joined to something or the open ones are one loop. A tube, which has two, is no fin.
std::vector<char> triangles_of_fins(std::span<const Triangle> triangles, const EdgeTable& table,
                                    const std::vector<Loop>& loops);

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

/// A corner of the polygon, and a point of the surface beyond it that an edge joins it with.
using Spoke = std::pair<std::uint32_t, Vec3>;

/// A cap with points of its own: numbers from the polygon's size on are those of `inner`.
struct FairCap {
  Cap triangles;
  std::vector<Vec3> inner;
};

/// Divides a cap's triangles until they are as large as the edges of the rim near them, then bends it so that it goes
/// on as the surface around it begins (refinement and fairing after P. Liepa, "Filling Holes in Meshes", 2003: the
/// least sum of squares of the umbrella operator, with the rim and what is beyond it fixed). Where more than `most`
/// points would be added, triangles grow away from the rim. No edge that `is_taken` is made. Cost: for n points some
/// 100 ns times n^1.5.
FairCap faired(std::span<const Vec3> polygon, const Cap& cap, std::span<const Spoke> beyond, const IsTaken& is_taken,
               std::size_t most);

/// A cap that keeps off the surface: walls from the rim to a flat base across `away`, a unit vector, which is as far
/// beyond the rim and everything that stands over the base as this part of the rim's diameter. Detail of the rim below
/// half of that does not reach the base. `around`: points of the surface. Without triangles where there is no such
/// cap: where the base's outline would cross itself, or what stands over it is too high.
FairCap cap_with_base(std::span<const Vec3> rim, Vec3 away, std::span<const Vec3> around);

/// How thick what the base closes is at least: this part of the rim's diameter.
inline constexpr double kBaseThickness = 0.02;

/// Rims of which the first lies around the others, all in one plane within the tolerance, and the triangles that close
/// them together.
struct SharedLid {
  std::vector<std::uint32_t> loops;  ///< the outer one first
  std::vector<Triangle> cap;
};

/// Where a body with a channel is cut off, its lid has a hole: two lids that lie in each other within rounding would
/// leave membranes over the channel. Constrained Delaunay triangulations seen across the plane; only such that have the
/// rims as their border exactly. `may_share`: per loop.
std::vector<SharedLid> shared_lids(std::span<const Vec3> points, const std::vector<Loop>& loops,
                                   const std::vector<char>& may_share, double tolerance);

}  // namespace octafront::mend
