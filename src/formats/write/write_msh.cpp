// Gmsh MSH 4.1, binary or text. Regions, patches, curves and sets are physical groups of dimension 3, 2, 1 (of nodes:
// 0); the first three have their number, counted from 1, as tag. Each combination of groups that elements are in is an
// entity. A node belongs to the entity of the least dimension at it. Node and element tags are indices plus 1, elements
// counting the points first, then edges, triangles, tetrahedra. Of a periodic cell, $Periodic pairs the nodes of each
// entity of triangles that is a copy with those of its original.
//
// In parts as Gmsh writes them: one file with $PartitionedEntities and $GhostElements, or a file for each part,
// NAME_1.msh and so on, which holds its ghosts too. Each entity of the whole is the parent of one for each part that
// has elements of it. Tags of nodes and elements are those of the whole. Files are made of one piece after the other,
// the whole mesh being one: what a piece does not know of the others are the entities and how much comes before it.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "base/core/shared_value.h"
#include "formats/write/msh_writing.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

/// Each combination of groups that elements of the whole mesh are in, as an entity of Gmsh, and what things are called
/// there.
class MshWhole {
 public:
  struct Entity {
    std::size_t dimension;
    std::uint32_t slot;  ///< its combination
    std::int32_t tag;
    Box3 box = {};
  };

  /// `parts`: 0 of a mesh that is not divided.
  MshWhole(const MeshParts& mesh, const MixedCells& cells, std::uint32_t parts)
      : mesh_(mesh), cells_(cells), parts_(parts), physical_(physical_tags(mesh)) {
    for (std::size_t d = mesh.cells_only() ? 3 : 0; d < 4; ++d) by_[d] = combinations(mesh, kKindOfDimension[d]);
    make_entities();
    of_node_.assign(mesh.points(), kNone);
    for (std::uint32_t e = 0; e < entities_.size(); ++e) entities_[e].box = take_nodes(e).box;
    for (std::size_t p = 0; p < mesh.parts().size(); ++p) tag_of_part_[key_of(mesh.parts()[p])] = physical_[p];
  }

  const MeshParts& mesh() const { return mesh_; }
  const MixedCells& cells() const { return cells_; }
  std::uint32_t parts() const { return parts_; }
  const std::vector<std::int32_t>& physical() const { return physical_; }
  const std::vector<Entity>& entities() const { return entities_; }  ///< by dimension
  std::span<const std::uint32_t> members_of(const Entity& e) const { return by_[e.dimension].members[e.slot]; }
  /// Tags of the physical groups that it is in.
  std::vector<std::int32_t> physical_of(const Entity& e) const {
    std::vector<std::int32_t> tags;
    for (const std::uint32_t p : by_[e.dimension].parts[e.slot]) tags.push_back(physical_[p]);
    return tags;
  }
  /// The tag of the entity of a face.
  std::int32_t tag_of_face(std::size_t f) const { return entities_[first_[2] + by_[2].of[f]].tag; }
  /// The nodes of each entity that none before it has.
  Groups<> nodes() const {
    return group_by_owner(entities_.size(), static_cast<std::uint32_t>(of_node_.size()),
                          [&](std::uint32_t v) { return of_node_[v]; });
  }

  /// The entity that has these groups of a piece.
  std::size_t entity_of(std::size_t dimension, const MeshParts& piece, const std::vector<std::uint32_t>& groups) const {
    std::vector<std::int32_t> tags;
    for (const std::uint32_t g : groups) tags.push_back(tag_of_part_.at(key_of(piece.parts()[g])));
    return by_groups_[dimension].at(tags);
  }
  /// The tag of what a part has of an entity; tags of a dimension are not shared.
  std::int32_t tag_of(std::size_t entity, std::uint32_t part) const {
    const std::size_t d = entities_[entity].dimension;
    return static_cast<std::int32_t>(last_tag_[d] + 1 + static_cast<std::int64_t>((entity - first_[d]) * parts_) +
                                     part);
  }
  std::int32_t tag_of_ghosts(std::uint32_t part) const {
    return static_cast<std::int32_t>(last_tag_[3] + 1 +
                                     static_cast<std::int64_t>((entities_.size() - first_[3]) * parts_) + part);
  }

