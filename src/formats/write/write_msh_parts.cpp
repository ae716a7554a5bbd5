// Gmsh MSH 4.1 in parts, as Gmsh writes it: one file with $PartitionedEntities and $GhostElements, or a file for each
// part, NAME_1.msh and so on, which holds its ghosts too. Each entity of the whole is the parent of one for each part
// that has elements of it. Tags of nodes and elements are those of the whole. Files are made of one piece after the
// other: what a piece does not know of the others are the entities and how much comes before it.

#include <octafront/error.h>

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

/// What all pieces share: entities of the whole, and what things are called there.
class MshWhole {
 public:
  explicit MshWhole(const Pieces& pieces)
      : mesh_(pieces.whole()), counts_(pieces.counts()), parts_(pieces.count()), entities_(mesh_, pieces.cells()) {
    entities_.take_entities_of_nodes();
    for (std::size_t e = 0; e < entities_.all().size(); ++e) {
      const MshEntities::Entity& entity = entities_.all()[e];
      auto& last = last_tag_[static_cast<std::size_t>(entity.dimension)];
      last = std::max<std::int64_t>(last, entity.tag);
      by_groups_[static_cast<std::size_t>(entity.dimension)][entities_.physical_of(entity)] = e;
    }
    for (const std::int64_t last : last_tag_)
      if (last + static_cast<std::int64_t>((entities_.all().size() + 1) * parts_) >
          std::numeric_limits<std::int32_t>::max())
        throw OutputError("Gmsh's tags of entities have 32 bits, too few for so many parts and groups; ask for fewer");
    const auto& points = entities_.of_dimension(0).members.items();
    for (std::size_t i = 0; i < points.size(); ++i) point_tags_[points[i]] = i + 1;
    for (std::size_t p = 0; p < mesh_.parts().size(); ++p)
      tag_of_part_[key_of(mesh_.parts()[p])] = entities_.physical()[p];
  }

  const MeshParts& mesh() const { return mesh_; }
  const MshEntities& entities() const { return entities_; }
  std::uint32_t parts() const { return parts_; }

  /// The entity of the whole that has these groups of a piece.
  std::size_t entity_of(std::size_t dimension, const MeshParts& piece, const std::vector<std::uint32_t>& groups) const {
    std::vector<std::int32_t> tags;
    for (const std::uint32_t g : groups) tags.push_back(tag_of_part_.at(key_of(piece.parts()[g])));
    return by_groups_[dimension].at(tags);
  }
  /// The tag of what a part has of an entity; tags of a dimension are not shared.
  std::int32_t tag_of(std::size_t entity, std::uint32_t part) const {
    const auto d = static_cast<std::size_t>(entities_.all()[entity].dimension);
    return static_cast<std::int32_t>(last_tag_[d] + 1 +
                                     static_cast<std::int64_t>((entity - entities_.first(d)) * parts_) + part);
  }
  std::int32_t tag_of_ghosts(std::uint32_t part) const {
    return static_cast<std::int32_t>(
        last_tag_[3] + 1 + static_cast<std::int64_t>((entities_.all().size() - entities_.first(3)) * parts_) + part);
  }

  std::uint64_t tag_of_point_element(GlobalId point) const { return point_tags_.at(point); }
  std::uint64_t tag_of_element(std::size_t dimension, GlobalId id) const {
    return point_tags_.size() + (dimension > 1 ? counts_.edges : 0) + (dimension > 2 ? counts_.faces : 0) + id + 1;
  }
  std::uint64_t last_element() const { return tag_of_element(3, counts_.cells) - 1; }
  std::uint64_t nodes() const { return counts_.points; }

 private:
  using PartKey = std::pair<Part::Origin, std::uint32_t>;
  static PartKey key_of(const Part& part) { return {part.origin, part.number}; }

  const MeshParts& mesh_;
  WholeCounts counts_;
  std::uint32_t parts_;
  MshEntities entities_;
  std::array<std::int64_t, 4> last_tag_{};
  std::array<std::map<std::vector<std::int32_t>, std::size_t>, 4> by_groups_;
  std::map<GlobalId, std::uint64_t> point_tags_;
  std::map<PartKey, std::int32_t> tag_of_part_;
};

