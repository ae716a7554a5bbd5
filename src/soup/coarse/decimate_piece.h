#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/core/groups.h"
#include "soup/coarse/decimate.h"
#include "soup/coarse/quadric.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// What may become of a vertex. One on a line stays on it; a fixed one stays where it is.
enum class VertexRole : std::uint8_t { kFree, kOnLine, kFixed };

/// Part of a complex, with numbers of its own, which is changed without a look at the rest.
struct Piece {
  std::vector<Vec3> points;
  Vec3 origin;  ///< of the places that quadrics are asked at, so that they keep their digits
  std::vector<Quadric> quadric;
  std::vector<VertexRole> role;
  std::vector<std::uint8_t> is_at_rim;  ///< the vertex has triangles that others may see: neither they nor it change
  std::vector<std::uint8_t> is_wanted;  ///< the vertex is to be removed if it can be
  std::vector<Triangle> triangles;      ///< one that is removed has kNone for its first corner
  std::vector<std::uint32_t> sheet;     ///< per triangle: between two sheets lies a line; numbered anew by decimate()

  // As LiveTriangles asks.
  std::size_t triangle_count() const { return triangles.size(); }
  bool is_removed(std::uint32_t t) const { return triangles[t][0] == kNone; }
  const Triangle& triangle(std::uint32_t t) const { return triangles[t]; }
  Vec3 corner(std::uint32_t t, int i) const { return points[triangles[t][i]]; }
};

/// Whether each collapse is tested for what its triangles would cross: slow, and hardly ever needed.
enum class Crossings { kUntested, kTested };

/// Collapses what the limits let go.
void decimate(Piece& piece, const DecimationLimits& limits, Crossings crossings, const RunContext& context);

}  // namespace octafront
