// Gmsh MSH 4.1 and 2.2, binary or text. Regions, patches, curves and sets are physical groups of dimension 3, 2, 1 (of
// nodes: 0); the first three have their number, counted from 1, as tag. Each combination of groups that elements are in
// is an entity. A node belongs to the entity of the least dimension at it. Node and element tags are indices plus 1,
// elements counting the points first, then edges, triangles, tetrahedra.
//
// Of a periodic cell, $Periodic pairs the nodes of each entity of triangles that is a copy with those of its original.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "base/mesh/periodic_nodes.h"
#include "formats/containers/text_writer.h"
#include "formats/parts/boundary.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/msh_writing.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

/// The pairs of nodes of entities of triangles, in the form that both versions share.
class PeriodicLinks {
 public:
  /// `entity_of`: per face the tag of its entity.
  template <class EntityOf>
  PeriodicLinks(const MeshParts& mesh, const EntityOf& entity_of) : mesh_(mesh.mesh()) {
    const std::vector<std::map<VertexIndex, VertexIndex>> originals = originals_by_period();
    for (std::uint32_t period = 0; period < originals.size(); ++period) {
      const auto& original_of = originals[period];
      std::map<Triangle, std::int32_t> entity_at;
      for (std::size_t f = 0; f < mesh_.boundary.size(); ++f) entity_at[sorted(mesh_.boundary[f])] = entity_of(f);
      std::array<VertexIndex, 6> room;
      for (std::size_t f = 0; f < mesh_.boundary.size(); ++f) {
        Triangle original{};
        if (!copied(period, mesh_.boundary[f], original_of, original)) continue;
        const auto at = entity_at.find(sorted(original));
        if (at == entity_at.end()) continue;
        auto& pairs = links_[{static_cast<std::int32_t>(period), entity_of(f), at->second}];
        for (const VertexIndex v : mesh.face_nodes(f, room))
          if (const auto o = original_of.find(v); o != original_of.end()) pairs.insert(*o);
        for (const VertexIndex v : mesh.face_nodes(f, room))
          if (is_own_copy(mesh_, period, v)) pairs.try_emplace(v, v);
      }
    }
  }

  bool empty() const { return links_.empty(); }
  std::size_t size() const { return links_.size(); }

  /// Calls visit(tag, tag of the original, matrix of the period, pairs {copy, original}) for each.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const auto& [link, pairs] : links_)
      visit(link[1], link[2], matrix_of(static_cast<std::size_t>(link[0])), pairs);
  }

 private:
  std::vector<std::map<VertexIndex, VertexIndex>> originals_by_period() const {
    std::vector<std::map<VertexIndex, VertexIndex>> all(mesh_.periods.size());
    for (const auto& [period, copy, original] : mesh_.periodic_nodes) all[period][copy] = original;
    return all;
  }
  static Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  }
  /// Nodes on the axis of a rotation are copies of themselves.
  bool copied(std::uint32_t period, const Triangle& t, const std::map<VertexIndex, VertexIndex>& original_of,
              Triangle& original) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = original_of.find(t[i]);
      if (at == original_of.end() && !is_own_copy(mesh_, period, t[i])) return false;
      original[i] = at == original_of.end() ? t[i] : at->second;
    }
    return original != t;
  }

  /// A period as the sixteen numbers of a matrix.
  std::array<double, 16> matrix_of(std::size_t period) const {
    const Vec3 t = mesh_.periods[period];
    std::array<Vec3, 3> r{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (!mesh_.period_rotations.empty()) r = mesh_.period_rotations[period];
    return {r[0].x, r[0].y, r[0].z, t.x, r[1].x, r[1].y, r[1].z, t.y, r[2].x, r[2].y, r[2].z, t.z, 0, 0, 0, 1};
  }

  const TetMesh& mesh_;
  std::map<std::array<std::int32_t, 3>, std::map<VertexIndex, VertexIndex>> links_;
};