  /// Sets of nodes are elements, points, each set by set.
  std::uint64_t tag_of_point_element(GlobalId point) const {
    const std::uint32_t slot = by_[0].of[point];
    const auto of_slot = by_[0].members[slot];
    const auto at = std::lower_bound(of_slot.begin(), of_slot.end(), point);
    return by_[0].members.first(slot) + static_cast<std::uint64_t>(at - of_slot.begin()) + 1;
  }
  std::uint64_t tag_of_element(std::size_t dimension, GlobalId id) const {
    return by_[0].members.items().size() + (dimension > 1 ? mesh_.edges() : 0) + (dimension > 2 ? cells_.faces() : 0) +
           id + 1;
  }
  std::uint64_t last_element() const { return tag_of_element(3, cells_.cells()) - 1; }

  /// $Entities.
  void write(TextWriter& text, MshNumbers& out) const {
    text << "$Entities\n";
    for (std::size_t d = 0; d < 4; ++d) out.put(std::uint64_t{first_[d + 1] - first_[d]});
    out.end_record();
    const auto surfaces = bounding();
    for (const Entity& e : entities_) {
      out.put(e.tag);
      put_place(out, e, e.box, e.dimension == 3 ? surfaces[e.slot] : std::vector<std::int32_t>());
    }
    out.close("Entities");
  }

  /// Where an entity is, its groups, and what bounds it.
  void put_place(MshNumbers& out, const Entity& e, const Box3& box, const std::vector<std::int32_t>& bounded_by) const {
    out.put(box.lo);
    if (e.dimension > 0) out.put(box.hi);
    out.put_list(physical_of(e));
    if (e.dimension > 0) out.put_list(bounded_by);
    out.end_record();
  }

  /// The element that a member of a combination is, or is part of.
  static std::uint32_t element(const MixedCells& cells, std::size_t dimension, std::uint32_t member) {
    return dimension == 3   ? static_cast<std::uint32_t>(cells.cell_of(member))
           : dimension == 2 ? static_cast<std::uint32_t>(cells.face_of(member))
                            : member;
  }

 private:
  using PartKey = std::pair<Part::Origin, std::uint32_t>;
  static PartKey key_of(const Part& part) { return {part.origin, part.number}; }
  struct BoxSum {
    Box3 box;
    void operator+=(const BoxSum& other) { box.add(other.box); }
  };

  /// An entity in one group has its tag, others follow behind all.
  void make_entities() {
    for (std::size_t d = 0; d < 4; ++d) {
      const auto& parts = by_[d].parts;
      first_[d] = entities_.size();
      std::int32_t next = 1;
      for (const auto& groups : parts)
        if (groups.size() == 1) next = std::max(next, physical_[groups[0]] + 1);
      for (std::uint32_t c = 0; c < parts.size(); ++c) {
        entities_.push_back({d, c, parts[c].size() == 1 ? physical_[parts[c][0]] : next++});
        last_tag_[d] = std::max<std::int64_t>(last_tag_[d], entities_.back().tag);
        by_groups_[d][physical_of(entities_.back())] = entities_.size() - 1;
      }
    }
    first_[4] = entities_.size();
    for (const std::int64_t last : last_tag_)
      if (last + static_cast<std::int64_t>((entities_.size() + 1) * parts_) > std::numeric_limits<std::int32_t>::max())
        throw OutputError("Gmsh's tags of entities have 32 bits, too few for so many parts and groups; ask for fewer");
  }

  /// Gives the nodes of an entity to it that no entity before it has. Returns where they all are.
  BoxSum take_nodes(std::uint32_t e) {
    const auto members = members_of(entities_[e]);
    const std::size_t dimension = entities_[e].dimension;
    return parallel_sum(members.size(), [&](std::size_t begin, std::size_t end) {
      BoxSum sum;
      ElementNodes nodes_of(mesh_, cells_);
      for (const std::uint32_t m : members.subspan(begin, end - begin))
        nodes_of.put<std::uint64_t>(dimension, element(cells_, dimension, m), [&](std::uint64_t tag) {
          const SharedValue of_node(of_node_[tag - 1]);
          const std::uint32_t known = of_node.load();
          if (known == e) return;  // whoever took it has put it into a box
          if (known == kNone) of_node.store(e);
          sum.box.add(mesh_.mesh().points[tag - 1]);
        });
      return sum;
    });
  }

