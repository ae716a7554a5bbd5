#include "base/mesh/mesh_share.h"
#include "base/shared/in_parts.h"
#include "base/shared/marks.h"
#include "base/shared/shared_tets.h"
#include "formats/parts/boundary.h"
#include "formats/parts/pieces.h"

#include <algorithm>

namespace octafront::io {

namespace {

/// A tetrahedron of another rank.
struct Ghost {
  std::uint64_t number = 0;
  Tet corners{};
  std::uint32_t region = 0, part = 0;
};

/// Those of other ranks that share a corner with one of this rank, in order of their numbers.
std::vector<Ghost> ghosts_around(const TetMesh& share, const Comm& comm) {
  const std::vector<std::uint8_t> is_here = vertices_in_use(share);
  const std::vector<std::uint8_t> is_at_rim = marked_by_several(comm, is_here, "vertices at rims");
  const std::uint64_t first = count_tets(share, comm).before;
  std::vector<Ghost> mine, around;
  for (std::size_t t = 0; t < share.tets.size(); ++t)
    if (std::ranges::any_of(share.tets[t], [&](VertexIndex v) { return is_at_rim[v] != 0; }))
      mine.push_back({first + t, share.tets[t], share.region.empty() ? 0 : share.region[t],
                      static_cast<std::uint32_t>(comm.rank())});
  gather_in_parts(comm, mine, "elements around shares", [&](int rank, std::span<const Ghost> part) {
    if (rank == comm.rank()) return;
    for (const Ghost& ghost : part)
      if (std::ranges::any_of(ghost.corners, [&](VertexIndex v) { return is_here[v] != 0; })) around.push_back(ghost);
  });
  std::ranges::sort(around, {}, &Ghost::number);
  return around;
}

/// Those of `items` at `places`.
template <class Item>
std::vector<Item> chosen(const std::vector<Item>& items, const std::vector<GlobalId>& places) {
  std::vector<Item> out;
  if (!items.empty())
    for (const GlobalId i : places) out.push_back(items[i]);
  return out;
}

/// The edges of curves that are edges of tetrahedra here.
std::vector<GlobalId> edges_here(const TetMesh& whole, const std::vector<Tet>& tets) {
  const auto key = [](VertexIndex a, VertexIndex b) { return Edge{std::min(a, b), std::max(a, b)}; };
  std::vector<std::uint8_t> is_end(whole.points.size(), 0);
  for (const auto& [a, b] : whole.curve_edges) is_end[a] = is_end[b] = 1;
  std::vector<Edge> there;
  for (const Tet& t : tets)
    for (const auto& [i, j] : kTetEdges)
      if (is_end[t[static_cast<std::size_t>(i)]] != 0 && is_end[t[static_cast<std::size_t>(j)]] != 0)
        there.push_back(key(t[static_cast<std::size_t>(i)], t[static_cast<std::size_t>(j)]));
  std::sort(there.begin(), there.end());
  std::vector<GlobalId> edges;
  for (std::size_t e = 0; e < whole.curve_edges.size(); ++e)
    if (std::binary_search(there.begin(), there.end(), key(whole.curve_edges[e][0], whole.curve_edges[e][1])))
      edges.push_back(e);
  return edges;
}

}  // namespace

Piece piece_of_share(const TetMesh& share, const Comm& comm) {
  // The share and what is around it, as a mesh that has all points: its pieces' numbers are then told those of the
  // whole.
  const std::vector<Ghost> ghosts = ghosts_around(share, comm);
  const std::uint64_t first = count_tets(share, comm).before;
  const auto here = static_cast<std::uint32_t>(comm.rank());
  TetMesh near;
  near.points = share.points, near.tets = share.tets, near.region = share.region;
  near.region_names = share.region_names, near.region_labels = share.region_labels;
  near.patch_names = share.patch_names, near.curve_names = share.curve_names;
  near.patch_labels = share.patch_labels, near.curve_labels = share.curve_labels;
  std::vector<GlobalId> tet_ids;
  Division division{static_cast<std::uint32_t>(comm.size()), std::vector<std::uint32_t>(share.tets.size(), here)};
  for (std::size_t t = 0; t < share.tets.size(); ++t) tet_ids.push_back(first + t);
  std::int64_t regions = static_cast<std::int64_t>(share.region.size());
  comm.sum(std::span(&regions, 1), "regions");
  for (const Ghost& ghost : ghosts) {
    near.tets.push_back(ghost.corners);
    if (regions != 0) near.region.push_back(ghost.region);
    tet_ids.push_back(ghost.number);
    division.part.push_back(ghost.part);
  }
  std::vector<GlobalId> face_ids;
  const std::vector<TetIndex> tet_of = tets_of_faces(near.tets, share.boundary, near.points.size());
  for (std::size_t f = 0; f < share.boundary.size(); ++f)
    if (tet_of[f] != kNone) face_ids.push_back(f);
  near.boundary = chosen(share.boundary, face_ids), near.patch = chosen(share.patch, face_ids);
  near.source = chosen(share.source, face_ids);
  const std::vector<GlobalId> edge_ids = edges_here(share, near.tets);
  near.curve_edges = chosen(share.curve_edges, edge_ids), near.curve = chosen(share.curve, edge_ids);

  const MeshParts parts(near);
  Piece piece = Pieces(parts, std::move(division)).piece(here);
  for (GlobalId& id : piece.cell_ids) id = tet_ids[id];
  for (GlobalId& id : piece.face_ids) id = face_ids[id];
  for (GlobalId& id : piece.edge_ids) id = edge_ids[id];
  return piece;
}

WholeCounts counts_of_shares(const TetMesh& share, const Comm& comm) {
  return {share.points.size(), count_tets(share, comm).all, share.boundary.size(), share.curve_edges.size()};
}

}  // namespace octafront::io
