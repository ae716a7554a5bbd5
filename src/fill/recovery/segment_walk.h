#pragma once

#include "base/mesh/tet_complex.h"
#include "fill/recovery/exact_points.h"

#include <vector>

namespace octafront::recovery {

/// What a segment passes on its way through the mesh: the inside of a face, or a point inside an edge. Before it lies a
/// piece of the segment inside a tet, or inside a face of that tet.
struct Crossing {
  bool is_edge = false;
  HalfFace face = kNone;             ///< the crossed face, seen from the side of the segment's start; kNone for an edge
  VertexIndex x = kNone, y = kNone;  ///< the crossed edge
  TetIndex tet = kNone;              ///< the tet before the face, or one of those around the edge
  HalfFace piece_face =
      kNone;  ///< the face in which the piece before the crossing lies; kNone: it lies inside piece_tet
  TetIndex piece_tet = kNone;
};

/// Where the segment (a, b) leaves the star of a.
struct FirstHit {
  VertexIndex vertex = kNone;  ///< a vertex on the ray; if it is b, the edge is in the mesh
  TetIndex tet = kNone;        ///< a tet of the star that holds the first piece
  Crossing crossing;           ///< if vertex is kNone
};

/// Walks through the star of a towards b.
FirstHit first_hit(const ExactPoints& points, TetComplex& mesh, VertexIndex a, VertexIndex b);

/// All crossings of the segment (a, b) in order, into `crossings`; empty if the edge is in the mesh. Stops after
/// kMostCrossings: one of them divides the segment. Throws MeshingError if the segment passes through a vertex: then
/// the surface touches itself there. A piece after the last crossing: `last_piece_face`, `last_piece_tet` as in
/// Crossing.
struct SegmentWalk {
  static constexpr std::size_t kMostCrossings = 400;
  std::vector<Crossing> crossings;
  bool present = false;
  HalfFace last_piece_face = kNone;
  TetIndex last_piece_tet = kNone;
};
void walk_segment(const ExactPoints& points, TetComplex& mesh, VertexIndex a, VertexIndex b, SegmentWalk& walk);

/// A tet that has the edge (a, b), or kNone.
TetIndex tet_with_edge(const ExactPoints& points, TetComplex& mesh, VertexIndex a, VertexIndex b);

}  // namespace octafront::recovery