/// What a piece has of an entity.
struct Leaf {
  std::size_t entity;
  std::size_t dimension;
  std::vector<std::uint32_t> elements;  ///< points, edges, faces, cells of the piece; ascending
  Box3 box;
  std::vector<VertexIndex> nodes;  ///< that no leaf before has
};

/// Elements of one type, one behind the other.
struct Run {
  std::size_t nodes_each;
  std::span<const std::uint32_t> elements;
};

class MshPiece {
 public:
  MshPiece(const MshWhole& whole, const Piece& piece)
      : whole_(whole),
        piece_(piece),
        mesh_(piece.mesh, {.faces = whole.mesh().cells_only(), .last_points = piece.last_points}),
        cells_(mesh_) {
    for (std::size_t d = mesh_.cells_only() ? 3 : 0; d < 4; ++d) add_leaves(d);
    for (std::uint32_t c = 0; c < cells_.cells(); ++c)
      if (!is_own(c)) ghosts_.push_back(c);
    share_nodes();
  }

  std::uint32_t number() const { return piece_.number; }
  const std::vector<Leaf>& leaves() const { return leaves_; }
  const std::vector<std::uint32_t>& ghosts() const { return ghosts_; }
  /// Nodes that only ghosts have.
  const std::vector<VertexIndex>& ghost_nodes() const { return ghost_nodes_; }
  const Piece& piece() const { return piece_; }
  bool is_own_point(VertexIndex v) const { return piece_.point_part[v] == piece_.number; }
  std::uint64_t tag_of_cell(std::uint32_t cell) const {
    return whole_.tag_of_element(3, piece_.cell_ids[cells_.first_tet(cell)]);
  }
  std::uint32_t part_of_cell(std::uint32_t cell) const { return piece_.tet_part[cells_.first_tet(cell)]; }

  std::vector<Run> runs_of(std::size_t dimension, std::span<const std::uint32_t> elements) const {
    std::vector<Run> runs;
    for (std::size_t begin = 0, i = 0; i < elements.size(); ++i) {
      const std::size_t nodes = nodes_of(dimension, elements[i]);
      if (i + 1 < elements.size() && nodes_of(dimension, elements[i + 1]) == nodes) continue;
      runs.push_back({nodes, elements.subspan(begin, i + 1 - begin)});
      begin = i + 1;
    }
    return runs;
  }

  void put_nodes(MshNumbers& out, int dimension, std::int32_t tag, std::span<const VertexIndex> nodes) const {
    for (const std::int32_t value : {std::int32_t{dimension}, tag, 0}) out.put(value);
    out.put(std::uint64_t{nodes.size()});
    out.end_record();
    out.records(nodes.size(), sizeof(std::uint64_t), [&](std::size_t begin, std::size_t end, const auto& put) {
      for (std::size_t i = begin; i < end; ++i) put(std::uint64_t{piece_.point_ids[nodes[i]]} + 1);
    });
    out.records(nodes.size(), 3 * sizeof(double), [&](std::size_t begin, std::size_t end, const auto& put) {
      for (std::size_t i = begin; i < end; ++i)
        for (int axis = 0; axis < 3; ++axis) put(mesh_.mesh().points[nodes[i]][axis]);
    });
  }

  void put_elements(MshNumbers& out, std::size_t dimension, std::int32_t tag,
                    std::span<const std::uint32_t> elements) const {
    for (const Run& run : runs_of(dimension, elements)) {
      const int d = static_cast<int>(dimension);
      for (const std::int32_t value : {std::int32_t{d}, tag, gmsh_type_of(d, run.nodes_each)}) out.put(value);
      out.put(std::uint64_t{run.elements.size()});
      out.end_record();
      out.records(run.elements.size(), (1 + run.nodes_each) * sizeof(std::uint64_t),
                  [&](std::size_t begin, std::size_t end, const auto& put) {
                    ElementNodes nodes(mesh_, cells_);
                    for (std::size_t i = begin; i < end; ++i) {
                      put(tag_of_element(dimension, run.elements[i]));
                      nodes.put<std::uint64_t>(d, run.elements[i], [&](std::uint64_t local) {
                        put(std::uint64_t{piece_.point_ids[local - 1]} + 1);
                      });
                    }
                  });
    }
  }

