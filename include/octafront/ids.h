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

/// The corners as a key: the same of a triangle and its back.
constexpr Triangle sorted_corners(const Triangle& t) {
  const Edge first = sorted_edge(t[0], t[1]);
  if (first[1] <= t[2]) return {first[0], first[1], t[2]};
  const Edge second = sorted_edge(first[0], t[2]);
  return {second[0], second[1], first[1]};
}

/// The regions on the two sides of a triangle: in front, where its normal points, and behind; kNone: outside.
using Sides = std::array<std::uint32_t, 2>;

}  // namespace octafront
