#include "pipeline/stages/without_wide_cells.h"

#include "base/mesh/adjacency.h"
#include "base/mesh/renumber.h"

#include <algorithm>
#include <span>
#include <utility>

namespace octafront {

WithoutWideCells::WithoutWideCells(const TetMesh& mesh) : mesh_(mesh), is_wide_(mesh.tets.size(), false) {
  for (const WideCell& cell : mesh.wide_cells) std::fill_n(is_wide_.begin() + cell.first, cell.tet_count, true);
  own_walls_ = walls();
  number_vertices();
}

std::vector<Triangle> WithoutWideCells::walls() const {
  std::vector<Triangle> found;
  half_face_table(mesh_.tets, mesh_.points.size())
      .for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> on_face) {
        const auto is_inner = [&](const FaceTable::Entry& entry) { return !is_wide_[entry.face / 4]; };
        if (std::ranges::count_if(on_face, is_inner) == 1)
          found.push_back(corners_of(mesh_.tets, std::ranges::find_if(on_face, is_inner)->face));
      });
  return found;
}

void WithoutWideCells::number_vertices() {
  enum : char { kElsewhere, kInside, kWall };
  std::vector<char> place(mesh_.points.size(), kElsewhere);
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
    if (!is_wide_[t])
      for (const VertexIndex v : mesh_.tets[t]) place[v] = kInside;
  for (const Triangle& t : own_walls_)
    for (const VertexIndex v : t) place[v] = kWall;
  in_inner_.assign(mesh_.points.size(), kNone);
  VertexIndex next = 0;
  for (const char wanted : {kWall, kInside})
    for (VertexIndex v = 0; v < place.size(); ++v) {
      if (place[v] != wanted) continue;
      in_inner_[v] = next++;
      if (wanted == kWall) fixed_.push_back(v);
    }
}

TetMesh WithoutWideCells::inner() const {
  TetMesh inner;
  inner.points.resize(static_cast<std::size_t>(std::ranges::count_if(in_inner_, [](auto v) { return v != kNone; })));
  for (VertexIndex v = 0; v < in_inner_.size(); ++v)
    if (in_inner_[v] != kNone) inner.points[in_inner_[v]] = mesh_.points[v];
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    if (is_wide_[t]) continue;
    inner.tets.push_back(mesh_.tets[t]);
    if (!mesh_.region.empty()) inner.region.push_back(mesh_.region[t]);
  }
  inner.boundary = own_walls_;
  renumber(inner.tets, in_inner_);
  renumber(inner.boundary, in_inner_);
  return inner;
}

TetMesh WithoutWideCells::joined(TetMesh inner) const {
  TetMesh whole = mesh_;
  // What was inside is gone; what is there now follows behind all.
  std::vector<VertexIndex> number(mesh_.points.size(), 0);
  for (VertexIndex v = 0; v < number.size(); ++v)
    if (in_inner_[v] != kNone && in_inner_[v] >= fixed_.size()) number[v] = kNone;
  keep_numbered(whole.points, number);
  std::vector<VertexIndex> of_inner;
  for (const VertexIndex v : fixed_) of_inner.push_back(number[v]);
  for (std::size_t v = fixed_.size(); v < inner.points.size(); ++v) {
    of_inner.push_back(static_cast<VertexIndex>(whole.points.size()));
    whole.points.push_back(inner.points[v]);
  }
  renumber(inner.tets, of_inner);
  whole.tets.clear();
  whole.region.clear();
  renumber_vertices(whole, number);
  whole.tets = std::move(inner.tets);
  whole.region = std::move(inner.region);
  std::vector<TetIndex> tet_number(mesh_.tets.size(), kNone);
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    if (!is_wide_[t]) continue;
    tet_number[t] = static_cast<TetIndex>(whole.tets.size());
    whole.tets.push_back(mesh_.tets[t]);
    for (VertexIndex& v : whole.tets.back()) v = number[v];
    if (!mesh_.region.empty()) whole.region.push_back(mesh_.region[t]);
  }
  for (WideCell& cell : whole.wide_cells) cell.first = tet_number[cell.first];
  return whole;
}

}  // namespace octafront
