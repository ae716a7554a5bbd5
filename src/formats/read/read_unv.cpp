// I-deas universal files: nodes (datasets 2411, 781), elements (2412), groups (2467, 2477, 2452, 2435); others are
// passed over. Groups make regions, patches and curves; where a kind of element has none, its physical property does.

#include "formats/containers/scanner.h"
#include "formats/parts/raw_mesh.h"
#include "formats/read/id_map.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

/// What is kept of an element type: its kind, nodes, and the places of its list in ours.
struct ElementType {
  Kind kind;
  std::size_t nodes;
  std::array<std::uint8_t, 20> places;
};

const ElementType* kept_type(std::int64_t descriptor) {
  static constexpr ElementType kTet{Kind::kElements, 4, {0, 1, 2, 3}},
      kTet10{Kind::kElements, 10, {0, 4, 1, 5, 2, 6, 7, 8, 9, 3}}, kTriangle{Kind::kFaces, 3, {0, 1, 2}},
      kTriangle6{Kind::kFaces, 6, {0, 3, 1, 4, 2, 5}}, kWedge{Kind::kElements, 6, {0, 1, 2, 3, 4, 5}},
      kWedge15{Kind::kElements, 15, {0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11}},
      kQuad{Kind::kFaces, 4, {0, 1, 2, 3}}, kQuad8{Kind::kFaces, 8, {0, 4, 1, 5, 2, 6, 3, 7}},
      kBeam{Kind::kEdges, 2, {0, 1}}, kBeam3{Kind::kEdges, 3, {0, 2, 1}},
      kHexahedron{Kind::kElements, 8, {0, 1, 2, 3, 4, 5, 6, 7}},
      kHexahedron20{Kind::kElements, 20, {0, 8, 1, 9, 2, 10, 3, 11, 12, 13, 14, 15, 4, 16, 5, 17, 6, 18, 7, 19}};
  switch (descriptor) {
    case 111:
      return &kTet;
    case 118:
      return &kTet10;
    case 112:
      return &kWedge;
    case 113:
      return &kWedge15;
    case 115:
      return &kHexahedron;
    case 116:
      return &kHexahedron20;
    case 41:
    case 51:
    case 61:
    case 74:
    case 81:
    case 91:
      return &kTriangle;
    case 42:
    case 52:
    case 62:
    case 72:
    case 82:
    case 92:
      return &kTriangle6;
    case 44:
    case 54:
    case 64:
    case 71:
    case 84:
    case 94:
      return &kQuad;
    case 45:
    case 55:
    case 65:
    case 85:
    case 95:
      return &kQuad8;
    case 11:
    case 21:
      return &kBeam;
    case 22:
    case 24:
      return &kBeam3;
    default:
      return nullptr;
  }
}

bool is_beam(std::int64_t descriptor) {
  return descriptor == 11 || (descriptor >= 21 && descriptor <= 24);
}

class Unv {
 public:
  explicit Unv(const Input& input) : scan_(input) { raw_.format = "I-deas universal"; }

  RawMesh read() {
    while (!scan_.at_end()) {
      expect_delimiter();
      const std::int64_t dataset = scan_.integer("the number of a dataset");
      if (dataset == 2411 || dataset == 781) {
        read_nodes();
      } else if (dataset == 2412) {
        read_elements();
      } else if (dataset == 2467 || dataset == 2477 || dataset == 2452 || dataset == 2435) {
        read_groups();
      } else {
        skip_dataset();
      }
      expect_delimiter();
    }
    drop_references();
    return std::move(raw_);
  }

 private:
  /// A range of tetrahedra, triangles or edges.
  struct Place {
    Kind kind;
    std::uint32_t first, last;
  };

  bool at_delimiter() { return scan_.peek_word() == "-1" || scan_.at_end(); }
  void expect_delimiter() {
    if (scan_.peek_word() != "-1") scan_.fail_expected("\"-1\"");
    scan_.word();
  }
  void skip_dataset() {
    scan_.skip_line();
    while (!scan_.at_end() && scan_.peek_word() != "-1") scan_.skip_line();
  }

  /// Fortran's doubles: 1.5D+00.
  double real() {
    std::string word(scan_.peek_word());
    std::replace_if(
        word.begin(), word.end(), [](char c) { return c == 'D' || c == 'd'; }, 'e');
    double value = 0;
    if (!parse_number(word, value) || !std::isfinite(value)) scan_.fail_expected("a coordinate");
    scan_.word();
    return value;
  }

  void read_nodes() {
    while (!at_delimiter()) {
      const std::int64_t id = scan_.integer("the number of a node");
      for (int i = 0; i < 3; ++i) scan_.integer("a coordinate system or colour");
      const double x = real(), y = real(), z = real();
      if (!node_ids_.add(id)) scan_.fail(fmt::format("a second node {}; the file is damaged", id));
      raw_.points.push_back({x, y, z});
    }
  }

