#include "formats/parts/mixed_cells.h"

#include "base/core/renumber.h"
#include "base/mesh/quadratic_nodes.h"

#include <algorithm>

namespace octafront::io {
namespace {

/// The mid-side node of an edge of a wide cell.
VertexIndex mid_node(const TetMesh& mesh, const WideCell& cell, VertexIndex a, VertexIndex b) {
  for (TetIndex t = cell.first; t < cell.first + cell.tet_count; ++t)
    if (const std::size_t e = edge_between(mesh.tets[t], a, b); e < 6) return mesh.mid_nodes[t][e];
  return kNone;
}

/// Node `place` of a wide cell, in our order.
VertexIndex node_of(const TetMesh& mesh, const WideCell& cell, std::size_t place) {
  const std::size_t corners = cell.tet_count + 3;
  if (place < corners) return cell.nodes[place];
  const auto& [i, j] = corners == 6 ? kWedgeEdges[place - 6] : kPyramidEdges[place - 5];
  return mid_node(mesh, cell, cell.nodes[i], cell.nodes[j]);
}

}  // namespace

MixedCells::MixedCells(const MeshParts& mesh) : mesh_(mesh) {
  const auto wide = mesh.wide_cells();
  end_.fill(mesh.tets());
  if (!wide.empty()) {
    cell_of_.assign(mesh.tets(), kNone);
    for (std::uint32_t w = 0; w < wide.size(); ++w)
      for (std::uint32_t k = 0; k < wide[w].tet_count; ++k) cell_of_[wide[w].first + k] = 0;
    for (TetIndex t = 0; t < mesh.tets(); ++t) {
      if (cell_of_[t] != kNone) continue;
      cell_of_[t] = static_cast<std::uint32_t>(tets_.size());
      tets_.push_back(t);
    }
    end_[kTet] = tets_.size();
    for (const Kind kind : {kPyramid, kWedge}) {
      for (std::uint32_t w = 0; w < wide.size(); ++w) {
        if (wide[w].tet_count != kind + 1) continue;
        for (std::uint32_t k = 0; k < wide[w].tet_count; ++k)
          cell_of_[wide[w].first + k] = static_cast<std::uint32_t>(end_[kTet] + wide_.size());
        wide_.push_back(w);
      }
      end_[kind] = end_[kTet] + wide_.size();
    }
  }
  if (quads() == 0) return;
  face_of_.assign(mesh.faces(), kNone);
  for (std::uint32_t q = 0; q < quads(); ++q) {
    const std::uint32_t first = mesh.wide_faces()[q].first;
    face_of_[first] = face_of_[first + 1] = static_cast<std::uint32_t>(triangles()) + q;
  }
  for (std::uint32_t f = 0; f < face_of_.size(); ++f) {
    if (face_of_[f] != kNone) continue;
    face_of_[f] = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back(f);
  }
}

std::size_t MixedCells::nodes_per(Kind kind) const {
  constexpr std::array<std::array<std::size_t, kKinds>, 2> kNodes{{{4, 5, 6}, {10, 13, 15}}};
  return kind == kTet ? mesh_.nodes_per_tet() : kNodes[mesh_.second_order()][kind];
}

TetIndex MixedCells::first_tet(std::size_t cell) const {
  if (cell >= end_[kTet]) return wide(cell).first;
  return tets_.empty() ? static_cast<TetIndex>(cell) : tets_[cell];
}

VertexIndex MixedCells::node(std::size_t cell, std::size_t k, const WideOrder& order) const {
  if (cell < end_[kTet]) return mesh_.tet_node(first_tet(cell), k);
  return node_of(mesh_.mesh(), wide(cell), order.of(cell >= end_[kPyramid])[k]);
}

std::span<const VertexIndex> MixedCells::nodes(std::size_t cell, CellRoom& room, const WideOrder& order) const {
  const std::size_t count = nodes_per(kind(cell));
  for (std::size_t k = 0; k < count; ++k) room[k] = node(cell, k, order);
  return std::span(room).first(count);
}

std::size_t MixedCells::side_of(std::size_t cell, std::size_t face) const {
  const WideCell& of = wide(cell);
  const auto& sides = of.tet_count == 3 ? kWedgeFaces : kPyramidFaces;
  FaceRoom room;
  const auto corners = face_nodes(face, room).first(face < triangles() ? 3 : 4);
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto has = [&](VertexIndex v) {
      return std::ranges::any_of(sides[s], [&](std::size_t k) { return of.nodes[k] == v; });
    };
    if (std::ranges::all_of(corners, has)) return s;
  }
  return 0;
}