  /// The tags of the entities of faces that bound each of tetrahedra.
  std::vector<std::vector<std::int32_t>> bounding() const {
    std::vector<std::vector<std::int32_t>> of(by_[3].parts.size());
    if (mesh_.faces() == 0) return of;
    for (std::size_t f = 0; f < mesh_.faces(); ++f) {
      const TetIndex t = mesh_.sides()[f].tet;
      if (t == kNone) continue;
      auto& list = of[by_[3].of[t]];
      if (list.empty() || list.back() != tag_of_face(f)) list.push_back(tag_of_face(f));
    }
    for (auto& list : of) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return of;
  }

  const MeshParts& mesh_;
  const MixedCells& cells_;
  std::uint32_t parts_;
  std::vector<std::int32_t> physical_;  ///< of each part
  std::array<Combinations, 4> by_;      ///< by dimension
  std::vector<Entity> entities_;
  std::array<std::size_t, 5> first_{};  ///< where those of a dimension begin
  std::array<std::int64_t, 4> last_tag_{};
  std::vector<std::uint32_t> of_node_;  ///< the entity of least dimension at each point
  std::array<std::map<std::vector<std::int32_t>, std::size_t>, 4> by_groups_;
  std::map<PartKey, std::int32_t> tag_of_part_;
};

/// What a file has of an entity; its lists lie in the mesh or here.
struct Leaf {
  std::size_t entity;  ///< kNone: ghosts
  std::size_t dimension;
  std::int32_t tag;
  Box3 box;
  std::span<const std::uint32_t> elements;  ///< points, edges, faces, cells; ascending
  std::span<const VertexIndex> nodes;       ///< that no leaf before has, ascending
  std::vector<std::uint32_t> own_elements = {};
  std::vector<VertexIndex> own_nodes = {};
};

/// Elements of one type, one behind the other.
struct Run {
  std::size_t nodes_each;
  std::span<const std::uint32_t> elements;
};

/// What a file has of a piece. The whole mesh is one, with its entities as they are.
class MshPiece {
 public:
  explicit MshPiece(const MshWhole& whole)
      : whole_(whole), piece_(nullptr), mesh_(whole.mesh()), cells_(whole.cells()), nodes_(whole.nodes()) {
    for (std::size_t e = 0; e < whole.entities().size(); ++e) {
      const MshWhole::Entity& entity = whole.entities()[e];
      Leaf& leaf =
          leaves_.emplace_back(Leaf{e, entity.dimension, entity.tag, entity.box, whole.members_of(entity), nodes_[e]});
      if (entity.dimension < 2 || mesh_.wide_cells().empty()) continue;
      leaf.own_elements = elements_of(entity.dimension, leaf.elements);
      leaf.elements = leaf.own_elements;
    }
  }
  /// `is_alone`: in a file of its own, with its ghosts and their nodes; else of nodes that several pieces have only
  /// those that are its own.
  MshPiece(const MshWhole& whole, const Piece& piece, bool is_alone)
      : whole_(whole),
        piece_(&piece),
        is_alone_(is_alone),
        own_mesh_(std::in_place, piece.mesh,
                  MeshParts::Hidden{.faces = whole.mesh().cells_only(), .last_points = piece.last_points}),
        own_cells_(*own_mesh_),
        mesh_(*own_mesh_),
        cells_(*own_cells_) {
    for (std::size_t d = mesh_.cells_only() ? 3 : 0; d < 4; ++d) add_leaves(d);
    Leaf& ghosts = leaves_.emplace_back(Leaf{kNone, 3, whole.tag_of_ghosts(piece.number), {}, {}, {}});
    for (std::uint32_t c = 0; c < cells_.cells(); ++c)
      if (!is_own(3, cells_.first_tet(c))) ghosts.own_elements.push_back(c);
    share_nodes();
    if (!is_alone || ghosts.own_elements.empty()) leaves_.pop_back();
  }
  MshPiece(const MshPiece&) = delete;
  MshPiece& operator=(const MshPiece&) = delete;

  std::uint32_t number() const { return piece_ == nullptr ? 0 : piece_->number; }
  std::size_t points() const { return mesh_.points(); }
  const std::vector<Leaf>& leaves() const { return leaves_; }

