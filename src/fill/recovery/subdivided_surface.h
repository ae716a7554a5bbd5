#pragma once

#include <octafront/ids.h>

#include "fill/recovery/flips.h"

#include <map>
#include <vector>

namespace octafront::recovery {

/// The edges of the surface, divided by Steiner points, and the facets into which the input's triangles are cut once
/// their edges are in the mesh.
class SubdividedSurface {
 public:
  struct Facet {
    Triangle corners;      ///< counter-clockwise seen from outside
    std::uint32_t parent;  ///< the input triangle
  };

  explicit SubdividedSurface(const std::vector<Triangle>& triangles);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// What the labels of the mesh's faces refer to.
  const std::vector<Facet>& facets() const { return facets_; }
  /// All undivided edges; the mesh must keep those that it has.
  const EdgeSet& edges() const { return edges_; }
  /// The input's undirected edges, smaller vertex first, sorted.
  std::vector<Edge> input_edges() const;

  void add_edge(VertexIndex a, VertexIndex b) { edges_.insert(a, b); }
  /// Vertex s, inside edge (a, b), divides it.
  void split_edge(VertexIndex a, VertexIndex b, VertexIndex s);
  /// Appends a and all points that divide the edge from a to b, in order, without b.
  void expand(VertexIndex a, VertexIndex b, std::vector<VertexIndex>& chain) const;
  /// True if an edge of the triangle is divided.
  bool is_divided(const Triangle& t) const;
  std::uint32_t add_facet(const Triangle& corners, std::uint32_t parent);

 private:
  const std::vector<Triangle>& triangles_;
  std::vector<Facet> facets_;
  EdgeSet edges_;
  std::map<Edge, VertexIndex> middle_;  ///< of a divided edge, smaller vertex first
};

}  // namespace octafront::recovery
