#pragma once

// When an edge of a mesh of tets may be contracted: T. Dey, H. Edelsbrunner, S. Guha, D. Nekhayev, "Topology preserving
// edge contraction", 1999; the outside is a cone over the walls.

#include <octafront/ids.h>
#include <octafront/tet_mesh.h>

#include "base/mesh/adjacency.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <type_traits>
#include <vector>

namespace octafront {

/// Vertices and edges opposite a vertex in its tets, and in the walls there; each ascending.
struct VertexLink {
  std::vector<VertexIndex> vertices, wall_vertices;
  std::vector<Edge> edges, wall_edges;

  void sort() {
    const auto sort_out = [](auto& list) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    sort_out(vertices), sort_out(wall_vertices), sort_out(edges), sort_out(wall_edges);
  }
};

/// Of the vertex opposite these half-faces, or of its edge to `other`. tet(t): the corners; is_wall(half-face).
template <class TetOf, class IsWall>
VertexLink link_of(std::span<const HalfFace> star, const TetOf& tet, const IsWall& is_wall, VertexIndex other = kNone) {
  VertexLink link;
  for (const HalfFace h : star) {
    const Tet& t = tet(h / 4);
    const auto& f = kTetFaces[h % 4];
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexIndex a = t[f[i]], b = t[f[(i + 1) % 3]];
      const int third = f[(i + 2) % 3];
      // The face at the vertex and the edge ab is opposite the third corner.
      const bool on_wall = is_wall(4 * (h / 4) + static_cast<HalfFace>(third));
      if (other == kNone) {
        link.vertices.push_back(a), link.edges.push_back(sorted_edge(a, b));
        if (on_wall) link.wall_vertices.insert(link.wall_vertices.end(), {a, b});
        if (on_wall) link.wall_edges.push_back(sorted_edge(a, b));
      } else if (t[third] == other) {
        link.vertices.insert(link.vertices.end(), {a, b}), link.edges.push_back(sorted_edge(a, b));
      } else if ((a == other || b == other) && on_wall) {
        link.wall_vertices.push_back(a == other ? b : a);
      }
    }
  }
  link.sort();
  return link;
}

/// Whether the links of both ends meet in that of the edge alone.
inline bool may_contract(const VertexLink& u, const VertexLink& w, const VertexLink& edge) {
  const auto meet_within = [](const auto& a, const auto& b, const auto& allowed) {
    std::remove_cvref_t<decltype(a)> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    return std::includes(allowed.begin(), allowed.end(), common.begin(), common.end());
  };
  return meet_within(u.vertices, w.vertices, edge.vertices) && meet_within(u.edges, w.edges, edge.edges) &&
         meet_within(u.wall_vertices, w.wall_vertices, edge.wall_vertices) &&
         meet_within(u.wall_edges, w.wall_edges, edge.wall_edges);
}

}  // namespace octafront