  std::vector<Run> runs_of(const Leaf& leaf) const {
    std::vector<Run> runs;
    const auto nodes_of = [&](std::size_t i) {
      return nodes_of_element(mesh_, cells_, leaf.dimension, leaf.elements[i]);
    };
    for (std::size_t begin = 0, i = 0; i < leaf.elements.size(); ++i) {
      const std::size_t nodes = nodes_of(i);
      if (i + 1 < leaf.elements.size() && nodes_of(i + 1) == nodes) continue;
      runs.push_back({nodes, leaf.elements.subspan(begin, i + 1 - begin)});
      begin = i + 1;
    }
    return runs;
  }

  void put_nodes(MshNumbers& out, const Leaf& leaf) const {
    if (leaf.nodes.empty()) return;
    constexpr std::int32_t kNoParameters = 0;
    out.record(static_cast<std::int32_t>(leaf.dimension), leaf.tag, kNoParameters, std::uint64_t{leaf.nodes.size()});
    out.records(leaf.nodes.size(), sizeof(std::uint64_t), [&](std::size_t begin, std::size_t end, const auto& put) {
      for (std::size_t i = begin; i < end; ++i) put(tag_of_node(leaf.nodes[i]));
    });
    out.records(leaf.nodes.size(), 3 * sizeof(double), [&](std::size_t begin, std::size_t end, const auto& put) {
      for (std::size_t i = begin; i < end; ++i)
        for (int axis = 0; axis < 3; ++axis) put(mesh_.mesh().points[leaf.nodes[i]][axis]);
    });
  }

  void put_elements(MshNumbers& out, const Leaf& leaf) const {
    const std::size_t d = leaf.dimension;
    for (const Run& run : runs_of(leaf)) {
      out.record(static_cast<std::int32_t>(d), leaf.tag, gmsh_type_of(d, run.nodes_each),
                 std::uint64_t{run.elements.size()});
      out.records(run.elements.size(), (1 + run.nodes_each) * sizeof(std::uint64_t),
                  [&](std::size_t begin, std::size_t end, const auto& put) {
                    ElementNodes nodes(mesh_, cells_);
                    for (std::size_t i = begin; i < end; ++i) {
                      put(tag_of_element(d, run.elements[i]));
                      nodes.put<std::uint64_t>(d, run.elements[i], [&](std::uint64_t local) {
                        put(tag_of_node(static_cast<VertexIndex>(local - 1)));
                      });
                    }
                  });
    }
  }

  std::uint64_t tag_of_node(VertexIndex v) const { return (piece_ == nullptr ? v : piece_->point_ids[v]) + 1; }
  std::uint64_t tag_of_element(std::size_t dimension, std::uint32_t i) const {
    if (dimension == 0) return whole_.tag_of_point_element(tag_of_node(i) - 1);
    if (piece_ == nullptr) return whole_.tag_of_element(dimension, i);
    return whole_.tag_of_element(dimension, dimension == 1   ? piece_->edge_ids[i]
                                            : dimension == 2 ? piece_->face_ids[cells_.first_face(i)]
                                                             : piece_->cell_ids[cells_.first_tet(i)]);
  }

  /// Calls visit(tag of an element, whose own it is, the parts that have it as a ghost, ascending): in a file alone its
  /// own ghosts; else each own element that others have, those with an element at one of its corners.
  template <class Visit>
  void for_each_ghost(const Visit& visit) const {
    if (piece_ == nullptr) return;
    if (!is_alone_) return for_each_ghost_elsewhere(visit);
    for (std::uint32_t c = 0; c < cells_.cells(); ++c)
      if (const TetIndex t = cells_.first_tet(c); !is_own(3, t))
        visit(tag_of_element(3, c), piece_->tet_part[t], std::vector{number()});
  }

