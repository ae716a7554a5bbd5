#include "formats/parts/pieces.h"

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "base/core/shared_value.h"
#include "base/mesh/labels.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront::io {

Pieces::Pieces(const MeshParts& whole, Division division, std::span<const MeshField> fields)
    : whole_(whole), mesh_(whole.mesh()), cells_(whole), division_(std::move(division)), fields_(fields) {
  own_ = group_by_owner(count(), static_cast<std::uint32_t>(mesh_.tets.size()),
                        [this](std::uint32_t t) { return division_.part[t]; });
  find_rims();
  find_faces();
  find_edges();
  local_.assign(mesh_.points.size(), kNone);
}

/// Those that are written.
std::span<const VertexIndex> Pieces::nodes_behind_corners(std::size_t t) const {
  if (whole_.second_order()) return mesh_.mid_nodes[t];
  const std::size_t each = whole_.order() > 2 ? mesh_.high_nodes_per_tet() : 0;
  return std::span(mesh_.high_nodes).subspan(t * each, each);
}

/// The corners that are in several parts, and the tetrahedra at them.
void Pieces::find_rims() {
  const std::size_t points = mesh_.points.size();
  point_part_.assign(points, kNone);
  std::vector<std::uint8_t> is_shared(points, 0);
  parallel_for(mesh_.tets.size(), [&](std::size_t t) {
    for (const VertexIndex v : mesh_.tets[t]) SharedValue(point_part_[v]).lower_to(division_.part[t]);
    for (const VertexIndex v : nodes_behind_corners(t)) SharedValue(point_part_[v]).lower_to(division_.part[t]);
  });
  parallel_for(mesh_.tets.size(), [&](std::size_t t) {
    for (const VertexIndex v : mesh_.tets[t])
      if (point_part_[v] != division_.part[t]) SharedValue(is_shared[v]).store(1);
  });
  place_.assign(points, kNone);
  std::uint32_t shared = 0;
  for (std::size_t v = 0; v < points; ++v)
    if (is_shared[v] != 0) place_[v] = shared++;
  const auto at_rims = parallel_select(mesh_.tets.size(), [&](TetIndex t) {
    return std::ranges::any_of(mesh_.tets[t], [&](VertexIndex v) { return is_shared[v] != 0; });
  });
  star_ = Groups<>(shared, [&](const auto& add) {
    for (const TetIndex t : at_rims)
      for (const VertexIndex v : mesh_.tets[t])
        if (place_[v] != kNone) add(place_[v], t);
  });
}

void Pieces::find_faces() {
  if (whole_.faces() == 0) return;
  const std::vector<Side>& sides = whole_.sides();
  faces_.reserve(sides.size());
  for (std::uint32_t f = 0; f < sides.size(); ++f) {
    if (sides[f].tet == kNone)
      throw OutputError(fmt::format("face {} belongs to no element: the mesh cannot be written in parts", f));
    faces_.emplace_back(sides[f].tet, f);
  }
  parallel_sort(faces_);
  own_faces_ = group_by_owner(count(), static_cast<std::uint32_t>(sides.size()),
                              [&](std::uint32_t f) { return division_.part[sides[f].tet]; });
}

void Pieces::find_edges() {
  if (whole_.edges() == 0) return;
  const auto key = [](VertexIndex a, VertexIndex b) { return Edge{std::min(a, b), std::max(a, b)}; };
  std::vector<std::pair<Edge, std::uint32_t>> by_ends;
  std::vector<bool> is_end(mesh_.points.size(), false);
  for (std::uint32_t e = 0; e < whole_.edges(); ++e) {
    const auto& [a, b] = mesh_.curve_edges[e];
    by_ends.emplace_back(key(a, b), e);
    is_end[a] = is_end[b] = true;
  }
  std::sort(by_ends.begin(), by_ends.end());
  edge_tet_.assign(whole_.edges(), kNone);
  parallel_for(mesh_.tets.size(), [&](std::size_t t) {
    for (const auto& [i, j] : kTetEdges) {
      const VertexIndex a = mesh_.tets[t][static_cast<std::size_t>(i)], b = mesh_.tets[t][static_cast<std::size_t>(j)];
      if (!is_end[a] || !is_end[b]) continue;
      auto at = std::lower_bound(by_ends.begin(), by_ends.end(), std::pair(key(a, b), 0u));
      for (; at != by_ends.end() && at->first == key(a, b); ++at)
        SharedValue(edge_tet_[at->second]).lower_to(static_cast<TetIndex>(t));
    }
  });
  for (std::uint32_t e = 0; e < edge_tet_.size(); ++e) {
    if (edge_tet_[e] == kNone)
      throw OutputError(
          fmt::format("edge {} of a curve belongs to no element: the mesh cannot be written in parts", e));
    edges_.emplace_back(edge_tet_[e], e);
  }
  parallel_sort(edges_);
  own_edges_ = group_by_owner(count(), static_cast<std::uint32_t>(edge_tet_.size()),
                              [&](std::uint32_t e) { return division_.part[edge_tet_[e]]; });
}

