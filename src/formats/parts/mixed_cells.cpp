#include "formats/parts/mixed_cells.h"

#include <algorithm>

namespace octafront::io {

MixedCells::MixedCells(const MeshParts& mesh) : mesh_(mesh) {
  const std::vector<WideCell>& wide = mesh.mesh().wide_cells;
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
    const std::uint32_t first = mesh.mesh().wide_faces[q].first;
    face_of_[first] = face_of_[first + 1] = static_cast<std::uint32_t>(triangles()) + q;
  }
  for (std::uint32_t f = 0; f < face_of_.size(); ++f) {
    if (face_of_[f] != kNone) continue;
    face_of_[f] = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back(f);
  }
}

TetIndex MixedCells::first_tet(std::size_t cell) const {
  if (cell >= end_[kTet]) return wide(cell).first;
  return tets_.empty() ? static_cast<TetIndex>(cell) : tets_[cell];
}

std::span<const VertexIndex> MixedCells::nodes(std::size_t cell, std::array<VertexIndex, 10>& room) const {
  if (cell < end_[kTet]) return mesh_.tet_nodes(first_tet(cell), room);
  return std::span(wide(cell).nodes).first(wide(cell).tet_count + 3);
}

std::size_t MixedCells::first_face(std::size_t face) const {
  if (face >= triangles()) return mesh_.mesh().wide_faces[face - triangles()].first;
  return triangles_.empty() ? face : triangles_[face];
}

std::span<const VertexIndex> MixedCells::face_nodes(std::size_t face, std::array<VertexIndex, 6>& room) const {
  if (face >= triangles()) return mesh_.mesh().wide_faces[face - triangles()].nodes;
  return mesh_.face_nodes(first_face(face), room);
}

std::vector<std::uint32_t> MixedCells::members(const Part& part) const {
  std::vector<std::uint32_t> all;
  all.reserve(part.members.size());
  for (const std::uint32_t m : part.members)
    all.push_back(static_cast<std::uint32_t>(part.kind == NamedSet::Kind::kElements ? cell_of(m) : face_of(m)));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace octafront::io