  /// Of all its elements, ghosts too.
  std::pair<std::uint64_t, std::uint64_t> least_and_most_tag() const {
    std::uint64_t least = whole_.last_element(), most = 0;
    const auto add = [&](std::size_t dimension, std::span<const std::uint32_t> elements) {
      for (const std::uint32_t i : elements) {
        least = std::min(least, tag_of_element(dimension, i));
        most = std::max(most, tag_of_element(dimension, i));
      }
    };
    for (const Leaf& leaf : leaves_) add(leaf.dimension, leaf.elements);
    add(3, ghosts_);
    return {least, most};
  }

  /// Calls visit(tag, the other parts that have it as a ghost, ascending) for each own element that some have: those
  /// with an element at one of its corners.
  template <class Visit>
  void for_each_ghost_elsewhere(const Visit& visit) const {
    const auto& tets = mesh_.mesh().tets;
    std::vector<std::pair<VertexIndex, std::uint32_t>> others;  // parts at corners
    std::vector<bool> is_at_rim(mesh_.mesh().points.size(), false);
    for (std::size_t t = piece_.own_tets; t < tets.size(); ++t)
      for (const VertexIndex v : tets[t]) {
        others.emplace_back(v, piece_.tet_part[t]);
        is_at_rim[v] = true;
      }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    std::array<VertexIndex, 15> room;
    std::vector<std::uint32_t> parts;
    for (std::uint32_t c = 0; c < cells_.cells(); ++c) {
      if (!is_own(c)) continue;
      parts.clear();
      for (const VertexIndex v : cells_.nodes(c, room))
        for (auto at = !is_at_rim[v] ? others.end() : std::lower_bound(others.begin(), others.end(), std::pair(v, 0U));
             at != others.end() && at->first == v; ++at)
          parts.push_back(at->second);
      std::sort(parts.begin(), parts.end());
      parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
      if (!parts.empty()) visit(tag_of_cell(c), parts);
    }
  }

 private:
  bool is_own(std::uint32_t cell) const { return cells_.first_tet(cell) < piece_.own_tets; }

  bool is_own(std::size_t dimension, std::uint32_t member) const {
    switch (dimension) {
      case 0:
        return is_own_point(member);
      case 1:
        return piece_.edge_part[member] == piece_.number;
      case 2:
        return mesh_.sides()[member].tet < piece_.own_tets;
      default:
        return member < piece_.own_tets;
    }
  }

  std::size_t nodes_of(std::size_t dimension, std::uint32_t i) const {
    return nodes_of_element(mesh_, cells_, static_cast<int>(dimension), i);
  }

  std::uint64_t tag_of_element(std::size_t dimension, std::uint32_t i) const {
    switch (dimension) {
      case 0:
        return whole_.tag_of_point_element(piece_.point_ids[i]);
      case 1:
        return whole_.tag_of_element(1, piece_.edge_ids[i]);
      case 2:
        return whole_.tag_of_element(2, piece_.face_ids[cells_.first_face(i)]);
      default:
        return tag_of_cell(i);
    }
  }

  void add_leaves(std::size_t dimension) {
    const Combinations by = combinations(mesh_, kKindOfDimension[dimension]);
    std::map<std::size_t, std::vector<std::uint32_t>> elements;
    for (std::size_t c = 0; c < by.parts.size(); ++c) {
      std::vector<std::uint32_t> own;
      for (const std::uint32_t m : by.members[c]) {
        if (!is_own(dimension, m)) continue;
        own.push_back(dimension == 3   ? static_cast<std::uint32_t>(cells_.cell_of(m))
                      : dimension == 2 ? static_cast<std::uint32_t>(cells_.face_of(m))
                                       : m);
      }
      std::sort(own.begin(), own.end());
      own.erase(std::unique(own.begin(), own.end()), own.end());
      if (!own.empty()) elements[whole_.entity_of(dimension, mesh_, by.parts[c])] = std::move(own);
    }
    for (auto& [entity, own] : elements) leaves_.push_back({entity, dimension, std::move(own), {}, {}});
  }

