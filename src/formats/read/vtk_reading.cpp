#include "formats/read/vtk_reading.h"

#include "formats/containers/scanner.h"
#include "formats/parts/mesh_parts.h"

#include <algorithm>
#include <array>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

struct SetPrefix {
  std::string_view prefix;
  Kind kind;
};
constexpr std::array kSetPrefixes{SetPrefix{"nodes ", Kind::kNodes}, SetPrefix{"edges ", Kind::kEdges},
                                  SetPrefix{"faces ", Kind::kFaces}, SetPrefix{"elements ", Kind::kElements}};

RawMesh::Group group_named(std::string_view array) {
  for (const auto& [prefix, kind] : kSetPrefixes)
    if (array.starts_with(prefix)) return {std::string(array.substr(prefix.size())), kind};
  return {};
}

std::int64_t at_or(const std::vector<std::int64_t>& values, std::uint64_t i, std::int64_t otherwise) {
  return values.empty() ? otherwise : values[i];
}

}  // namespace

std::vector<std::int64_t> material_of(std::vector<CellNumbers> arrays, std::vector<std::string>& notes) {
  if (arrays.empty()) return {};
  constexpr std::array<std::string_view, 14> kMaterials{
      "materialid", "materialids", "material", "matid", "mat",    "cellentityids",   "regionid",
      "regions",    "celltags",    "tag",      "ref",   "domain", "elementblockids", "objectid"};
  const auto plain = [](std::string_view name) {
    std::string letters;
    for (const char c : name)
      if (c != ' ' && c != '_' && c != '-') letters += to_lower(c);
    return letters;
  };
  const auto rank = [&](const CellNumbers& array) {
    const auto at = std::find(kMaterials.begin(), kMaterials.end(), plain(array.name));
    return static_cast<std::size_t>(at - kMaterials.begin());
  };
  // Numbers of cells are all different.
  std::vector<const CellNumbers*> candidates;
  for (const CellNumbers& array : arrays) {
    std::vector<std::int64_t> sorted = array.values;
    std::sort(sorted.begin(), sorted.end());
    const bool is_numbering = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
    if (!is_numbering || array.values.size() < 2) candidates.push_back(&array);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const CellNumbers* a, const CellNumbers* b) { return rank(*a) < rank(*b); });
  const bool is_clear = candidates.size() == 1 || (!candidates.empty() && rank(*candidates[0]) < kMaterials.size());
  const CellNumbers* const chosen = is_clear ? candidates[0] : nullptr;
  std::string others;
  for (const CellNumbers& array : arrays)
    if (&array != chosen) others += (others.empty() ? "" : ", ") + in_quotes(array.name);
  if (chosen != nullptr)
    notes.push_back(fmt::format("the cell array {} tells regions and patches", in_quotes(chosen->name)));
  if (!others.empty())
    notes.push_back(
        fmt::format("cell arrays of whole numbers left out: {}{}", others,
                    chosen != nullptr ? "" : "; one that is called \"region\" or \"MaterialID\" tells regions"));
  return chosen != nullptr ? chosen->values : std::vector<std::int64_t>();
}

bool is_set_name(std::string_view array) {
  return !group_named(array).name.empty();
}

bool is_numbering(std::string_view array) {
  constexpr std::array<std::string_view, 9> kNumberings{
      "region", "patch", "curve", "source", "layers", "label", "gmsh:physical", "gmsh:geometrical", "medit:ref"};
  return is_set_name(array) || std::find(kNumberings.begin(), kNumberings.end(), array) != kNumberings.end();
}

VtkCellTaker::VtkCellTaker(const Input& input, RawMesh& raw, const VtkCellData& data, const WideOrder& order)
    : input_(input), raw_(raw), data_(data), order_(order) {
  for (const auto& [name, values] : data.sets) groups_.push_back(group_named(name));
}

VertexIndex VtkCellTaker::node(std::uint64_t cell, std::int64_t index) const {
  if (index < 0 || static_cast<std::uint64_t>(index) >= raw_.points.size())
    input_.fail(
        fmt::format("cell {} has the corner {}, but the file has only {} points; the file is damaged: export it again",
                    cell, index, raw_.points.size()));
  return static_cast<VertexIndex>(index);
}

void VtkCellTaker::take_face_data(std::uint64_t cell) {
  const auto take_data = [&](const std::vector<std::int64_t>& from, std::vector<std::uint32_t>& to) {
    if (from.empty()) return;
    const std::int64_t value = from[cell];
    to.resize(raw_.triangles.size(),
              value >= 0 && value < std::int64_t{kNone} ? static_cast<std::uint32_t>(value) : kNone);
  };
  take_data(data_.source, raw_.triangle_source);
  take_data(data_.layers, raw_.triangle_layers);
}

