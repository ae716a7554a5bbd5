#include "formats/parts/vtk_cells.h"

#include <algorithm>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

constexpr std::array<std::array<std::uint8_t, 3>, 2> kVtkCells{{{10, 5, 3}, {24, 22, 21}}};

std::string_view plural(Kind kind) {
  switch (kind) {
    case Kind::kNodes:
      return "nodes ";
    case Kind::kEdges:
      return "edges ";
    case Kind::kFaces:
      return "faces ";
    default:
      return "elements ";
  }
}

}  // namespace

VtkCells::VtkCells(const MeshParts& mesh)
    : mesh_(mesh),
      ends_{mesh.tets(), mesh.tets() + mesh.faces(), mesh.tets() + mesh.faces() + mesh.edges()},
      each_{mesh.nodes_per_tet(), mesh.nodes_per_face(), mesh.nodes_per_edge()},
      types_(kVtkCells[mesh.second_order()]),
      data_{{"region", false, false}, {"patch", false, false}} {
  if (!mesh.labels().empty()) data_.push_back({"label", false, false});
  if (mesh.edges() > 0) data_.push_back({"curve", false, false});
  const auto& source = mesh.mesh().source;
  if (!std::all_of(source.begin(), source.end(), [](std::uint32_t face) { return face == kNone; }))
    data_.push_back({"source", false, false});
  for (const Part& part : mesh.parts(Part::Origin::kSet)) {
    const bool of_points = part.kind == Kind::kNodes;
    data_.push_back({std::string(plural(part.kind)) + part.name, of_points, true});
    const std::uint64_t first = part.kind == Kind::kFaces ? ends_[0] : part.kind == Kind::kEdges ? ends_[1] : 0;
    std::vector<bool>& is_in = sets_.emplace_back(of_points ? mesh.points() : size(), false);
    for (const std::uint32_t m : part.members) is_in[first + m] = true;
  }
  mesh.sides();
}

std::uint64_t VtkCells::end_of(std::uint64_t cell) const {
  std::uint64_t end = 0, first = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    end += each_[k] * (std::min(cell + 1, ends_[k]) - std::min(cell + 1, first));
    first = ends_[k];
  }
  return end;
}

VertexIndex VtkCells::node(std::uint64_t at) const {
  const std::uint64_t of_tets = each_[0] * ends_[0], of_faces = each_[1] * (ends_[1] - ends_[0]);
  if (at < of_tets) return mesh_.tet_node(at / each_[0], at % each_[0]);
  at -= of_tets;
  if (at < of_faces) return mesh_.face_node(at / each_[1], at % each_[1]);
  at -= of_faces;
  return mesh_.edge_node(at / each_[2], at % each_[2]);
}

TetIndex VtkCells::tet_of(std::uint64_t cell) const {
  if (cell >= ends_[1]) return kNone;
  return cell < ends_[0] ? static_cast<TetIndex>(cell) : mesh_.sides()[cell - ends_[0]].tet;
}

std::int32_t VtkCells::number(std::string_view name, std::uint64_t cell) const {
  const std::size_t k = kind(cell);
  if (name == "region") {
    const TetIndex t = tet_of(cell);
    return t == kNone ? 0 : static_cast<std::int32_t>(mesh_.region_of(t));
  }
  if (name == "label") {
    const TetIndex t = tet_of(cell);
    return t == kNone ? 0 : mesh_.labels()[mesh_.region_of(t)];
  }
  if (name == "patch") return k == 1 ? static_cast<std::int32_t>(mesh_.patch_of(cell - ends_[0])) : -1;
  if (name == "curve") return k == 2 ? static_cast<std::int32_t>(mesh_.curve_of(cell - ends_[1])) : -1;
  const auto& source = mesh_.mesh().source;
  return k == 1 && cell - ends_[0] < source.size() ? static_cast<std::int32_t>(source[cell - ends_[0]]) : -1;
}

std::int32_t VtkCells::value(std::size_t data, std::uint64_t at) const {
  if (!data_[data].is_set) return number(data_[data].name, at);
  return sets_[data - (data_.size() - sets_.size())][at];
}

std::vector<std::pair<std::string, std::uint32_t>> VtkCells::names() const {
  std::vector<std::pair<std::string, std::uint32_t>> all;
  for (const Part& part : mesh_.parts()) {
    if (!part.is_named || part.origin == Part::Origin::kSet) continue;
    const std::string_view of = part.origin == Part::Origin::kRegion  ? "region "
                                : part.origin == Part::Origin::kPatch ? "patch "
                                                                      : "curve ";
    all.emplace_back(std::string(of) + part.name, part.number);
  }
  return all;
}

}  // namespace octafront::io