  void share_nodes() {
    std::vector<bool> has_leaf(mesh_.points(), false);
    ElementNodes nodes(mesh_, cells_);
    const auto take = [&](std::size_t dimension, std::uint32_t element, std::vector<VertexIndex>& to, Box3* box) {
      nodes.put<std::uint64_t>(static_cast<int>(dimension), element, [&](std::uint64_t tag) {
        const auto v = static_cast<VertexIndex>(tag - 1);
        if (box != nullptr) box->add(mesh_.mesh().points[v]);
        if (has_leaf[v]) return;
        has_leaf[v] = true;
        to.push_back(v);
      });
    };
    for (Leaf& leaf : leaves_) {
      for (const std::uint32_t element : leaf.elements) take(leaf.dimension, element, leaf.nodes, &leaf.box);
      std::sort(leaf.nodes.begin(), leaf.nodes.end());
    }
    for (const std::uint32_t ghost : ghosts_) take(3, ghost, ghost_nodes_, nullptr);
    std::sort(ghost_nodes_.begin(), ghost_nodes_.end());
  }

  const MshWhole& whole_;
  const Piece& piece_;
  MeshParts mesh_;
  MixedCells cells_;
  std::vector<Leaf> leaves_;  ///< by entity
  std::vector<std::uint32_t> ghosts_;
  std::vector<VertexIndex> ghost_nodes_;
};

/// What has to be known of all pieces before the first one is written.
struct LeafSummary {
  std::size_t entity;
  std::uint32_t part;
  Box3 box;
  std::uint64_t own_nodes;
};

class MshPartsFile {
 public:
  MshPartsFile(AtomicFile& file, const MshWhole& whole, bool as_text)
      : text_(file), out_(file, as_text), whole_(whole) {}

  void write_head(const std::vector<LeafSummary>& leaves, std::span<const std::uint32_t> with_ghosts) {
    write_format(text_, out_, "4.1");
    write_physical_names(text_, whole_.mesh(), whole_.entities().physical(), true);
    whole_.entities().write(text_, out_);
    text_ << "$PartitionedEntities\n";
    put_record(std::uint64_t{whole_.parts()});
    put_record(std::uint64_t{with_ghosts.size()});
    for (const std::uint32_t part : with_ghosts)
      put_record(whole_.tag_of_ghosts(part), static_cast<std::int32_t>(part) + 1);
    const auto dimension = [&](const LeafSummary& leaf) { return whole_.entities().all()[leaf.entity].dimension; };
    for (int d = 0; d < 4; ++d)
      out_.put(static_cast<std::uint64_t>(
          std::ranges::count_if(leaves, [&](const LeafSummary& leaf) { return dimension(leaf) == d; })));
    out_.end_record();
    for (int d = 0; d < 4; ++d)
      for (const LeafSummary& leaf : leaves)
        if (dimension(leaf) == d) put_leaf(leaf);
    out_.close("PartitionedEntities");
  }

  template <class... T>
  void put_record(T... values) {
    (out_.put(values), ...);
    out_.end_record();
  }
  TextWriter& text() { return text_; }
  MshNumbers& out() { return out_; }

 private:
  void put_leaf(const LeafSummary& leaf) {
    const MshEntities::Entity& parent = whole_.entities().all()[leaf.entity];
    for (const std::int32_t value : {whole_.tag_of(leaf.entity, leaf.part), std::int32_t{parent.dimension}, parent.tag})
      out_.put(value);
    out_.put(std::uint64_t{1});
    out_.put(static_cast<std::int32_t>(leaf.part) + 1);
    out_.put(leaf.box.lo);
    if (parent.dimension > 0) out_.put(leaf.box.hi);
    const std::vector<std::int32_t> groups = whole_.entities().physical_of(parent);
    out_.put(std::uint64_t{groups.size()});
    for (const std::int32_t tag : groups) out_.put(tag);
    if (parent.dimension > 0) out_.put(std::uint64_t{0});  // what bounds it
    out_.end_record();
  }

