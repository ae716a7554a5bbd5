#include "formats/parts/wide_reading.h"

#include "base/mesh/quadratic_nodes.h"
#include "formats/parts/wide_orders.h"

#include <algorithm>
#include <map>
#include <span>

namespace octafront::io {
namespace {

using Quad = std::array<VertexIndex, 4>;
using Rank = std::span<const std::uint64_t>;

std::uint64_t rank_of(VertexIndex v, Rank rank) {
  return rank.empty() ? std::uint64_t{v} : rank[v];
}

/// Whether the diagonal of a quadrilateral starts at its first or third node: the lowest is there.
bool is_divided_from_first(const Quad& nodes, Rank rank = {}) {
  const auto number = [&](std::size_t k) { return rank_of(nodes[k], rank); };
  return std::min(number(0), number(2)) < std::min(number(1), number(3));
}

/// The two triangles of a quadrilateral.
std::array<Triangle, 2> halves_of(const Quad& q) {
  const std::size_t k = is_divided_from_first(q) ? 0 : 1;
  const Triangle one{q[k], q[k + 1], q[k + 2]}, other{q[k], q[k + 2], q[(k + 3) % 4]};
  return {one, other};
}

Edge diagonal_of(const Quad& q) {
  const std::size_t k = is_divided_from_first(q) ? 0 : 1;
  return {std::min(q[k], q[k + 2]), std::max(q[k], q[k + 2])};
}

/// The tetrahedra of a pyramid as corners of it.
std::vector<std::array<std::size_t, 4>> divided_pyramid(std::span<const VertexIndex> nodes, Rank rank) {
  const std::size_t k = is_divided_from_first({nodes[0], nodes[1], nodes[2], nodes[3]}, rank) ? 0 : 1;
  return {{k, k + 1, k + 2, 4}, {k, k + 2, (k + 3) % 4, 4}};
}

/// The tetrahedra of a wedge.
std::vector<std::array<std::size_t, 4>> divided_wedge(std::span<const VertexIndex> nodes, Rank rank) {
  // The lowest node and its neighbours in its triangle, counter-clockwise seen from the other one, then those there.
  const auto low = static_cast<std::size_t>(
      std::ranges::min_element(nodes.first(6), {}, [&](VertexIndex v) { return rank_of(v, rank); }) - nodes.begin());
  const bool is_base = low < 3;
  const std::size_t i = low % 3, j = (i + (is_base ? 1 : 2)) % 3, k = (i + (is_base ? 2 : 1)) % 3;
  const std::size_t own = is_base ? 0 : 3, other = 3 - own;
  const std::array<std::size_t, 6> v{own + i, own + j, own + k, other + i, other + j, other + k};
  if (is_divided_from_first({nodes[v[1]], nodes[v[2]], nodes[v[5]], nodes[v[4]]}, rank))
    return {{v[0], v[1], v[2], v[5]}, {v[0], v[1], v[5], v[4]}, {v[0], v[4], v[5], v[3]}};
  return {{v[0], v[1], v[2], v[4]}, {v[0], v[4], v[2], v[5]}, {v[0], v[4], v[5], v[3]}};
}

/// The node behind the corners that is in the middle of an edge of a wedge or pyramid; kNone: of a diagonal.
VertexIndex own_mid_node(std::span<const VertexIndex> nodes, std::size_t a, std::size_t b) {
  const std::size_t corners = nodes.size() == 15 ? 6 : 5;
  for (std::size_t e = 0; corners + e < nodes.size(); ++e) {
    const auto& [i, j] = corners == 6 ? kWedgeEdges[e] : kPyramidEdges[e];
    if ((i == a && j == b) || (i == b && j == a)) return nodes[corners + e];
  }
  return kNone;
}

/// Of the three edges between the triangles of a wedge, how many have no length.
std::size_t collapsed_edges(std::span<const VertexIndex> nodes) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) count += nodes[k] == nodes[k + 3];
  return count;
}

/// The nodes of a wedge so that the triangles begin at corner k.
std::vector<VertexIndex> turned_wedge(std::span<const VertexIndex> nodes, std::size_t k) {
  std::vector<VertexIndex> out;
  for (std::size_t row = 0; row < nodes.size(); row += 3)
    for (std::size_t i = 0; i < 3; ++i) out.push_back(nodes[row + (i + k) % 3]);
  return out;
}

/// The pyramid that a wedge is whose first edge between its triangles has no length: see kPyramidAsWedge.
std::vector<VertexIndex> as_pyramid(std::span<const VertexIndex> wedge) {
  std::vector<VertexIndex> pyramid(wedge.size() == 15 ? 13 : 5, kNone);
  for (std::size_t i = 0; i < wedge.size(); ++i) pyramid[kPyramidAsWedge[i]] = wedge[i];
  return pyramid;
}