class Msh4Writer {
 public:
  Msh4Writer(AtomicFile& file, const MeshParts& mesh, std::span<const MeshField> fields, bool as_text)
      : text_(file), out_(file, as_text), mesh_(mesh), fields_(fields), cells_(mesh), entities_(mesh, cells_) {
    const std::vector<std::uint32_t> entity = entities_.take_entities_of_nodes();
    nodes_ = group_by_owner(entities_.all().size(), static_cast<std::uint32_t>(entity.size()),
                            [&](std::uint32_t v) { return entity[v]; });
  }

  void write() {
    write_format(text_, out_, "4.1");
    write_physical_names(text_, mesh_, entities_.physical(), true);
    entities_.write(text_, out_);
    write_nodes();
    write_elements();
    if (!mesh_.mesh().periods.empty() && !mesh_.cells_only()) write_periodic();
    const std::size_t before = points().members.items().size() + mesh_.edges() + cells_.faces();
    write_fields(text_, out_, fields_,
                 [&](const MeshField& field, std::size_t i) { return (field.of_elements ? before : 0) + i + 1; });
  }

 private:
  using Entity = MshEntities::Entity;

  template <class... T>
  void put_record(T... values) {
    (out_.put(values), ...);
    out_.end_record();
  }

  /// Sets of nodes are elements, points.
  const Combinations& points() const { return entities_.of_dimension(0); }

  void write_nodes() {
    text_ << "$Nodes\n";
    std::uint64_t blocks = 0;
    for (std::size_t e = 0; e < entities_.all().size(); ++e) blocks += !nodes_[e].empty();
    put_record(blocks, std::uint64_t{nodes_.items().size()}, std::uint64_t{1}, std::uint64_t{mesh_.points()});
    for (std::size_t e = 0; e < entities_.all().size(); ++e) {
      if (nodes_[e].empty()) continue;
      constexpr std::int32_t kNoParameters = 0;
      put_record(std::int32_t{entities_.all()[e].dimension}, entities_.all()[e].tag, kNoParameters,
                 std::uint64_t{nodes_[e].size()});
      put_nodes(nodes_[e], 1, [](VertexIndex v, const auto& put) { put(std::uint64_t{v} + 1); });
      put_nodes(nodes_[e], 3, [this](VertexIndex v, const auto& put) {
        for (int axis = 0; axis < 3; ++axis) put(mesh_.mesh().points[v][axis]);
      });
    }
    out_.close("Nodes");
  }

  void write_elements() {
    // The points are those in sets of nodes.
    std::array<std::uint64_t, 5> first{0, points().members.items().size()};
    const std::array<std::uint64_t, 4> counts{first[1], mesh_.edges(), cells_.faces(), cells_.cells()};
    for (std::size_t d = 1; d < 4; ++d) first[d + 1] = first[d] + counts[d];
    const std::vector<Block> blocks = blocks_of_elements();
    text_ << "$Elements\n";
    put_record(std::uint64_t{blocks.size()}, first[4], std::uint64_t{1}, first[4]);
    for (const Block& block : blocks) {
      put_record(std::int32_t{block.entity->dimension}, block.entity->tag,
                 gmsh_type_of(block.entity->dimension, block.nodes), std::uint64_t{block.members.size()});
      write_members(block, first[static_cast<std::size_t>(block.entity->dimension)]);
    }
    out_.close("Elements");
  }

  void write_periodic() {
    const PeriodicLinks links(mesh_, [&](std::size_t f) {
      return entities_.all()[entities_.first(2) + entities_.of_dimension(2).of[f]].tag;
    });
    text_ << "$Periodic\n";
    put_record(std::uint64_t{links.size()});
    links.for_each([&](std::int32_t tag, std::int32_t of, const std::array<double, 16>& matrix, const auto& pairs) {
      put_record(std::int32_t{2}, tag, of);
      out_.put(std::uint64_t{16});
      for (const double value : matrix) out_.put(value);
      out_.end_record();
      put_record(std::uint64_t{pairs.size()});
      for (const auto& [copy, original] : pairs) put_record(std::uint64_t{copy} + 1, std::uint64_t{original} + 1);
    });
    out_.close("Periodic");
  }

