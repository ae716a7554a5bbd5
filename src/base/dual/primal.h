#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/groups.h"
#include "base/dual/layer_cells.h"
#include "base/mesh/adjacency.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace octafront::dual {

/// Corner i of tetrahedron t, as 4 * t + i: the part of it that belongs to a cell of the dual.
using Corner = std::uint32_t;

/// The corner of a triangle that is neither of two others.
inline VertexIndex third(const Triangle& t, VertexIndex a, VertexIndex b) {
  return t[0] ^ t[1] ^ t[2] ^ a ^ b;
}

/// A tetrahedron at an edge, between the faces by which one comes in and goes out, counter-clockwise about the edge.
struct Spoke {
  Corner from, to;  ///< the ends of the edge
  HalfFace entry, exit;

  TetIndex tet() const { return from / 4; }
  /// The corners that the faces have besides: each lies opposite the other face, and has its number.
  Corner at_entry() const { return exit; }
  Corner at_exit() const { return entry; }
};

/// The mesh whose dual is made, with what all steps ask of it.
class Primal {
 public:
  explicit Primal(const TetMesh& of);

  const TetMesh& mesh;
  std::vector<HalfFace> across;
  LayerCells layers;
  Groups<> corners;  ///< at each vertex, ascending

  VertexIndex vertex_of(Corner c) const { return mesh.tets[c / 4][c % 4]; }
  /// The corner of a tetrahedron at one of its vertices.
  Corner corner_at(TetIndex t, VertexIndex v) const {
    Corner c = 4 * t;
    while (mesh.tets[t][c % 4] != v) ++c;
    return c;
  }
  std::uint32_t region_of(TetIndex t) const { return mesh.region.empty() ? 0 : mesh.region[t]; }
  /// Whether cells end there: at the boundary, at interfaces and sheets.
  bool is_wall(HalfFace h) const { return is_wall_[h]; }
  /// Of a wall; kNone: none.
  std::uint32_t patch_of(HalfFace h) const;
  HalfFace lower_side(HalfFace h) const { return std::min(h, across[h]); }
  bool is_curve(VertexIndex a, VertexIndex b) const;
  /// From a half-face at an edge through the material there, to the next one where it ends: ends(half-face).
  template <class Ends>
  HalfFace end_across(HalfFace h, VertexIndex v, VertexIndex w, const Ends& ends) const {
    while (true) {
      // The other face at the edge lies opposite the corner that this one has besides.
      h = corner_at(h / 4, third(corners_of(mesh.tets, h), v, w));
      if (ends(h)) return h;
      h = across[h];
    }
  }

  /// Calls visit(spokes, is_closed) for the tetrahedra at an edge, given by their corners at its first end, chain by
  /// chain: from boundary to boundary, or all around.
  template <class Visit>
  void for_each_chain(std::span<const Corner> at_edge, VertexIndex to, std::vector<Spoke>& room,
                      const Visit& visit) const;

 private:
  Spoke spoke(Corner from, VertexIndex to) const;
  void find_walls();

  std::vector<bool> is_wall_;
  std::vector<std::pair<HalfFace, std::uint32_t>> patches_;  ///< of half-faces that are walls of patches, ascending
  std::vector<Edge> curves_;
};

/// Calls visit(other end, corners here of the tetrahedra at the edge) for all edges of a vertex, by their other ends.
template <class Visit>
void for_each_edge(const Primal& primal, VertexIndex v, std::vector<std::pair<VertexIndex, Corner>>& room,
                   std::vector<Corner>& at_edge, const Visit& visit) {
  room.clear();
  for (const Corner c : primal.corners[v])
    for (const VertexIndex w : primal.mesh.tets[c / 4])
      if (w != v) room.emplace_back(w, c);
  std::sort(room.begin(), room.end());
  for (std::size_t i = 0, j = 0; i < room.size(); i = j) {
    at_edge.clear();
    for (; j < room.size() && room[j].first == room[i].first; ++j) at_edge.push_back(room[j].second);
    visit(room[i].first, std::span<const Corner>(at_edge));
  }
}

template <class Visit>
void Primal::for_each_chain(std::span<const Corner> at_edge, VertexIndex to, std::vector<Spoke>& room,
                            const Visit& visit) const {
  room.clear();
  for (const Corner c : at_edge) room.push_back(spoke(c, to));
  std::size_t done = 0;  // so many are in chains, and stand in front
  const auto take = [&](std::size_t i) { std::swap(room[done++], room[i]); };
  const auto follow = [&](std::size_t first) {
    while (true) {
      const HalfFace next = across[room[done - 1].exit];
      std::size_t i = done;
      while (i < room.size() && room[i].entry != next) ++i;
      if (next == kNone || i == room.size()) break;
      take(i);
    }
    const bool is_closed = room[done - 1].exit == across[room[first].entry];
    visit(std::span<const Spoke>(room).subspan(first, done - first), is_closed);
  };
  // Chains begin at the boundary, those that are closed at the lowest tetrahedron.
  while (done < room.size()) {
    const std::size_t first = done;
    const auto begin = std::find_if(room.begin() + static_cast<std::ptrdiff_t>(done), room.end(),
                                    [&](const Spoke& s) { return across[s.entry] == kNone; });
    take(begin == room.end() ? done : static_cast<std::size_t>(begin - room.begin()));
    follow(first);
  }
}

}  // namespace octafront::dual