 private:
  template <class Visit>
  void for_each_ghost_elsewhere(const Visit& visit) const {
    const auto& tets = mesh_.mesh().tets;
    std::vector<std::pair<VertexIndex, std::uint32_t>> others;  // parts at corners
    std::vector<bool> is_at_rim(mesh_.mesh().points.size(), false);
    for (std::size_t t = piece_->own_tets; t < tets.size(); ++t)
      for (const VertexIndex v : tets[t]) {
        others.emplace_back(v, piece_->tet_part[t]);
        is_at_rim[v] = true;
      }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    CellRoom room;
    std::vector<std::uint32_t> parts;
    for (std::uint32_t c = 0; c < cells_.cells(); ++c) {
      if (!is_own(3, cells_.first_tet(c))) continue;
      parts.clear();
      for (const VertexIndex v : cells_.nodes(c, room))
        for (auto at = !is_at_rim[v] ? others.end() : std::lower_bound(others.begin(), others.end(), std::pair(v, 0U));
             at != others.end() && at->first == v; ++at)
          parts.push_back(at->second);
      std::sort(parts.begin(), parts.end());
      parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
      if (!parts.empty()) visit(tag_of_element(3, c), number(), parts);
    }
  }

  /// Members of combinations as elements, ascending, each once.
  std::vector<std::uint32_t> elements_of(std::size_t dimension, std::span<const std::uint32_t> members) const {
    std::vector<std::uint32_t> elements;
    for (const std::uint32_t m : members) elements.push_back(MshWhole::element(cells_, dimension, m));
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    return elements;
  }

  bool is_own(std::size_t dimension, std::uint32_t member) const {
    switch (dimension) {
      case 0:
        return piece_->point_part[member] == piece_->number;
      case 1:
        return piece_->edge_part[member] == piece_->number;
      case 2:
        return mesh_.sides()[member].tet < piece_->own_tets;
      default:
        return member < piece_->own_tets;
    }
  }

  void add_leaves(std::size_t dimension) {
    const Combinations by = combinations(mesh_, kKindOfDimension[dimension]);
    std::map<std::size_t, std::vector<std::uint32_t>> elements;
    for (std::size_t c = 0; c < by.parts.size(); ++c) {
      std::vector<std::uint32_t> own(by.members[c].begin(), by.members[c].end());
      std::erase_if(own, [&](std::uint32_t m) { return !is_own(dimension, m); });
      if (!own.empty()) elements[whole_.entity_of(dimension, mesh_, by.parts[c])] = elements_of(dimension, own);
    }
    for (auto& [entity, own] : elements)
      leaves_.push_back({entity, dimension, whole_.tag_of(entity, number()), {}, {}, {}, std::move(own)});
  }

  /// Each node goes to the first leaf that has it.
  void share_nodes() {
    std::vector<bool> has_leaf(mesh_.points(), false);
    ElementNodes nodes(mesh_, cells_);
    for (Leaf& leaf : leaves_) {
      for (const std::uint32_t element : leaf.own_elements)
        nodes.put<std::uint64_t>(leaf.dimension, element, [&](std::uint64_t tag) {
          const auto v = static_cast<VertexIndex>(tag - 1);
          leaf.box.add(mesh_.mesh().points[v]);
          if (has_leaf[v]) return;
          has_leaf[v] = true;
          if (is_alone_ || is_own(0, v)) leaf.own_nodes.push_back(v);
        });
      std::sort(leaf.own_nodes.begin(), leaf.own_nodes.end());
      leaf.elements = leaf.own_elements, leaf.nodes = leaf.own_nodes;
    }
  }

  const MshWhole& whole_;
  const Piece* piece_;  ///< null: the whole mesh
  bool is_alone_ = false;
  std::optional<MeshParts> own_mesh_;
  std::optional<MixedCells> own_cells_;
  const MeshParts& mesh_;
  const MixedCells& cells_;
  Groups<> nodes_;            ///< of the leaves of the whole
  std::vector<Leaf> leaves_;  ///< by entity; of a file alone its ghosts last
};

/// A file of pieces, each of which is made again for each section.
class MshFile {
 public:
  using Visit = FunctionRef<void(const MshPiece&)>;
  using Pieces = FunctionRef<void(Visit)>;

  MshFile(AtomicFile& file, const MshWhole& whole, bool as_text) : text_(file), out_(file, as_text), whole_(whole) {}

