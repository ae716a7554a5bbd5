#pragma once

#include <array>
#include <cstdint>

namespace octafront {

/// Index of a vertex in the `points` of its mesh. 32 bits: a mesh holds fewer than 2^32 - 1 vertices.
using VertexIndex = std::uint32_t;
/// "No such vertex, face, element or patch".
inline constexpr std::uint32_t kNone = 0xffffffffu;

/// Vertex indices, counter-clockwise when seen from outside the body.
using Triangle = std::array<VertexIndex, 3>;
/// Two vertex indices; as a key of an undirected edge the smaller one comes first.
using Edge = std::array<VertexIndex, 2>;
constexpr Edge sorted_edge(VertexIndex a, VertexIndex b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

/// The corners in ascending order: the same for all triangles on these vertices. A key.
constexpr Triangle face_key(const Triangle& t) {
  const VertexIndex low = t[0] < t[1] ? t[0] : t[1], high = t[0] < t[1] ? t[1] : t[0];
  const VertexIndex lower = high < t[2] ? high : t[2];
  return {low < t[2] ? low : t[2], low < lower ? lower : low, high < t[2] ? t[2] : high};
}

/// The regions on the two sides of a triangle: in front, where its normal points, and behind; kNone: outside.
using Sides = std::array<std::uint32_t, 2>;

}  // namespace octafront
