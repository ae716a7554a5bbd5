#pragma once

#include "base/core/flat_map.h"
#include "fill/recovery/exact_points.h"
#include "fill/recovery/labelled_complex.h"

#include <vector>

namespace octafront::recovery {

/// A set of undirected edges.
class EdgeSet {
 public:
  void reserve(std::size_t edges) { set_.reserve(edges); }
  void insert(VertexIndex a, VertexIndex b) { set_.insert(key(a, b)); }
  void erase(VertexIndex a, VertexIndex b) { set_.erase(key(a, b)); }
  bool contains(VertexIndex a, VertexIndex b) const { return set_.contains(key(a, b)); }

 private:
  static Edge key(VertexIndex a, VertexIndex b) { return a < b ? Edge{a, b} : Edge{b, a}; }

  FlatSet<Edge> set_;
};

/// How much a face or an edge of the mesh hinders what is to be recovered; flips lower the sum.
class Hindrance {
 public:
  virtual ~Hindrance() = default;
  virtual double of_face(VertexIndex x, VertexIndex y, VertexIndex z) const = 0;
  virtual double of_edge(VertexIndex x, VertexIndex y) const = 0;
};

/// Of a missing edge (a, b): 1 for each face that it crosses inside, 3 for each edge.
class SegmentHindrance final : public Hindrance {
 public:
  /// `off_plane`: four vertices that are not coplanar, away from the surface.
  SegmentHindrance(const ExactPoints& points, VertexIndex a, VertexIndex b, VertexIndex off_plane)
      : points_(points), a_(a), b_(b), off_plane_(off_plane) {}
  double of_face(VertexIndex x, VertexIndex y, VertexIndex z) const override;
  double of_edge(VertexIndex x, VertexIndex y) const override;

 private:
  const ExactPoints& points_;
  VertexIndex a_, b_, off_plane_;
};

/// Of a missing facet whose three edges are in the mesh: 1 for each edge that crosses it.
class FacetHindrance final : public Hindrance {
 public:
  FacetHindrance(const ExactPoints& points, Triangle facet) : points_(points), f_(facet) {}
  double of_face(VertexIndex, VertexIndex, VertexIndex) const override { return 0; }
  double of_edge(VertexIndex x, VertexIndex y) const override;

 private:
  const ExactPoints& points_;
  Triangle f_;
};

/// The edge (p, q), and a tet that has it.
struct EdgeOfTet {
  TetIndex tet;
  VertexIndex p, q;
};

/// Local changes that keep all tets positive, all edges of `kept` and all labelled faces.
class Flipper {
 public:
  Flipper(const ExactPoints& points, LabelledComplex& mesh, const EdgeSet& kept)
      : points_(points), mesh_(mesh), kept_(kept) {}

  /// The 2-3 flip: an edge takes the place of face h, if the hindrance then changes by at most `limit`.
  bool flip_face(HalfFace h, const Hindrance& hindrance, double limit);
  /// Removes the edge, and triangulates the ring around it in the best way (dynamic programming), if the hindrance then
  /// changes by at most `limit`. Rings of more than kMaxRing tets are not tried. Vertex `ear` of the ring gets no new
  /// edge.
  bool remove_edge(const EdgeOfTet& edge, const Hindrance& hindrance, double limit, VertexIndex ear = kNone);
  /// The same, and where it fails it first makes the ring smaller, by flips of the faces around it and by removing
  /// the edges of those faces, which again may need smaller rings, `depth` times. The mesh may change even if it fails
  /// in the end; the hindrance does not rise.
  bool remove_edge_deep(const EdgeOfTet& edge, const Hindrance& hindrance, double limit, int depth);

  /// A tet with the edge (p, q), `guess` if it has it; kNone if the mesh has no such edge.
  TetIndex find_tet(TetIndex guess, VertexIndex p, VertexIndex q);

  static constexpr std::size_t kMaxRing = 11;

 private:
  void collect_triangles(std::size_t i, std::size_t j, std::vector<Tet>& fresh, VertexIndex p, VertexIndex q) const;

  bool remove_with_budget(EdgeOfTet edge, const Hindrance& hindrance, double limit, VertexIndex ear, int depth);
  bool shrink_ring(const EdgeOfTet& edge, const Hindrance& hindrance, VertexIndex ear, int depth);

  const ExactPoints& points_;
  LabelledComplex& mesh_;
  const EdgeSet& kept_;
  EdgeRing ring_;
  int budget_ = 0;  ///< attempts left to the deep removal that is under way
  std::vector<Tet> fresh_;
  double best_[kMaxRing][kMaxRing];
  std::size_t middle_[kMaxRing][kMaxRing];
};

}  // namespace octafront::recovery