  TextWriter text_;
  MshNumbers out_;
  const MshWhole& whole_;
};

void write_ghost_line(MshPartsFile& file, std::uint64_t element, std::uint32_t own,
                      std::span<const std::uint32_t> parts) {
  file.out().put(element);
  file.out().put(static_cast<std::int32_t>(own) + 1);
  file.out().put(std::uint64_t{parts.size()});
  for (const std::uint32_t part : parts) file.out().put(static_cast<std::int32_t>(part) + 1);
  file.out().end_record();
}

/// One file for all parts.
class MshInParts {
 public:
  MshInParts(MeshOutput& out, Pieces& pieces)
      : pieces_(pieces), whole_(pieces), file_(out.file(), whole_, out.as_text()) {}

  void write() {
    summarize();
    std::vector<std::uint32_t> all(pieces_.count());
    for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
    file_.write_head(leaves_, all);
    write_nodes();
    write_elements();
    write_ghosts();
    const std::uint64_t before = whole_.tag_of_element(3, 0);
    write_fields(file_.text(), file_.out(), pieces_.fields(),
                 [&](const MeshField& field, std::size_t i) { return (field.of_elements ? before : 1) + i; });
  }

 private:
  template <class Visit>
  void for_each_piece(const Visit& visit) {
    for (std::uint32_t k = 0; k < pieces_.count(); ++k) {
      const Piece piece = pieces_.piece(k);
      visit(MshPiece(whole_, piece));
    }
  }

  void summarize() {
    for_each_piece([&](const MshPiece& piece) {
      for (const Leaf& leaf : piece.leaves()) {
        const auto own = std::ranges::count_if(leaf.nodes, [&](VertexIndex v) { return piece.is_own_point(v); });
        leaves_.push_back({leaf.entity, piece.number(), leaf.box, static_cast<std::uint64_t>(own)});
        blocks_of_nodes_ += own > 0;
        blocks_ += piece.runs_of(leaf.dimension, leaf.elements).size();
        elements_ += leaf.elements.size();
      }
      piece.for_each_ghost_elsewhere([&](std::uint64_t, const auto&) { ++ghosts_; });
    });
  }

  void write_nodes() {
    file_.text() << "$Nodes\n";
    file_.put_record(blocks_of_nodes_, whole_.nodes(), std::uint64_t{1}, whole_.nodes());
    for_each_piece([&](const MshPiece& piece) {
      for (const Leaf& leaf : piece.leaves()) {
        std::vector<VertexIndex> own;
        for (const VertexIndex v : leaf.nodes)
          if (piece.is_own_point(v)) own.push_back(v);
        if (!own.empty())
          piece.put_nodes(file_.out(), static_cast<int>(leaf.dimension), whole_.tag_of(leaf.entity, piece.number()),
                          own);
      }
    });
    file_.out().close("Nodes");
  }

  void write_elements() {
    file_.text() << "$Elements\n";
    file_.put_record(blocks_, elements_, std::uint64_t{1}, whole_.last_element());
    for_each_piece([&](const MshPiece& piece) {
      for (const Leaf& leaf : piece.leaves())
        piece.put_elements(file_.out(), leaf.dimension, whole_.tag_of(leaf.entity, piece.number()), leaf.elements);
    });
    file_.out().close("Elements");
  }

  void write_ghosts() {
    if (ghosts_ == 0) return;
    file_.text() << "$GhostElements\n";
    file_.put_record(ghosts_);
    for_each_piece([&](const MshPiece& piece) {
      piece.for_each_ghost_elsewhere([&](std::uint64_t element, const std::vector<std::uint32_t>& parts) {
        write_ghost_line(file_, element, piece.number(), parts);
      });
    });
    file_.out().close("GhostElements");
  }