  void read_elements() {
    while (!at_delimiter()) {
      const std::int64_t id = scan_.integer("the number of an element"), descriptor = scan_.integer("its type"),
                         property = scan_.integer("its property");
      scan_.integer("its material");
      scan_.integer("its colour");
      const std::int64_t count = scan_.integer("its number of nodes");
      if (is_beam(descriptor))
        for (int i = 0; i < 3; ++i) scan_.integer("the section of a beam");
      const ElementType* type = kept_type(descriptor);
      if (type != nullptr && count != static_cast<std::int64_t>(type->nodes))
        scan_.fail(fmt::format("element {} has {} nodes, not {}; the file is damaged", id, count, type->nodes));
      if (type == nullptr) {
        ++raw_.other_elements;
        for (std::int64_t i = 0; i < count; ++i) scan_.integer("a node");
        continue;
      }
      std::array<VertexIndex, 20> nodes;
      for (std::size_t i = 0; i < type->nodes; ++i) nodes[type->places[i]] = node(id);
      add(id, property, type->kind, std::span(nodes).first(type->nodes));
    }
  }

  VertexIndex node(std::int64_t element) {
    const std::int64_t id = scan_.integer("a node");
    const std::uint32_t v = node_ids_.find(id);
    if (v == kNone)
      scan_.fail(
          fmt::format("element {} has the node {}, which the file lacks so far; the file is damaged: export it "
                      "again",
                      element, id));
    return v;
  }

  std::uint32_t count_of(Kind kind) const {
    return static_cast<std::uint32_t>(kind == Kind::kElements ? raw_.tets.size()
                                      : kind == Kind::kFaces  ? raw_.triangles.size()
                                                              : raw_.edges.size());
  }

  void add(std::int64_t id, std::int64_t property, Kind kind, std::span<const VertexIndex> nodes) {
    const std::uint32_t first = count_of(kind);
    if (kind == Kind::kFaces) {
      raw_.add_face(nodes, property);
    } else if (kind == Kind::kEdges) {
      raw_.edges.push_back({nodes[0], nodes[1]});
      raw_.edge_ref.push_back(property);
    } else if (nodes.size() == 4 || nodes.size() == 10) {
      raw_.add_tet(nodes, property);
    } else if (nodes.size() == 8 || nodes.size() == 20) {
      raw_.add_hexahedron(nodes, property);
    } else {
      raw_.add_wide_cell(nodes, property);
    }
    place_[id] = {kind, first, count_of(kind)};
  }

  void read_groups() {
    while (!at_delimiter()) {
      for (int i = 0; i < 7; ++i) scan_.integer("the head of a group");
      const std::int64_t count = scan_.integer("the number of its members");
      scan_.skip_line();
      scan_.skip_line_end();
      const std::string name(scan_.rest_of_line());
      std::array<RawMesh::Group, 4> groups;
      for (std::size_t k = 0; k < 4; ++k) groups[k] = {name, static_cast<Kind>(k), {}};
      constexpr std::int64_t kNode = 7, kElement = 8;
      for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t type = scan_.integer("the type of a member"), id = scan_.integer("the number of a member");
        scan_.integer("a leaf");
        scan_.integer("a component");
        const auto found = place_.find(id);
        if (type == kNode && node_ids_.find(id) != kNone)
          groups[static_cast<std::size_t>(Kind::kNodes)].members.push_back(node_ids_.find(id));
        if (type != kElement || found == place_.end()) continue;
        for (std::uint32_t m = found->second.first; m < found->second.last; ++m)
          groups[static_cast<std::size_t>(found->second.kind)].members.push_back(m);
      }
      for (RawMesh::Group& group : groups)
        if (!group.members.empty() && !is_known(group)) raw_.groups.push_back(std::move(group));
    }
  }

  /// Files may list groups in two datasets, for readers of either.
  bool is_known(const RawMesh::Group& group) const {
    return std::any_of(raw_.groups.begin(), raw_.groups.end(), [&](const RawMesh::Group& known) {
      return known.name == group.name && known.kind == group.kind && known.members == group.members;
    });
  }

  /// Of the kinds of element that have groups.
  void drop_references() {
    for (const RawMesh::Group& group : raw_.groups) {
      if (group.kind == Kind::kElements) raw_.tet_ref.clear();
      if (group.kind == Kind::kFaces) raw_.triangle_ref.clear();
      if (group.kind == Kind::kEdges) raw_.edge_ref.clear();
    }
  }

  Scanner scan_;
  RawMesh raw_;
  IdMap node_ids_;
  std::unordered_map<std::int64_t, Place> place_;  ///< of the elements
};

}  // namespace

Told told_unv(const FileHead& head) {
  const bool is_dataset = head.first == "-1" && is_plain_number(head.second) && head.second.size() <= 5;
  return is_dataset ? Told::kKeyword : Told::kNot;
}

RawMesh read_unv(const Input& input) {
  return Unv(input).read();
}

}  // namespace octafront::io
