#include "base/dual/layer_cells.h"

#include <algorithm>

namespace octafront::dual {
namespace {

bool has(const Triangle& t, VertexIndex v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

bool is_within(const Triangle& face, const Triangle& t) {
  return has(t, face[0]) && has(t, face[1]) && has(t, face[2]);
}

void sort_each_once(std::vector<Edge>& edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

}  // namespace

LayerCells::LayerCells(const TetMesh& mesh) {
  if (mesh.wide_cells.empty()) return;
  add_uprights(mesh);
  const bool is_torn = std::ranges::any_of(uprights_, [&](const Edge& e) {
    return std::ranges::binary_search(uprights_, Edge{e[1], e[0]});
  });
  if (is_torn) uprights_.clear();
  if (uprights_.empty()) return;
  of_tet_.assign(mesh.tets.size(), kNone);
  std::vector<bool> is_wide(mesh.tets.size(), false), is_in_column(mesh.points.size(), false);
  for (const WideCell& cell : mesh.wide_cells) {
    for (TetIndex t = cell.first; t < cell.first + cell.tet_count; ++t) is_wide[t] = true;
    add(mesh, of_wide(cell), cell.tet_count);
  }
  for (const Edge& e : uprights_) is_in_column[e[0]] = is_in_column[e[1]] = true;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    if (is_wide[t] || std::ranges::count_if(mesh.tets[t], [&](VertexIndex v) { return is_in_column[v]; }) < 2) continue;
    for (const auto& [i, j] : kTetEdges)
      for (const auto& [a, b] : {std::pair(i, j), {j, i}}) {
        const auto at = [&](int k) { return mesh.tets[t][static_cast<std::size_t>(k)]; };
        if (of_tet_[t] != kNone || !is_upright(at(a), at(b))) continue;
        const Triangle bottom = face_of(mesh.tets[t], b);
        Triangle top = bottom;
        std::ranges::replace(top, at(a), at(b));
        add(mesh, {.bottom = bottom, .top = top, .first = t}, 1);
      }
  }
}

/// Of wedges; of pyramids as neighbours know it, else as our own have it: they end at their apex.
void LayerCells::add_uprights(const TetMesh& mesh) {
  for (const WideCell& cell : mesh.wide_cells)
    for (std::size_t i = 0; i < 3 && cell.tet_count == 3; ++i) uprights_.push_back({cell.nodes[i], cell.nodes[i + 3]});
  sort_each_once(uprights_);
  if (uprights_.empty()) return;
  std::vector<Edge> of_pyramids;
  for (const WideCell& cell : mesh.wide_cells) {
    if (cell.tet_count == 3) continue;
    const LayerCell of = of_wide(cell);
    for (std::size_t i = 0; i < 2; ++i) of_pyramids.push_back({of.bottom[i], of.top[i]});
  }
  uprights_.insert(uprights_.end(), of_pyramids.begin(), of_pyramids.end());
  sort_each_once(uprights_);
}

LayerCell LayerCells::of_wide(const WideCell& cell) const {
  const auto& n = cell.nodes;
  if (cell.tet_count == 3) return {.bottom = {n[0], n[1], n[2]}, .top = {n[3], n[4], n[5]}, .first = cell.first};
  for (std::size_t turn = 0; turn < 4; ++turn) {
    const VertexIndex a = n[turn], b = n[(turn + 1) % 4], c = n[(turn + 2) % 4], d = n[(turn + 3) % 4];
    if (is_upright(a, b) || is_upright(d, c)) return {.bottom = {a, d, n[4]}, .top = {b, c, n[4]}, .first = cell.first};
  }
  return {.bottom = {n[0], n[3], n[4]}, .top = {n[1], n[2], n[4]}, .first = cell.first};
}

bool LayerCells::add(const TetMesh& mesh, LayerCell cell, std::uint32_t tets) {
  for (HalfFace h = 4 * cell.first; h < 4 * (cell.first + tets); ++h) {
    const Triangle face = corners_of(mesh.tets, h);
    if (is_within(face, cell.bottom)) cell.floor = h;
    if (is_within(face, cell.top)) cell.ceiling = h;
  }
  if (cell.floor == kNone || cell.ceiling == kNone) return false;
  std::fill_n(of_tet_.begin() + cell.first, tets, static_cast<std::uint32_t>(cells_.size()));
  cells_.push_back(cell);
  return true;
}

HalfFace LayerCells::ground_of(std::span<const HalfFace> across, const LayerCell& cell) const {
  HalfFace floor = cell.floor;
  while (across[floor] != kNone) {
    const LayerCell* below = of(across[floor] / 4);
    if (below == nullptr || below->ceiling != across[floor]) break;
    floor = below->floor;
  }
  return floor;
}

bool LayerCells::is_upright(VertexIndex lower, VertexIndex upper) const {
  return std::ranges::binary_search(uprights_, Edge{lower, upper});
}

std::optional<Edge> LayerCells::top_of_side(std::span<const Tet> tets, HalfFace h) const {
  const LayerCell* cell = of(h / 4);
  if (cell == nullptr) return std::nullopt;
  Triangle tops = corners_of(tets, h);
  for (VertexIndex& v : tops)
    for (std::size_t i = 0; i < 3; ++i)
      if (v == cell->bottom[i]) {
        v = cell->top[i];
        break;
      }
  std::sort(tops.begin(), tops.end());
  if (tops[0] == tops[1]) return Edge{tops[1], tops[2]};
  if (tops[1] == tops[2]) return Edge{tops[0], tops[1]};
  return std::nullopt;
}

}  // namespace octafront::dual