std::size_t MixedCells::first_face(std::size_t face) const {
  if (face >= triangles()) return mesh_.wide_faces()[face - triangles()].first;
  return triangles_.empty() ? face : triangles_[face];
}

VertexIndex MixedCells::face_node(std::size_t face, std::size_t k) const {
  if (face < triangles()) return mesh_.face_node(first_face(face), k);
  const auto& corners = mesh_.wide_faces()[face - triangles()].nodes;
  return k < 4 ? corners[k] : mesh_.mid_node(corners[k - 4], corners[(k - 3) % 4]);
}

std::span<const VertexIndex> MixedCells::face_nodes(std::size_t face, FaceRoom& room) const {
  const std::size_t count = face < triangles() ? mesh_.nodes_per_face() : nodes_per_quad();
  for (std::size_t k = 0; k < count; ++k) room[k] = face_node(face, k);
  return std::span(room).first(count);
}

std::vector<std::uint32_t> MixedCells::members(const Part& part) const {
  std::vector<std::uint32_t> all(part.members.begin(), part.members.end());
  if (part.kind == NamedSet::Kind::kElements && !cell_of_.empty())
    for (std::uint32_t& m : all) m = cell_of_[m];
  if (part.kind == NamedSet::Kind::kFaces && !face_of_.empty())
    for (std::uint32_t& m : all) m = face_of_[m];
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

WithoutDiagonals without_diagonals(const TetMesh& mesh) {
  if (!mesh.is_second_order() || mesh.wide_cells.empty()) return {};
  std::vector<bool> is_used(mesh.points.size(), false), is_wide(mesh.tets.size(), false);
  for (const WideCell& cell : mesh.wide_cells) {
    std::fill_n(is_wide.begin() + cell.first, cell.tet_count, true);
    const std::size_t count = cell.tet_count == 3 ? kPlainWide.wedge.size() : kPlainWide.pyramid.size();
    for (std::size_t k = 0; k < count; ++k) is_used[node_of(mesh, cell, k)] = true;
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (is_wide[t]) continue;
    for (const VertexIndex v : mesh.tets[t]) is_used[v] = true;
    for (const VertexIndex v : mesh.mid_nodes[t]) is_used[v] = true;
  }
  const auto kept = static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), true));
  WithoutDiagonals result{std::nullopt, mesh.points.size() - kept};
  if (std::all_of(is_used.begin(), is_used.begin() + static_cast<std::ptrdiff_t>(kept), [](bool used) { return used; }))
    return result;
  std::vector<VertexIndex> place(mesh.points.size());
  VertexIndex next = 0;
  for (const bool used : {true, false})
    for (VertexIndex v = 0; v < place.size(); ++v)
      if (is_used[v] == used) place[v] = next++;
  TetMesh& moved = result.mesh.emplace(mesh);
  for (VertexIndex v = 0; v < place.size(); ++v) moved.points[place[v]] = mesh.points[v];
  renumber(moved.mid_nodes, place);  // corners stand before all others
  for (NamedSet& set : moved.sets) {
    if (set.kind != NamedSet::Kind::kNodes) continue;
    for (std::uint32_t& m : set.members) m = place[m];
    std::sort(set.members.begin(), set.members.end());
  }
  return result;
}

}  // namespace octafront::io