  /// Head, nodes and elements. `with_ghosts`: the parts that have ghosts there; `nodes`: the least and the largest tag.
  void write(Pieces for_each_piece, std::span<const std::uint32_t> with_ghosts,
             std::pair<std::uint64_t, std::uint64_t> nodes) {
    for_each_piece([&](const MshPiece& piece) { count(piece); });
    write_format(text_, out_, "4.1");
    write_physical_names(text_, whole_.mesh(), whole_.physical(), true);
    whole_.write(text_, out_);
    if (whole_.parts() > 0) write_partitioned(with_ghosts);
    text_ << "$Nodes\n";
    out_.record(node_blocks_, nodes_, nodes.first, nodes.second);
    for_each_piece([&](const MshPiece& piece) {
      for (const Leaf& leaf : piece.leaves()) piece.put_nodes(out_, leaf);
    });
    out_.close("Nodes");
    text_ << "$Elements\n";
    const bool is_alone = with_ghosts.size() < whole_.parts();
    out_.record(blocks_, elements_, is_alone ? least_ : 1, is_alone ? most_ : whole_.last_element());
    for_each_piece([&](const MshPiece& piece) {
      for (const Leaf& leaf : piece.leaves()) piece.put_elements(out_, leaf);
    });
    out_.close("Elements");
    if (whole_.parts() == 0 && !whole_.mesh().mesh().periods.empty() && !whole_.mesh().cells_only()) write_periodic();
    if (ghosts_ > 0) write_ghosts(for_each_piece);
  }

  template <class TagOf>
  void write_values(std::span<const MeshField> fields, const TagOf& tag_of, const MixedCells* cells = nullptr) {
    write_fields(text_, out_, fields, tag_of, cells);
  }

 private:
  struct LeafSummary {
    std::size_t entity;
    std::uint32_t part;
    std::int32_t tag;
    Box3 box;
  };

  void count(const MshPiece& piece) {
    for (const Leaf& leaf : piece.leaves()) {
      if (leaf.entity != kNone) leaves_.push_back({leaf.entity, piece.number(), leaf.tag, leaf.box});
      node_blocks_ += !leaf.nodes.empty();
      nodes_ += leaf.nodes.size();
      blocks_ += piece.runs_of(leaf).size();
      elements_ += leaf.elements.size();
      if (whole_.parts() == 0) continue;
      for (const std::uint32_t i : leaf.elements) {
        least_ = std::min(least_, piece.tag_of_element(leaf.dimension, i));
        most_ = std::max(most_, piece.tag_of_element(leaf.dimension, i));
      }
    }
    piece.for_each_ghost([&](std::uint64_t, std::uint32_t, const auto&) { ++ghosts_; });
  }

  void write_partitioned(std::span<const std::uint32_t> with_ghosts) {
    text_ << "$PartitionedEntities\n";
    out_.record(std::uint64_t{whole_.parts()});
    out_.record(std::uint64_t{with_ghosts.size()});
    for (const std::uint32_t part : with_ghosts)
      out_.record(whole_.tag_of_ghosts(part), static_cast<std::int32_t>(part) + 1);
    std::array<std::uint64_t, 4> counts{};
    for (const LeafSummary& leaf : leaves_) ++counts[whole_.entities()[leaf.entity].dimension];
    out_.record(counts[0], counts[1], counts[2], counts[3]);
    std::ranges::stable_sort(leaves_, {},
                             [&](const LeafSummary& leaf) { return whole_.entities()[leaf.entity].dimension; });
    for (const LeafSummary& leaf : leaves_) {
      const MshWhole::Entity& parent = whole_.entities()[leaf.entity];
      for (const std::int32_t value : {leaf.tag, static_cast<std::int32_t>(parent.dimension), parent.tag})
        out_.put(value);
      out_.put_list(std::vector{static_cast<std::int32_t>(leaf.part) + 1});
      whole_.put_place(out_, parent, leaf.box, {});
    }
    out_.close("PartitionedEntities");
  }

  void write_periodic() {
    const PeriodicLinks links(whole_.mesh(), [&](std::size_t f) { return whole_.tag_of_face(f); });
    text_ << "$Periodic\n";
    out_.record(std::uint64_t{links.size()});
    links.for_each([&](std::int32_t tag, std::int32_t of, const std::array<double, 16>& matrix, const auto& pairs) {
      out_.record(std::int32_t{2}, tag, of);
      out_.put(std::uint64_t{16});
      for (const double value : matrix) out_.put(value);
      out_.end_record();
      out_.record(std::uint64_t{pairs.size()});
      for (const auto& [copy, original] : pairs) out_.record(std::uint64_t{copy} + 1, std::uint64_t{original} + 1);
    });
    out_.close("Periodic");
  }

