#include "formats/write/msh_writing.h"

#include "base/core/parallel.h"
#include "formats/parts/legal_names.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {

using Kind = NamedSet::Kind;

std::int32_t gmsh_type_of(int dimension, std::size_t nodes) {
  using Types = std::map<std::size_t, std::int32_t>;
  static const std::array<Types, 4> kTypes{Types{{1, 15}}, Types{{2, 1}, {3, 8}},
                                           Types{{3, 2}, {4, 3}, {6, 9}, {8, 16}},
                                           Types{{4, 4}, {5, 7}, {6, 6}, {10, 11}, {13, 19}, {15, 18}}};
  return kTypes[static_cast<std::size_t>(dimension)].at(nodes);
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

int dimension_of(Kind kind) {
  return static_cast<int>(std::find(kKindOfDimension.begin(), kKindOfDimension.end(), kind) - kKindOfDimension.begin());
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

MshEntities::MshEntities(const MeshParts& mesh, const MixedCells& cells)
    : mesh_(mesh), cells_(cells), physical_(physical_tags(mesh)) {
  for (std::size_t d = mesh.cells_only() ? 3 : 0; d < 4; ++d) by_[d] = combinations(mesh, kKindOfDimension[d]);
  make();
  of_node_.assign(mesh.points(), kNone);
  for (std::uint32_t e = 0; e < entities_.size(); ++e) entities_[e].box = take_nodes(e).box;
}

std::vector<std::int32_t> MshEntities::physical_of(const Entity& e) const {
  std::vector<std::int32_t> tags;
  for (const std::uint32_t p : by_[static_cast<std::size_t>(e.dimension)].parts[e.slot]) tags.push_back(physical_[p]);
  return tags;
}

/// An entity in one group has its tag, others follow behind all.
void MshEntities::make() {
  for (int d = 0; d < 4; ++d) {
    const auto& parts = by_[static_cast<std::size_t>(d)].parts;
    first_[static_cast<std::size_t>(d)] = entities_.size();
    std::int32_t next = 1;
    for (const auto& groups : parts)
      if (groups.size() == 1) next = std::max(next, physical_[groups[0]] + 1);
    for (std::uint32_t c = 0; c < parts.size(); ++c)
      entities_.push_back({d, c, parts[c].size() == 1 ? physical_[parts[c][0]] : next++});
  }
  first_[4] = entities_.size();
}

/// Gives the nodes of an entity to it that no entity before it has. Returns where they all are.
MshEntities::BoxSum MshEntities::take_nodes(std::uint32_t e) {
  const auto members = members_of(entities_[e]);
  return parallel_sum(members.size(), [&](std::size_t begin, std::size_t end) {
    BoxSum sum;
    ElementNodes nodes_of(mesh_, cells_);
    for (const std::uint32_t m : members.subspan(begin, end - begin))
      nodes_of.put<std::uint64_t>(entities_[e].dimension, element(entities_[e].dimension, m), [&](std::uint64_t tag) {
        const SharedValue of_node(of_node_[tag - 1]);
        if (of_node.load() == kNone) of_node.store(e);
        sum.box.add(mesh_.mesh().points[tag - 1]);
      });
    return sum;
  });
}

/// The tags of the entities of faces that bound each of tetrahedra.
std::vector<std::vector<std::int32_t>> MshEntities::bounding() const {
  std::vector<std::vector<std::int32_t>> of(by_[3].parts.size());
  if (mesh_.faces() == 0) return of;
  for (std::size_t f = 0; f < mesh_.faces(); ++f) {
    const TetIndex t = mesh_.sides()[f].tet;
    if (t == kNone) continue;
    const std::int32_t tag = entities_[first_[2] + by_[2].of[f]].tag;
    auto& list = of[by_[3].of[t]];
    if (list.empty() || list.back() != tag) list.push_back(tag);
  }
  for (auto& list : of) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return of;
}

void MshEntities::write(TextWriter& text, MshNumbers& out) const {
  text << "$Entities\n";
  for (std::size_t d = 0; d < 4; ++d) out.put(std::uint64_t{first_[d + 1] - first_[d]});
  out.end_record();
  const auto surfaces = bounding();
  for (const Entity& e : entities_) {
    const std::vector<std::int32_t> bounded_by = e.dimension == 3 ? surfaces[e.slot] : std::vector<std::int32_t>();
    out.put(e.tag);
    out.put(e.box.lo);
    if (e.dimension > 0) out.put(e.box.hi);
    const std::vector<std::int32_t> groups = physical_of(e);
    out.put(std::uint64_t{groups.size()});
    for (const std::int32_t tag : groups) out.put(tag);
    if (e.dimension > 0) {
      out.put(std::uint64_t{bounded_by.size()});
      for (const std::int32_t tag : bounded_by) out.put(tag);
    }
    out.end_record();
  }
  out.close("Entities");
}

std::size_t nodes_of_element(const MeshParts& mesh, const MixedCells& cells, int dimension, std::uint32_t i) {
  if (dimension == 0) return 1;
  if (dimension == 1) return mesh.nodes_per_edge();
  if (dimension == 2) return i < cells.triangles() ? mesh.nodes_per_face() : cells.nodes_per_quad();
  return cells.nodes_per(cells.kind(i));
}

}  // namespace octafront::io