/// All tetrahedra of wedges and pyramids that have one in the ascending list.
void Pieces::complete_wide_cells(std::vector<TetIndex>& tets) const {
  const auto& wide = mesh_.wide_cells;
  if (wide.empty()) return;
  for (std::size_t i = 0, given = tets.size(); i < given; ++i) {
    const TetIndex t = tets[i];
    const auto behind = std::upper_bound(wide.begin(), wide.end(), t,
                                         [](TetIndex at, const WideCell& cell) { return at < cell.first; });
    if (behind == wide.begin()) continue;
    const WideCell& cell = *std::prev(behind);
    for (TetIndex k = cell.first; t < cell.first + cell.tet_count && k < cell.first + cell.tet_count; ++k)
      tets.push_back(k);
  }
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
}

std::vector<TetIndex> Pieces::ghosts_of(std::uint32_t number) {
  std::vector<std::uint32_t> corners;
  for (const TetIndex t : own_[number])
    for (const VertexIndex v : mesh_.tets[t])
      if (place_[v] != kNone) corners.push_back(place_[v]);
  parallel_sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<TetIndex> ghosts;
  for (const std::uint32_t c : corners)
    for (const TetIndex t : star_[c])
      if (division_.part[t] != number) ghosts.push_back(t);
  parallel_sort(ghosts);
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  complete_wide_cells(ghosts);
  return ghosts;
}

std::vector<std::uint32_t> Pieces::items_of(std::span<const std::uint32_t> own, const std::vector<Item>& by_tet,
                                            std::span<const TetIndex> ghosts) const {
  std::vector<std::uint32_t> items(own.begin(), own.end());
  for (const TetIndex t : ghosts)
    for (auto at = std::lower_bound(by_tet.begin(), by_tet.end(), Item(t, 0)); at != by_tet.end() && at->first == t;
         ++at)
      items.push_back(at->second);
  std::sort(items.begin(), items.end());
  return items;
}

Piece Pieces::piece(std::uint32_t number, bool with_ghosts) {
  Piece piece;
  piece.number = number;
  piece.parts = count();
  piece.own_tets = own_[number].size();
  std::vector<TetIndex> tets(own_[number].begin(), own_[number].end());
  const std::vector<TetIndex> ghosts = with_ghosts ? ghosts_of(number) : std::vector<TetIndex>();
  tets.insert(tets.end(), ghosts.begin(), ghosts.end());
  const auto faces = whole_.faces() == 0 ? std::vector<std::uint32_t>() : items_of(own_faces_[number], faces_, ghosts);
  const auto edges = whole_.edges() == 0 ? std::vector<std::uint32_t>() : items_of(own_edges_[number], edges_, ghosts);
  const std::vector<VertexIndex> points = points_of(tets);
  piece.mesh = part_of(mesh_, {points, edges, faces, tets}, local_);
  if (whole_.order() == 1) piece.mesh.mid_nodes.clear(), piece.mesh.high_nodes.clear(), piece.mesh.high_order = 0;
  if (whole_.wide_cells().empty()) piece.mesh.wide_cells.clear();
  if (whole_.wide_faces().empty()) piece.mesh.wide_faces.clear();
  piece.point_ids.assign(points.begin(), points.end());
  piece.point_part = of_items(point_part_, points);
  piece.last_points = static_cast<std::size_t>(
      points.end() - std::lower_bound(points.begin(), points.end(), static_cast<VertexIndex>(whole_.points())));
  piece.tet_part = of_items(division_.part, tets);
  piece.cell_ids.resize(tets.size());
  parallel_for(tets.size(), [&](std::size_t i) { piece.cell_ids[i] = cells_.cell_of(tets[i]); });
  for (const std::uint32_t f : faces) piece.face_ids.push_back(cells_.face_of(f));
  for (const std::uint32_t e : edges) {
    piece.edge_part.push_back(division_.part[edge_tet_[e]]);
    piece.edge_ids.push_back(e);
  }
  add_fields(piece, tets);
  return piece;
}

/// Ascending.
std::vector<VertexIndex> Pieces::points_of(std::span<const TetIndex> tets) {
  std::vector<VertexIndex> points;
  const auto take = [&](std::span<const VertexIndex> nodes) {
    for (const VertexIndex v : nodes) {
      if (local_[v] != kNone) continue;
      local_[v] = 0;
      points.push_back(v);
    }
  };
  for (const TetIndex t : tets) {
    take(mesh_.tets[t]);
    take(nodes_behind_corners(t));
  }
  for (const VertexIndex v : points) local_[v] = kNone;
  parallel_sort(points);
  return points;
}

void Pieces::add_fields(Piece& piece, std::span<const TetIndex> tets) const {
  for (const MeshField& field : fields_) {
    MeshField of_piece{field.name, field.of_elements, field.components, {}};
    const auto add = [&](std::uint64_t item) {
      const auto begin = field.values.begin() + static_cast<std::ptrdiff_t>(item * field.components);
      of_piece.values.insert(of_piece.values.end(), begin, begin + static_cast<std::ptrdiff_t>(field.components));
    };
    if (field.of_elements) std::ranges::for_each(tets, add);
    if (!field.of_elements) std::ranges::for_each(piece.point_ids, add);
    piece.fields.push_back(std::move(of_piece));
  }
}

}  // namespace octafront::io
