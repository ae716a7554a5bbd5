#include "formats/write/msh_writing.h"

#include "base/mesh/periodic_nodes.h"
#include "formats/parts/legal_names.h"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/core.h>

namespace octafront::io {

using Kind = NamedSet::Kind;

std::int32_t gmsh_type_of(std::size_t dimension, std::size_t nodes) {
  using Types = std::map<std::size_t, std::int32_t>;
  static const std::array<Types, 4> kTypes{
      Types{{1, 15}}, Types{{2, 1}, {3, 8}, {4, 26}, {5, 27}},
      Types{{3, 2}, {4, 3}, {6, 9}, {8, 16}, {10, 21}, {15, 23}},
      Types{{4, 4}, {5, 7}, {6, 6}, {10, 11}, {13, 19}, {15, 18}, {20, 29}, {35, 30}}};
  return kTypes[dimension].at(nodes);
}

std::string unquoted(std::string_view name) {
  std::string out = one_line(name);
  std::replace(out.begin(), out.end(), '"', '_');
  return out;
}

namespace {

/// Groups of nodes are groups of elements here, points.
bool has_elements_here(const Part& part, const MeshParts& mesh) {
  return part.kind != Kind::kNodes || !mesh.cells_only();
}

}  // namespace

void write_format(TextWriter& out, MshNumbers& numbers, std::string_view version) {
  out.line("$MeshFormat\n{} {} 8", version, numbers.as_text() ? 0 : 1);
  if (!numbers.as_text()) numbers.put(std::int32_t{1});  // tells the order of bytes
  numbers.close("MeshFormat");
}

bool is_of_gmsh(const MeshField& field) {
  return field.components == 1 || field.components == 3 || field.components == 9;
}

void note_fields_left_out(MeshOutput& out) {
  for (const MeshField& field : out.fields())
    if (!is_of_gmsh(field))
      out.note(fmt::format("Gmsh's fields have 1, 3 or 9 numbers: {}, which has {}, is left out", in_quotes(field.name),
                           field.components));
}

std::vector<std::int32_t> physical_tags(const MeshParts& mesh) {
  std::vector<std::int32_t> tags;
  std::array<std::int32_t, 4> last{};
  for (const Part& part : mesh.parts()) {
    std::int32_t& of_kind = last[static_cast<std::size_t>(part.kind)];
    const std::int32_t tag = part.origin == Part::Origin::kSet ? of_kind + 1 : static_cast<std::int32_t>(part.tag);
    of_kind = std::max(of_kind, tag);
    tags.push_back(tag);
  }
  return tags;
}

void write_physical_names(TextWriter& out, const MeshParts& mesh, const std::vector<std::int32_t>& tags,
                          bool with_sets) {
  std::vector<std::size_t> named;
  for (std::size_t p = 0; p < mesh.parts().size(); ++p) {
    const Part& part = mesh.parts()[p];
    if (part.is_named && has_elements_here(part, mesh) && (with_sets || part.origin != Part::Origin::kSet))
      named.push_back(p);
  }
  out.line("$PhysicalNames\n{}", named.size());
  for (const std::size_t p : named)
    out.line("{} {} \"{}\"", dimension_of(mesh.parts()[p].kind), tags[p], unquoted(mesh.parts()[p].name));
  out << "$EndPhysicalNames\n";
}

std::size_t nodes_of_element(const MeshParts& mesh, const MixedCells& cells, std::size_t dimension, std::uint32_t i) {
  if (dimension == 0) return 1;
  if (dimension == 1) return mesh.nodes_per_edge();
  if (dimension == 2) return i < cells.triangles() ? mesh.nodes_per_face() : cells.nodes_per_quad();
  return cells.nodes_per(cells.kind(i));
}

PeriodicLinks::PeriodicLinks(const MeshParts& mesh, FunctionRef<std::int32_t(std::size_t)> entity_of)
    : mesh_(mesh.mesh()) {
  const Originals originals(mesh_);
  std::map<Triangle, std::int32_t> entity_at;
  for (std::size_t f = 0; f < mesh_.boundary.size(); ++f) entity_at[face_key(mesh_.boundary[f])] = entity_of(f);
  for (std::uint32_t period = 0; period < mesh_.periods.size(); ++period) {
    FaceRoom room;
    for (std::size_t f = 0; f < mesh_.boundary.size(); ++f) {
      const std::optional<Triangle> original = originals.of(period, mesh_.boundary[f]);
      const auto at = original ? entity_at.find(face_key(*original)) : entity_at.end();
      if (at == entity_at.end()) continue;
      auto& pairs = links_[{static_cast<std::int32_t>(period), entity_of(f), at->second}];
      for (const VertexIndex v : mesh.face_nodes(f, room))
        if (const VertexIndex o = originals.of(period, v); o != kNone) pairs.try_emplace(v, o);
    }
  }
}

std::array<double, 16> PeriodicLinks::matrix_of(std::size_t period) const {
  const Vec3 t = mesh_.periods[period];
  std::array<Vec3, 3> r{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (!mesh_.period_rotations.empty()) r = mesh_.period_rotations[period];
  return {r[0].x, r[0].y, r[0].z, t.x, r[1].x, r[1].y, r[1].z, t.y, r[2].x, r[2].y, r[2].z, t.z, 0, 0, 0, 1};
}

}  // namespace octafront::io