void VtkCellTaker::take(std::uint64_t cell, std::int64_t type, std::span<const std::int64_t> nodes) {
  enum : std::int64_t {
    kLine = 3,
    kTriangle = 5,
    kQuad = 9,
    kTetra = 10,
    kVoxel = 11,
    kHexahedron = 12,
    kWedge = 13,
    kPyramid = 14,
    kLine3 = 21,
    kTriangle6 = 22,
    kQuad8 = 23,
    kTetra10 = 24,
    kHexahedron20 = 25,
    kWedge15 = 26,
    kPyramid13 = 27,
    kHexahedron27 = 29,
    kLagrangeLine = 68,
    kLagrangeTriangle = 69,
    kLagrangeTetra = 71
  };
  const std::size_t count = nodes.size();
  std::array<VertexIndex, 35> all;
  std::array<VertexIndex, 15> ours;
  const auto take_nodes = [&] {
    for (std::size_t k = 0; k < count; ++k) all[k] = node(cell, nodes[k]);
  };
  Kind kind;
  std::size_t member = 0, end = 0;
  if (type == kLagrangeTetra && (count == 20 || count == 35)) {
    take_nodes();
    CellRoom high;
    for (std::size_t k = 0; k < count; ++k) high[lattice_node_of_vtk(count == 20 ? 3 : 4, k)] = all[k];
    kind = Kind::kElements;
    member = raw_.tets.size();
    raw_.add_high_tet(std::span(high).first(count), at_or(data_.region, cell, 1));
  } else if ((type == kTetra && count == 4) || (type == kTetra10 && count == 10)) {
    take_nodes();
    kind = Kind::kElements;
    member = raw_.tets.size();
    raw_.add_tet(std::span(all).first(count), at_or(data_.region, cell, 1));
  } else if ((type == kWedge && count == 6) || (type == kPyramid && count == 5) || (type == kWedge15 && count == 15) ||
             (type == kPyramid13 && count == 13)) {
    take_nodes();
    kind = Kind::kElements;
    member = raw_.tets.size();
    const auto in_order = in_our_order(std::span<const VertexIndex>(all).first(count), order_, ours);
    if (raw_.add_wide_cell(in_order, at_or(data_.region, cell, 1)) == 0) return;
    end = raw_.tets.size();
  } else if (((type == kHexahedron || type == kVoxel) && count == 8) || (type == kHexahedron20 && count == 20) ||
             (type == kHexahedron27 && count == 27)) {
    take_nodes();
    if (type == kVoxel) std::swap(all[2], all[3]), std::swap(all[6], all[7]);
    kind = Kind::kElements;
    member = raw_.tets.size();
    if (raw_.add_hexahedron(std::span(all).first(8), at_or(data_.region, cell, 1)) == 0) return;
    end = raw_.tets.size();
  } else if (((type == kQuad && count == 4) || (type == kQuad8 && count == 8)) && !data_.patch.empty() &&
             data_.patch[cell] > 0) {
    // Quadrilaterals that nobody calls a patch may be anything.
    take_nodes();
    kind = Kind::kFaces;
    member = raw_.triangles.size();
    raw_.add_face(std::span(all).first(count), at_or(data_.patch, cell, 1));
    end = raw_.triangles.size();
    take_face_data(cell);
  } else if ((type == kTriangle && count == 3) || (type == kTriangle6 && count == 6) ||
             (type == kLagrangeTriangle && (count == 10 || count == 15))) {
    take_nodes();
    kind = Kind::kFaces;
    member = raw_.triangles.size();
    raw_.triangles.push_back({all[0], all[1], all[2]});
    raw_.triangle_ref.push_back(at_or(data_.patch, cell, 1));
    take_face_data(cell);
  } else if (((type == kLine && count == 2) || (type == kLine3 && count == 3) ||
              (type == kLagrangeLine && (count == 4 || count == 5))) &&
             !data_.curve.empty() && data_.curve[cell] > 0) {
    // Lines that nobody calls a curve may be anything, such as the bars of a frame.
    take_nodes();
    kind = Kind::kEdges;
    member = raw_.edges.size();
    raw_.edges.push_back({all[0], all[1]});
    raw_.edge_ref.push_back(data_.curve[cell]);
  } else {
    ++raw_.other_elements;
    return;
  }
  const std::size_t each = data_.field_components;
  if (!data_.field.empty()) raw_.field.take(std::span(data_.field).subspan(cell * each, each), raw_);
  for (std::size_t s = 0; s < groups_.size(); ++s)
    if (groups_[s].kind == kind && data_.sets[s].second[cell] != 0)
      for (std::size_t m = member; m < std::max(member + 1, end); ++m)
        groups_[s].members.push_back(static_cast<std::uint32_t>(m));
}

void VtkCellTaker::finish() {
  for (RawMesh::Group& group : groups_) raw_.groups.push_back(std::move(group));
}

void add_node_set(RawMesh& raw, std::string_view array, std::span<const std::int64_t> is_member) {
  RawMesh::Group group = group_named(array);
  if (group.kind != Kind::kNodes) return;
  for (std::uint32_t v = 0; v < is_member.size(); ++v)
    if (is_member[v] != 0) group.members.push_back(v);
  raw.groups.push_back(std::move(group));
}

void add_vtk_name(RawMesh& raw, std::string_view array, std::int64_t number) {
  if (number < 0 || number >= std::int64_t{kNone}) return;
  const std::array kinds{std::pair{std::string_view("region "), &raw.region_names},
                         std::pair{std::string_view("patch "), &raw.surface_names},
                         std::pair{std::string_view("curve "), &raw.curve_names}};
  for (const auto& [prefix, names] : kinds)
    if (array.starts_with(prefix)) (*names)[number + 1] = array.substr(prefix.size());
}

}  // namespace octafront::io