template <class Visit>
void for_each_quad(const WideCell& cell, const Visit& visit) {
  for (const auto& [i, j, k, l] : cell.tet_count == 3 ? kWedgeFaces : kPyramidFaces)
    if (k != l) visit(Quad{cell.nodes[i], cell.nodes[j], cell.nodes[k], cell.nodes[l]});
}

/// The mid-side nodes of the edges of one wide cell, by their ends.
class MidNodes {
 public:
  MidNodes(const RawMesh& raw, const WideCell& cell) : raw_(raw), cell_(cell) {}

  VertexIndex operator()(VertexIndex a, VertexIndex b) const {
    for (TetIndex t = cell_.first; t < cell_.first + cell_.tet_count; ++t)
      if (const std::size_t e = edge_between(raw_.tets[t], a, b); e < 6) return raw_.mid_nodes[t][e];
    return kNone;
  }

  void set(VertexIndex a, VertexIndex b, VertexIndex mid, std::vector<std::array<VertexIndex, 6>>& mid_nodes) const {
    for (TetIndex t = cell_.first; t < cell_.first + cell_.tet_count; ++t)
      if (const std::size_t e = edge_between(raw_.tets[t], a, b); e < 6) mid_nodes[t][e] = mid;
  }

 private:
  const RawMesh& raw_;
  const WideCell& cell_;
};

/// Where the middle of a diagonal is; empty if a mid-side node around is missing.
std::optional<Vec3> middle_of(const std::vector<Vec3>& points, const Quad& q, const Edge& ends, const MidNodes& mids) {
  Vec3 moved{};
  for (std::size_t k = 0; k < 4; ++k) {
    const VertexIndex a = q[k], b = q[(k + 1) % 4], mid = mids(a, b);
    if (mid == kNone) return std::nullopt;
    moved = moved + (points[mid] - (points[a] + points[b]) * 0.5) * 0.5;
  }
  return (points[ends[0]] + points[ends[1]]) * 0.5 + moved;
}

}  // namespace

std::uint32_t RawMesh::add_wide_cell(std::span<const VertexIndex> nodes, std::int64_t ref,
                                     std::span<const std::uint64_t> rank) {
  const bool is_wedge = nodes.size() == 6 || nodes.size() == 15;
  if (const std::size_t collapsed = is_wedge ? collapsed_edges(nodes) : 0; collapsed == 1) {
    std::size_t k = 0;
    while (nodes[k] != nodes[k + 3]) ++k;
    return add_wide_cell(as_pyramid(turned_wedge(nodes, k)), ref, rank);
  } else if (collapsed > 1) {
    ++other_elements;
    return 0;
  }
  const auto parts = is_wedge ? divided_wedge(nodes, rank) : divided_pyramid(nodes, rank);
  WideCell& cell = wide_cells.emplace_back();
  cell.first = static_cast<TetIndex>(tets.size());
  cell.tet_count = static_cast<std::uint32_t>(parts.size());
  cell.nodes.fill(kNone);
  std::copy_n(nodes.begin(), is_wedge ? 6 : 5, cell.nodes.begin());
  for (const auto& corners : parts) {
    std::array<VertexIndex, 10> all;
    for (std::size_t k = 0; k < 4; ++k) all[k] = nodes[corners[k]];
    for (std::size_t e = 0; e < 6; ++e)
      all[4 + e] = own_mid_node(nodes, corners[static_cast<std::size_t>(kTetEdges[e][0])],
                                corners[static_cast<std::size_t>(kTetEdges[e][1])]);
    add_tet(std::span(all).first(nodes.size() > 6 ? 10 : 4), ref, kPlainMids);
  }
  return cell.tet_count;
}

std::uint32_t RawMesh::add_hexahedron(std::span<const VertexIndex> nodes, std::int64_t ref,
                                      std::span<const std::uint64_t> rank) {
  const VertexIndex low =
      *std::ranges::min_element(nodes.first(8), {}, [&](VertexIndex v) { return rank_of(v, rank); });
  const std::size_t before = tets.size();
  for (const std::array<std::size_t, 4>& face : kHexahedronFaces) {
    Quad q;
    for (std::size_t k = 0; k < 4; ++k) q[k] = nodes[face[k]];
    if (std::find(q.begin(), q.end(), low) != q.end()) continue;
    const std::size_t k = is_divided_from_first(q, rank) ? 0 : 1;
    for (const Triangle& t : {Triangle{q[k], q[k + 1], q[k + 2]}, Triangle{q[k], q[k + 2], q[(k + 3) % 4]}})
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) add_tet(std::array{t[0], t[2], t[1], low}, ref);
  }
  ++hexahedra;
  return static_cast<std::uint32_t>(tets.size() - before);
}