  /// The elements of an entity that have the same type.
  struct Block {
    const Entity* entity;
    std::size_t nodes;
    std::span<const std::uint32_t> members;  ///< points: as in the entity; else elements
    std::vector<std::uint32_t> own = {};     ///< behind `members`, where they are not those of the entity
  };

  std::vector<Block> blocks_of_elements() const {
    std::vector<Block> blocks;
    const bool is_mixed = !mesh_.wide_cells().empty();
    for (const Entity& e : entities_.all()) {
      const auto members = entities_.members_of(e);
      if (e.dimension < 2 || !is_mixed) {
        blocks.push_back({&e, members.empty() ? 0 : nodes_of_element(mesh_, cells_, e.dimension, members[0]), members});
        continue;
      }
      std::size_t last = 0;  // elements of a kind follow each other
      std::uint32_t before = kNone;
      std::vector<std::uint32_t> sorted;
      for (const std::uint32_t m : members) sorted.push_back(entities_.element(e.dimension, m));
      std::sort(sorted.begin(), sorted.end());
      for (const std::uint32_t i : sorted) {
        if (i == before) continue;
        before = i;
        const std::size_t nodes = nodes_of_element(mesh_, cells_, e.dimension, i);
        if (nodes != last) blocks.push_back({&e, nodes, {}});
        last = nodes;
        blocks.back().own.push_back(i);
      }
    }
    for (Block& block : blocks)
      if (!block.own.empty()) block.members = block.own;
    return blocks;
  }

  /// The elements of a block, `before` of which come before those of its dimension.
  void write_members(const Block& block, std::uint64_t before) {
    const Entity& e = *block.entity;
    const auto members = block.members;
    const std::uint64_t points_before = points().members.first(e.dimension == 0 ? e.slot : 0);
    out_.records(members.size(), (1 + block.nodes) * sizeof(std::uint64_t),
                 [&](std::size_t begin, std::size_t end, const auto& put) {
                   ElementNodes nodes_of(mesh_, cells_);
                   for (std::size_t i = begin; i < end; ++i) {
                     put((e.dimension == 0 ? points_before + i : before + members[i]) + 1);
                     nodes_of.put<std::uint64_t>(e.dimension, members[i], put);
                   }
                 });
  }

  /// For each of these nodes what record(v, put) puts, so many values of 64 bits.
  template <class Record>
  void put_nodes(std::span<const VertexIndex> nodes, std::size_t values, const Record& record) {
    out_.records(nodes.size(), values * sizeof(std::uint64_t),
                 [&](std::size_t begin, std::size_t end, const auto& put) {
                   for (std::size_t i = begin; i < end; ++i) record(nodes[i], put);
                 });
  }

  TextWriter text_;
  MshNumbers out_;
  const MeshParts& mesh_;
  std::span<const MeshField> fields_;
  MixedCells cells_;
  MshEntities entities_;
  Groups<> nodes_;  ///< of each entity
};

/// Elements with two tags each: their physical group, and the same as their entity.
class Msh2Writer {
 public:
  Msh2Writer(AtomicFile& file, const MeshParts& mesh, std::span<const MeshField> fields, bool as_text)
      : text_(file), out_(file, as_text), mesh_(mesh), fields_(fields), cells_(mesh), nodes_of_(mesh, cells_) {}

  void write() {
    write_format(text_, out_, "2.2");
    write_physical_names(text_, mesh_, physical_tags(mesh_), false);
    text_.line("$Nodes\n{}", mesh_.points());
    for (std::size_t v = 0; v < mesh_.points(); ++v) {
      put(static_cast<std::int32_t>(v) + 1);
      out_.put(mesh_.mesh().points[v]);
      out_.end_record();
    }
    out_.close("Nodes");
    text_.line("$Elements\n{}", mesh_.edges() + cells_.faces() + cells_.cells());
    write_elements(1, 0, mesh_.edges(), mesh_.nodes_per_edge());
    write_elements(2, 0, cells_.triangles(), mesh_.nodes_per_face());
    write_elements(2, cells_.triangles(), cells_.faces(), cells_.nodes_per_quad());
    for (const MixedCells::Kind kind : MixedCells::kAllKinds)
      write_elements(3, cells_.begin(kind), cells_.end(kind), cells_.nodes_per(kind));
    out_.close("Elements");
    if (!mesh_.mesh().periods.empty() && !mesh_.cells_only()) write_periodic();
    const std::size_t before = mesh_.edges() + cells_.faces();
    write_fields(text_, out_, fields_,
                 [&](const MeshField& field, std::size_t i) { return (field.of_elements ? before : 0) + i + 1; });
  }

