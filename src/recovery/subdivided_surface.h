#pragma once

#include <octafront/surface_mesh.h>

#include "recovery/flips.h"

#include <map>
#include <vector>

namespace octafront::recovery {

/// The input's triangles, divided by Steiner points on their edges and inside them. Facet f < the number of input
/// triangles starts as input triangle f.
class SubdividedSurface {
 public:
  struct Facet {
    Triangle corners;      ///< counter-clockwise seen from outside
    std::uint32_t parent;  ///< the input triangle
    bool alive = true;
  };

  SubdividedSurface(const std::vector<Triangle>& triangles, VertexIndex vertices);

  const std::vector<Facet>& facets() const { return facets_; }
  const EdgeSet& edges() const { return edges_; }
  /// All undirected edges, smaller vertex first, sorted.
  std::vector<Edge> edge_list() const;
  /// The living facets that have the edge (a, b).
  std::vector<std::uint32_t> facets_around(VertexIndex a, VertexIndex b) const;

  /// Vertex s, inside edge (a, b), divides it and its facets. Appends the new edges that are not parts of (a, b).
  void split_edge(VertexIndex a, VertexIndex b, VertexIndex s, std::vector<Edge>& new_edges);
  /// Vertex s, inside facet f, divides it into three. Appends the new edges.
  void split_facet(std::uint32_t f, VertexIndex s, std::vector<Edge>& new_edges);

 private:
  void add_facet(const Triangle& corners, std::uint32_t parent);

  std::vector<Facet> facets_;
  EdgeSet edges_;
  std::vector<std::uint32_t> first_, facet_at_;                 ///< input facets per vertex, compressed
  std::map<VertexIndex, std::vector<std::uint32_t>> added_at_;  ///< facets that came later
};

}  // namespace octafront::recovery