void divide_like_wide_cells(RawMesh& raw) {
  if (raw.wide_cells.empty() && raw.hexahedra == 0) raw.wide_faces.clear();
  for (const WideFace& face : raw.wide_faces) {
    const auto halves = halves_of(face.nodes);
    std::copy(halves.begin(), halves.end(), raw.triangles.begin() + face.first);
  }
  if (raw.wide_cells.empty()) raw.wide_faces.clear();
}

void add_diagonals(RawMesh& raw) {
  if (raw.mid_nodes.size() < raw.tets.size()) return;
  std::map<Edge, VertexIndex> made;
  for (const WideCell& cell : raw.wide_cells) {
    const MidNodes mids(raw, cell);
    for_each_quad(cell, [&](const Quad& q) {
      const Edge ends = diagonal_of(q);
      const auto [entry, is_new] = made.try_emplace(ends, kNone);
      if (is_new)
        if (const auto at = middle_of(raw.points, q, ends, mids)) {
          entry->second = static_cast<VertexIndex>(raw.points.size());
          raw.points.push_back(*at);
        }
      mids.set(ends[0], ends[1], entry->second, raw.mid_nodes);
    });
  }
}

void renumber_wide(RawMesh& raw, const std::vector<VertexIndex>& number) {
  const auto renumber = [&](auto& nodes) {
    for (VertexIndex& v : nodes)
      if (v != kNone) v = number[v];
  };
  for (WideCell& cell : raw.wide_cells) renumber(cell.nodes);
  for (WideFace& face : raw.wide_faces) renumber(face.nodes);
}

std::size_t turn_wide_cells(std::vector<WideCell>& cells, std::vector<bool>& is_turned, std::size_t& wedges) {
  std::size_t turned = 0, turned_wedges = 0, all_wedges = 0;
  for (WideCell& cell : cells) {
    const bool is_wedge = cell.tet_count == 3;
    all_wedges += is_wedge;
    const auto first = is_turned.begin() + cell.first;
    if (!std::all_of(first, first + cell.tet_count, [](bool of_tet) { return of_tet; })) continue;
    ++turned;
    turned_wedges += is_wedge;
    const WideCell old = cell;
    const auto mirrored = is_wedge ? kVtkWide.of(true) : kMedWide.of(false);
    for (std::size_t k = 0; k < cell.tet_count + 3; ++k) cell.nodes[k] = old.nodes[mirrored[k]];
  }
  const bool is_whole_mesh = std::all_of(is_turned.begin(), is_turned.end(), [](bool of_tet) { return of_tet; });
  if (turned_wedges == 0 || turned_wedges < all_wedges || is_whole_mesh) return turned;
  for (const WideCell& cell : cells)
    if (cell.tet_count == 3) std::fill_n(is_turned.begin() + cell.first, cell.tet_count, false);
  wedges = all_wedges;
  return turned - wedges;
}

SidesOfWideCells::SidesOfWideCells(const TetMesh& mesh) {
  for (const WideCell& cell : mesh.wide_cells)
    for_each_quad(cell, [&](const Quad& q) {
      Quad key = q;
      std::sort(key.begin(), key.end());
      sides_.emplace_back(key, q);
      const auto [one, other] = halves_of(q);
      halves_.emplace_back(face_key(one), q);
      halves_.emplace_back(face_key(other), q);
    });
  std::sort(sides_.begin(), sides_.end());
  std::sort(halves_.begin(), halves_.end());
}

std::optional<std::array<VertexIndex, 4>> SidesOfWideCells::outward(const std::array<VertexIndex, 4>& nodes) const {
  Quad key = nodes;
  std::sort(key.begin(), key.end());
  const auto found = std::lower_bound(sides_.begin(), sides_.end(), std::pair{key, Quad{}});
  if (found == sides_.end() || found->first != key) return std::nullopt;
  Quad q = found->second;
  std::rotate(q.begin(), std::find(q.begin(), q.end(), nodes[0]), q.end());
  return q;
}

std::array<VertexIndex, 4> SidesOfWideCells::around(const Triangle& half) const {
  const auto found = std::lower_bound(halves_.begin(), halves_.end(), std::pair{face_key(half), Quad{}});
  return found->second;
}

std::size_t SidesOfWideCells::other_half(const std::vector<Triangle>& faces, std::size_t f) const {
  const Triangle key = face_key(faces[f]);
  const auto found = std::lower_bound(halves_.begin(), halves_.end(), std::pair{key, Quad{}});
  if (found == halves_.end() || found->first != key) return faces.size();
  const auto halves = halves_of(found->second);
  const Triangle other = face_key(halves[face_key(halves[0]) == key ? 1 : 0]);
  const auto at = std::lower_bound(faces.begin(), faces.end(), other,
                                   [](const Triangle& t, const Triangle& wanted) { return face_key(t) < wanted; });
  if (at == faces.end() || face_key(*at) != other) return faces.size();
  return static_cast<std::size_t>(at - faces.begin());
}

}  // namespace octafront::io
