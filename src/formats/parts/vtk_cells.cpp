#include "formats/parts/vtk_cells.h"

#include <algorithm>

namespace octafront::io {
namespace {

using SetKind = NamedSet::Kind;

constexpr std::array<std::array<std::uint8_t, 6>, 3> kVtkCells{
    {{10, 14, 13, 5, 9, 3}, {24, 27, 26, 22, 23, 21}, {71, 0, 0, 69, 0, 68}}};

std::string_view plural(SetKind kind) {
  switch (kind) {
    case SetKind::kNodes:
      return "nodes ";
    case SetKind::kEdges:
      return "edges ";
    case SetKind::kFaces:
      return "faces ";
    default:
      return "elements ";
  }
}

}  // namespace

VtkCells::Shown VtkCells::Shown::of(const MeshParts& mesh) {
  const auto& source = mesh.mesh().source;
  return {.label = !mesh.labels().empty(),
          .curve = mesh.edges() > 0,
          .source = !std::all_of(source.begin(), source.end(), [](std::uint32_t face) { return face == kNone; }),
          .layers = !mesh.mesh().face_layers.empty()};
}

std::vector<VtkCells::Data> VtkCells::data_of(const MeshParts& mesh, const Shown& shown) {
  std::vector<Data> data{{"region", false, false}, {"patch", false, false}};
  if (shown.label) data.push_back({"label", false, false});
  if (shown.curve) data.push_back({"curve", false, false});
  if (shown.source) data.push_back({"source", false, false});
  if (shown.layers) data.push_back({"layers", false, false});
  for (const Part& part : mesh.parts(Part::Origin::kSet))
    data.push_back({std::string(plural(part.kind)) + part.name, part.kind == SetKind::kNodes, true});
  return data;
}

VtkCells::VtkCells(const MeshParts& mesh, const Shown& shown)
    : mesh_(mesh),
      cells_(mesh),
      each_{cells_.nodes_per(MixedCells::kTet),
            cells_.nodes_per(MixedCells::kPyramid),
            cells_.nodes_per(MixedCells::kWedge),
            mesh.nodes_per_face(),
            cells_.nodes_per_quad(),
            mesh.nodes_per_edge()},
      types_(kVtkCells[static_cast<std::size_t>(std::min(mesh.order(), 3) - 1)]),
      data_(data_of(mesh, shown)) {
  for (const MixedCells::Kind k : MixedCells::kAllKinds) ends_[k] = cells_.end(k);
  ends_[kTriangles] = first_face() + cells_.triangles();
  ends_[kQuads] = first_face() + cells_.faces();
  ends_[kEdges] = ends_[kQuads] + mesh.edges();
  for (const Part& part : mesh.parts(Part::Origin::kSet)) {
    const bool of_points = part.kind == SetKind::kNodes;
    std::vector<bool>& is_in = sets_.emplace_back(of_points ? mesh.points() : size(), false);
    for (const std::uint32_t m : part.members)
      is_in[part.kind == SetKind::kFaces      ? first_face() + cells_.face_of(m)
            : part.kind == SetKind::kElements ? cells_.cell_of(m)
            : part.kind == SetKind::kEdges    ? ends_[kQuads] + m
                                              : m] = true;
  }
  mesh.sides();
}

VtkCells::Kind VtkCells::kind(std::uint64_t cell) const {
  std::size_t k = kTets;
  while (cell >= ends_[k]) ++k;
  return static_cast<Kind>(k);
}

std::uint64_t VtkCells::end_of(std::uint64_t cell) const {
  std::uint64_t end = 0, first = 0;
  for (std::size_t k = 0; k < kKinds; ++k) {
    end += each_[k] * (std::min(cell + 1, ends_[k]) - std::min(cell + 1, first));
    first = ends_[k];
  }
  return end;
}

VertexIndex VtkCells::node(std::uint64_t at) const {
  std::uint64_t first = 0;
  std::size_t k = kTets;
  for (;; ++k) {
    const std::uint64_t values = each_[k] * (ends_[k] - first);
    if (at < values) break;
    at -= values;
    first = ends_[k];
  }
  const std::uint64_t cell = first + at / each_[k], i = at % each_[k];
  if (k == kEdges) return mesh_.edge_node(cell - ends_[kQuads], i);
  return is_face(static_cast<Kind>(k)) ? cells_.face_node(cell - first_face(), i) : cells_.node(cell, i, kVtkWide);
}

TetIndex VtkCells::tet_of(std::uint64_t cell) const {
  const Kind k = kind(cell);
  if (k == kEdges) return kNone;
  return is_face(k) ? mesh_.sides()[cells_.first_face(cell - first_face())].tet : cells_.first_tet(cell);
}

std::int32_t VtkCells::number(std::string_view name, std::uint64_t cell) const {
  const Kind k = kind(cell);
  if (name == "region") {
    const TetIndex t = tet_of(cell);
    return t == kNone ? 0 : static_cast<std::int32_t>(mesh_.region_of(t));
  }
  if (name == "label") {
    const TetIndex t = tet_of(cell);
    return t == kNone ? 0 : mesh_.labels()[mesh_.region_of(t)];
  }
  if (name == "curve") return k == kEdges ? static_cast<std::int32_t>(mesh_.curve_of(cell - ends_[kQuads])) : -1;
  if (!is_face(k)) return -1;
  const std::size_t face = cells_.first_face(cell - first_face());
  if (name == "patch") return static_cast<std::int32_t>(mesh_.patch_of(face));
  if (name == "layers") return static_cast<std::int32_t>(mesh_.mesh().face_layers[face]);
  const auto& source = mesh_.mesh().source;
  return face < source.size() ? static_cast<std::int32_t>(source[face]) : -1;
}

std::int32_t VtkCells::value(std::size_t data, std::uint64_t at) const {
  if (!data_[data].is_set) return number(data_[data].name, at);
  return sets_[data - (data_.size() - sets_.size())][at];
}

VtkCells::Names VtkCells::names_of(const MeshParts& mesh) {
  Names all;
  for (const Part& part : mesh.parts()) {
    if (!part.is_named || part.origin == Part::Origin::kSet) continue;
    const std::string_view of = part.origin == Part::Origin::kRegion  ? "region "
                                : part.origin == Part::Origin::kPatch ? "patch "
                                                                      : "curve ";
    all.emplace_back(std::string(of) + part.name, part.number);
  }
  return all;
}

}  // namespace octafront::io