  void write_ghosts(Pieces for_each_piece) {
    text_ << "$GhostElements\n";
    out_.record(ghosts_);
    for_each_piece([&](const MshPiece& piece) {
      piece.for_each_ghost([&](std::uint64_t element, std::uint32_t own, const std::vector<std::uint32_t>& parts) {
        out_.put(element);
        out_.put(static_cast<std::int32_t>(own) + 1);
        out_.put(std::uint64_t{parts.size()});
        for (const std::uint32_t part : parts) out_.put(static_cast<std::int32_t>(part) + 1);
        out_.end_record();
      });
    });
    out_.close("GhostElements");
  }

  TextWriter text_;
  MshNumbers out_;
  const MshWhole& whole_;
  std::vector<LeafSummary> leaves_;
  std::uint64_t node_blocks_ = 0, nodes_ = 0, blocks_ = 0, elements_ = 0, ghosts_ = 0;
  std::uint64_t least_ = std::numeric_limits<std::uint64_t>::max(), most_ = 0;  ///< tags of elements, of pieces
};

/// All in the file that was asked for; `for_each_piece` of a mesh that is not divided visits it as one.
void write_in_one(MeshOutput& out, const MshWhole& whole, std::span<const MeshField> fields, const MixedCells* cells,
                  MshFile::Pieces for_each_piece) {
  std::vector<std::uint32_t> all(whole.parts());
  for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
  MshFile file(out.file(), whole, out.as_text());
  file.write(for_each_piece, all, {1, whole.mesh().points()});
  const std::uint64_t before = whole.tag_of_element(3, 0);
  file.write_values(
      fields, [&](const MeshField& field, std::size_t i) { return (field.of_elements ? before : 1) + i; }, cells);
}

/// The file of one part, with its ghosts.
void write_alone(AtomicFile& to, const MshWhole& whole, const Piece& of, bool as_text) {
  const MshPiece piece(whole, of, true);
  MshFile file(to, whole, as_text);
  file.write([&](MshFile::Visit visit) { visit(piece); }, std::array{of.number},
             {of.point_ids.front() + 1, of.point_ids[piece.points() - 1] + 1});
  file.write_values(of.fields, [&](const MeshField& field, std::size_t i) {
    return field.of_elements ? whole.tag_of_element(3, of.cell_ids[i]) : of.point_ids[i] + 1;
  });
}

}  // namespace

void write_msh(MeshOutput& out, const MeshParts& mesh) {
  const bool leaves_nodes =
      mesh.cells_only() &&
      std::any_of(mesh.parts().begin(), mesh.parts().end(), [](const Part& part) { return part.kind == Kind::kNodes; });
  if (leaves_nodes) out.note("Gmsh MSH 4.1 holds sets of nodes as elements: cells only leaves them out");
  note_fields_left_out(out);
  const MixedCells cells(mesh);
  const MshWhole whole(mesh, cells, 0);
  const MshPiece piece(whole);
  write_in_one(out, whole, out.fields(), &cells, [&](MshFile::Visit visit) { visit(piece); });
}

void write_msh_parts(MeshOutput& out, Pieces& pieces) {
  note_fields_left_out(out);
  if (!pieces.whole().mesh().periods.empty())
    out.note("Gmsh MSH 4.1 in parts is written without the pairs of nodes of a periodic cell");
  const MshWhole whole(pieces.whole(), pieces.cells(), pieces.count());
  if (!out.options().split_files)
    return write_in_one(out, whole, pieces.fields(), nullptr, [&](MshFile::Visit visit) {
      for (std::uint32_t k = 0; k < pieces.count(); ++k) visit(MshPiece(whole, pieces.piece(k), false));
    });
  const std::filesystem::path& target = out.target();
  for (std::uint32_t k = 0; k < pieces.count(); ++k) {
    const std::string name = fmt::format("{}_{}{}", target.stem().string(), k + 1, target.extension().string());
    AtomicFile file(out.piece_file(name), out.context());
    write_alone(file, whole, pieces.piece(k), out.as_text());
    file.commit();
  }
}

}  // namespace octafront::io