  Pieces& pieces_;
  MshWhole whole_;
  MshPartsFile file_;
  std::vector<LeafSummary> leaves_;
  std::uint64_t blocks_of_nodes_ = 0, blocks_ = 0, elements_ = 0, ghosts_ = 0;
};

/// The file of one part, with its ghosts.
void write_alone(AtomicFile& file, const MshWhole& whole, const MshPiece& piece, bool as_text) {
  MshPartsFile to(file, whole, as_text);
  std::vector<LeafSummary> leaves;
  std::uint64_t nodes = piece.ghost_nodes().size(), elements = piece.ghosts().size();
  std::uint64_t node_blocks = !piece.ghost_nodes().empty(), blocks = piece.runs_of(3, piece.ghosts()).size();
  for (const Leaf& leaf : piece.leaves()) {
    leaves.push_back({leaf.entity, piece.number(), leaf.box, leaf.nodes.size()});
    nodes += leaf.nodes.size();
    node_blocks += !leaf.nodes.empty();
    blocks += piece.runs_of(leaf.dimension, leaf.elements).size();
    elements += leaf.elements.size();
  }
  to.write_head(leaves, std::array{piece.number()});
  to.text() << "$Nodes\n";
  const std::vector<GlobalId>& points = piece.piece().point_ids;
  to.put_record(node_blocks, nodes, nodes == 0 ? 0 : points.front() + 1, nodes == 0 ? 0 : points[nodes - 1] + 1);
  for (const Leaf& leaf : piece.leaves())
    if (!leaf.nodes.empty())
      piece.put_nodes(to.out(), static_cast<int>(leaf.dimension), whole.tag_of(leaf.entity, piece.number()),
                      leaf.nodes);
  const std::int32_t ghosts = whole.tag_of_ghosts(piece.number());
  if (!piece.ghost_nodes().empty()) piece.put_nodes(to.out(), 3, ghosts, piece.ghost_nodes());
  to.out().close("Nodes");
  to.text() << "$Elements\n";
  const auto [least, most] = piece.least_and_most_tag();
  to.put_record(blocks, elements, least, most);
  for (const Leaf& leaf : piece.leaves())
    piece.put_elements(to.out(), leaf.dimension, whole.tag_of(leaf.entity, piece.number()), leaf.elements);
  piece.put_elements(to.out(), 3, ghosts, piece.ghosts());
  to.out().close("Elements");
  if (!piece.ghosts().empty()) {
    to.text() << "$GhostElements\n";
    to.put_record(std::uint64_t{piece.ghosts().size()});
    for (const std::uint32_t ghost : piece.ghosts())
      write_ghost_line(to, piece.tag_of_cell(ghost), piece.part_of_cell(ghost), std::array{piece.number()});
    to.out().close("GhostElements");
  }
  const Piece& of = piece.piece();
  write_fields(to.text(), to.out(), of.fields, [&](const MeshField& field, std::size_t i) {
    return field.of_elements ? whole.tag_of_element(3, of.cell_ids[i]) : of.point_ids[i] + 1;
  });
}

std::string split_name(const std::filesystem::path& target, std::uint32_t part) {
  return fmt::format("{}_{}{}", target.stem().string(), part + 1, target.extension().string());
}

}  // namespace

void write_msh_parts(MeshOutput& out, Pieces& pieces) {
  note_fields_left_out(out);
  if (!pieces.whole().mesh().periods.empty())
    out.note("Gmsh MSH 4.1 in parts is written without the pairs of nodes of a periodic cell");
  if (!out.options().split_files) return MshInParts(out, pieces).write();
  const MshWhole whole(pieces);
  for (std::uint32_t k = 0; k < pieces.count(); ++k) {
    const Piece piece = pieces.piece(k);
    AtomicFile file(out.piece_file(split_name(out.target(), k)), out.context());
    write_alone(file, whole, MshPiece(whole, piece), out.as_text());
    file.commit();
  }
}

}  // namespace octafront::io
