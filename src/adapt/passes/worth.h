#pragma once

#include "adapt/passes/piece.h"

#include <algorithm>
#include <array>

namespace octafront::adapt {

/// What is mended: elements of a lower score (qualities of .34 and, in metrics of size, .54), or with a longer edge.
inline constexpr float kPoorInMetric = 0.2f, kPoorOfSize = 0.4f;
inline constexpr double kLongOfPoor = 1.6;
/// What mends makes the worst element of its place better by so much.
inline constexpr float kGainOfMending = 1.03f;

/// How far an element is from poor, at 1: by its score, or by the volume that its longest edge is too much for.
/// `mesh`: a Piece, or Parts.
template <class Mesh>
float worth_of_corners(const std::array<const Vertex*, 4>& c, const Mesh& mesh) {
  const bool isotropic = mesh.isotropic;
  const float score = score_of_corners(c, isotropic) / mesh.poor;
  if (!(score > 0)) return 0;
  double longest = 0;
  for (const auto& [i, j] : kTetEdges)
    if (!squared_bounds(*c[i], *c[j], isotropic).surely_within(longest))
      longest = std::max(longest, length_between(*c[i], *c[j], isotropic));
  const double excess = kLongOfPoor / longest;
  return std::min(score, static_cast<float>(excess * excess * excess));
}
template <class Mesh>
float worth_of(const Mesh& mesh, const Tet& t) {
  const auto corner = [&](std::size_t i) { return &mesh.vertices[t[i]]; };
  return worth_of_corners({corner(0), corner(1), corner(2), corner(3)}, mesh);
}
/// Whether worth_of() is below 1.
template <class Mesh>
bool is_poor(const Mesh& mesh, const Tet& t) {
  const auto corner = [&](int i) { return &mesh.vertices[t[i]]; };
  if (score_of_corners({corner(0), corner(1), corner(2), corner(3)}, mesh.isotropic) < mesh.poor) return true;
  return std::any_of(kTetEdges.begin(), kTetEdges.end(), [&](const auto& e) {
    const Vertex &p = *corner(e[0]), &q = *corner(e[1]);
    return !squared_bounds(p, q, mesh.isotropic).surely_within(kLongOfPoor) &&
           length_between(p, q, mesh.isotropic) > kLongOfPoor;
  });
}
/// Whether an element is poor, and something around it has changed since all was tried to mend it.
template <class Mesh>
bool is_to_mend(const Mesh& mesh, const Tet& t) {
  return std::any_of(t.begin(), t.end(), [&](VertexIndex v) { return mesh.vertices[v].calmness != Vertex::kCalm; }) &&
         is_poor(mesh, t);
}
inline bool is_to_mend(const Piece& piece, TetIndex t) {
  return is_to_mend(piece, piece.tet(t));
}

}  // namespace octafront::adapt