 private:
  void put(std::int32_t value) { out_.put(value); }

  /// Always text, also in binary files.
  void write_periodic() {
    const PeriodicLinks links(mesh_, [&](std::size_t f) {
      return static_cast<std::int32_t>(mesh_.tag_of(Part::Origin::kPatch, mesh_.patch_of(f)));
    });
    text_.line("$Periodic\n{}", links.size());
    links.for_each([&](std::int32_t tag, std::int32_t of, const std::array<double, 16>& matrix, const auto& pairs) {
      text_.line("2 {} {}", tag, of);
      text_ << "Affine";
      for (const double value : matrix) text_ << ' ' << value;
      text_.line("\n{}", pairs.size());
      for (const auto& [copy, original] : pairs) text_.line("{} {}", copy + 1, original + 1);
    });
    text_ << "$EndPeriodic\n";
  }

  /// The elements of a dimension from `begin` to `end`, which have so many nodes each.
  void write_elements(int dimension, std::size_t begin, std::size_t end, std::size_t nodes) {
    if (begin == end) return;
    constexpr std::int32_t kTags = 2;
    const std::size_t count = end - begin;
    const std::int32_t type = gmsh_type_of(dimension, nodes);
    // A binary file says once what a text says in every line.
    if (!out_.as_text())
      for (const std::int32_t n : {type, static_cast<std::int32_t>(count), kTags}) put(n);
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      put(++tag_);
      if (out_.as_text())
        for (const std::int32_t n : {type, kTags}) put(n);
      const std::uint32_t part_tag = dimension == 1 ? mesh_.tag_of(Part::Origin::kCurve, mesh_.curve_of(i))
                                     : dimension == 2
                                         ? mesh_.tag_of(Part::Origin::kPatch, mesh_.patch_of(cells_.first_face(i)))
                                         : mesh_.tag_of_region(mesh_.region_of(cells_.first_tet(i)));
      for (int k = 0; k < kTags; ++k) put(static_cast<std::int32_t>(part_tag));
      nodes_of_.put<std::int32_t>(dimension, i, [&](std::int32_t tag) { put(tag); });
      out_.end_record();
    }
  }

  TextWriter text_;
  MshNumbers out_;
  const MeshParts& mesh_;
  std::span<const MeshField> fields_;
  MixedCells cells_;
  ElementNodes nodes_of_;
  std::int32_t tag_ = 0;
};

}  // namespace

void write_msh(MeshOutput& out, const MeshParts& mesh) {
  const bool leaves_nodes =
      mesh.cells_only() &&
      std::any_of(mesh.parts().begin(), mesh.parts().end(), [](const Part& part) { return part.kind == Kind::kNodes; });
  if (leaves_nodes) out.note("Gmsh MSH 4.1 holds sets of nodes as elements: cells only leaves them out");
  note_fields_left_out(out);
  Msh4Writer(out.file(), mesh, out.fields(), out.as_text()).write();
}

void write_msh2(MeshOutput& out, const MeshParts& mesh) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (mesh.points() > kMost || mesh.edges() + mesh.faces() + mesh.tets() > kMost)
    throw OutputError(out.target().string() + ": MSH 2.2 counts with 32 bits, too few for this mesh; write MSH 4.1");
  note_fields_left_out(out);
  Msh2Writer(out.file(), mesh, out.fields(), out.as_text()).write();
}

}  // namespace octafront::io
