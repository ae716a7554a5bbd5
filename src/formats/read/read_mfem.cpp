// MFEM's conforming meshes (v1.0, v1.2, v1.3) of dimension 3: elements, boundary, sets of attributes, vertices, and the
// grid function of curved ones, whose nodes may be of a continuous (H1) or discontinuous (L2) space of any of MFEM's
// kinds of points: polynomials are the same, and their values at our nodes are taken.

#include "base/geometry/tet_lattice.h"
#include "formats/containers/scanner.h"
#include "formats/parts/mfem_nodes.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Corners by MFEM's numbers of kinds: point, segment, triangle, square, tetrahedron, cube, prism, pyramid.
constexpr std::array<std::size_t, 8> kMfemCorners{1, 2, 3, 4, 4, 8, 6, 5};
constexpr std::int64_t kMfemTriangle = 2, kMfemSquare = 3, kMfemTet = 4, kMfemCube = 5;

struct MfemElement {
  std::int64_t attribute, kind;
  std::array<VertexIndex, 8> nodes;

  std::span<const VertexIndex> corners() const {
    return std::span(nodes).first(kMfemCorners[static_cast<std::size_t>(kind)]);
  }
};

/// The name of a set of attributes and what is in it.
struct MfemSet {
  std::string name;
  std::vector<std::int64_t> attributes;
};

/// What the name of a finite element collection says.
struct MfemSpace {
  bool is_continuous;
  MfemPoints points;
  int order;
};

std::optional<int> number_behind(std::string_view text, std::string_view before) {
  const std::size_t at = text.find(before);
  if (at == std::string_view::npos) return std::nullopt;
  int number = 0;
  const char* const begin = text.data() + at + before.size();
  if (std::from_chars(begin, text.data() + text.size(), number).ec != std::errc()) return std::nullopt;
  return number;
}

std::optional<MfemPoints> points_of_letter(char letter) {
  for (const MfemPoints points :
       {MfemPoints::kGaussLegendre, MfemPoints::kGaussLobatto, MfemPoints::kBernstein, MfemPoints::kUniform})
    if (letter == static_cast<char>(points)) return points;
  return std::nullopt;
}

/// Empty: one that nodes are not read of.
std::optional<MfemSpace> space_of(std::string_view name) {
  constexpr std::array<std::string_view, 3> kOld{"Linear", "Quadratic", "Cubic"};
  if (const auto old = std::ranges::find(kOld, name); old != kOld.end())
    return MfemSpace{true, MfemPoints::kUniform, static_cast<int>(old - kOld.begin()) + 1};
  const std::optional<int> order = number_behind(name, "_3D_P");
  if (!order || *order < 1) return std::nullopt;
  if (name.starts_with("H1_")) return MfemSpace{true, MfemPoints::kGaussLobatto, *order};
  if (name.starts_with("H1Pos_")) return MfemSpace{true, MfemPoints::kBernstein, *order};
  std::optional<MfemPoints> points;
  if (name.starts_with("H1@")) points = points_of_letter(name[3]);
  if (name.starts_with("L2_3D")) points = MfemPoints::kGaussLegendre;
  if (name.starts_with("L2_T"))  // MFEM's numbers of these letters
    if (const std::optional<int> type = number_behind(name, "L2_T"); type && *type >= 0 && *type < 5)
      points = points_of_letter(std::string_view("gGPuU")[static_cast<std::size_t>(*type)]);
  if (!points || (name.starts_with("H1") && points == MfemPoints::kGaussLegendre)) return std::nullopt;
  return MfemSpace{name.starts_with("H1"), *points, *order};
}

class Mfem {
 public:
  explicit Mfem(const Input& input) : input_(input), scan_(input, '#') { raw_.format = "MFEM"; }

  RawMesh read() {
    const bool has_sets = read_version();
    expect("dimension");
    if (const std::int64_t d = scan_.integer("the dimension"); d != 3)
      scan_.fail(fmt::format("the mesh is of dimension {}: of dimension 3 it would have volume elements", d));
    elements_ = read_elements("elements");
    if (has_sets) element_sets_ = read_sets("attribute_sets");
    boundary_ = read_elements("boundary");
    if (has_sets) boundary_sets_ = read_sets("bdr_attribute_sets");
    read_places();
    take_boundary();
    take_names(element_sets_, raw_.tet_ref, raw_.region_names, NamedSet::Kind::kElements);
    take_names(boundary_sets_, raw_.triangle_ref, raw_.surface_names, NamedSet::Kind::kFaces);
    return std::move(raw_);
  }

 private:
  /// Whether names follow elements and boundary.
  bool read_version() {
    scan_.word();
    const std::string_view kind = scan_.word(), version = scan_.word();
    const bool is_known = kind == "mesh" && (version == "v1.0" || version == "v1.2" || version == "v1.3");
    if (!is_known)
      scan_.fail(fmt::format(
          "{} is no conforming mesh, which alone is read (\"MFEM mesh\" v1.0, v1.2 or v1.3); an inline mesh "
          "becomes one where MFEM saves it",
          in_quotes(fmt::format("MFEM {} {}", kind, version))));
    return version == "v1.3";
  }

  void expect(std::string_view section) {
    if (scan_.peek_word() != section) scan_.fail_expected(in_quotes(section));
    scan_.word();
  }

  std::uint64_t read_count_of(std::string_view what, std::uint64_t least_bytes) {
    return read_count(scan_, input_, "a count", what, least_bytes);
  }

  std::vector<MfemElement> read_elements(std::string_view section) {
    expect(section);
    std::vector<MfemElement> all(read_count_of(section, 6));
    for (MfemElement& element : all) {
      element.attribute = scan_.integer("an attribute");
      element.kind = scan_.integer("a kind of element");
      if (element.kind < 0 || element.kind >= static_cast<std::int64_t>(kMfemCorners.size()))
        scan_.fail(fmt::format("there is no kind of element {} (0 to 7 are); the file is damaged", element.kind));
      for (std::size_t k = 0; k < element.corners().size(); ++k) element.nodes[k] = read_vertex();
    }
    return all;
  }

  VertexIndex read_vertex() {
    const std::int64_t v = scan_.integer("the number of a vertex");
    if (v < 0 || v >= std::int64_t{kNone}) scan_.fail(fmt::format("there is no vertex {}; the file is damaged", v));
    return static_cast<VertexIndex>(v);
  }

  std::vector<MfemSet> read_sets(std::string_view section) {
    expect(section);
    std::vector<MfemSet> sets(read_count_of(section, 4));
    for (MfemSet& set : sets) {
      set.name = read_set_name();
      const std::uint64_t count = read_count_of("attributes", 2);
      for (std::uint64_t i = 0; i < count; ++i) set.attributes.push_back(scan_.integer("an attribute"));
    }
    return sets;
  }

  /// A word, or in quotes, where a backslash stands before what means itself.
  std::string read_set_name() {
    if (scan_.at_end() || *scan_.position() != '"') return std::string(scan_.word());
    std::string name;
    const char* at = scan_.position() + 1;
    const char* const end = at + (scan_.bytes_left() - 1);
    for (; at != end && *at != '"'; ++at) {
      if (*at == '\\' && at + 1 != end) ++at;
      name += *at;
    }
    if (at == end) scan_.fail("the name of a set of attributes does not end; the file is damaged");
    scan_.set_position(at + 1);
    return name;
  }

  void read_places() {
    expect("vertices");
    vertices_ = read_count_of("vertices", 1);
    require_vertices(elements_), require_vertices(boundary_);
    if (scan_.peek_word() == "nodes") return read_nodes();
    if (const std::int64_t d = scan_.integer("the dimension of space"); d != 3)
      scan_.fail(fmt::format("its vertices have {} coordinates, not 3", d));
    check_claim(input_, scan_.position(), {vertices_, 6, "vertices"}, scan_.bytes_left());
    for (std::size_t v = 0; v < vertices_; ++v) raw_.points.push_back(scan_.point());
    take_linear();
  }

  void require_vertices(const std::vector<MfemElement>& all) const {
    for (const MfemElement& element : all)
      for (const VertexIndex v : element.corners())
        if (v >= vertices_)
          input_.fail(
              fmt::format("an element has the vertex {}, but there are only {} (from 0 on); the file is damaged: "
                          "save it again",
                          v, vertices_));
  }

  void read_nodes() {
    scan_.word();
    expect("FiniteElementSpace");
    expect("FiniteElementCollection:");
    const std::string_view name = scan_.word();
    const std::optional<MfemSpace> space = space_of(name);
    if (!space)
      scan_.fail(fmt::format("nodes of the kind {} are not read; let MFEM save them as H1 or L2 (Mesh::SetCurvature)",
                             in_quotes(name)));
    expect("VDim:");
    if (scan_.integer("the dimension of space") != 3) scan_.fail("nodes have not 3 coordinates");
    expect("Ordering:");
    const std::vector<Vec3> nodes = read_coordinates(scan_.integer("an ordering") != 0);
    take_nodes(*space, nodes);
  }

  /// To the end of the file, or of the mesh.
  std::vector<Vec3> read_coordinates(bool by_node) {
    std::vector<double> values;
    while (!scan_.at_end() && scan_.peek_word() != "mfem_mesh_end") values.push_back(scan_.number("a coordinate"));
    if (values.size() % 3 != 0) input_.fail("the coordinates of its nodes are no multiple of 3; it is truncated");
    std::vector<Vec3> nodes(values.size() / 3);
    for (std::size_t i = 0; i < values.size(); ++i)
      (by_node ? nodes[i / 3][static_cast<int>(i % 3)] : nodes[i % nodes.size()][static_cast<int>(i / nodes.size())]) =
          values[i];
    return nodes;
  }

  void take_nodes(const MfemSpace& space, std::span<const Vec3> nodes) {
    const bool all_tets = std::ranges::all_of(elements_, [](const MfemElement& e) { return e.kind == kMfemTet; });
    const bool is_kept = all_tets && space.order <= kMostOrder;
    if (!space.is_continuous && !is_kept)
      input_.fail(
          "nodes of a discontinuous space (L2) are read of tetrahedra of order 1 to 4; let MFEM save them as H1 "
          "(Mesh::SetCurvature)");
    if (is_kept) return take_curved(space, nodes);
    if (nodes.size() < vertices_) input_.fail(fmt::format("has {} nodes of {} vertices", nodes.size(), vertices_));
    raw_.points.assign(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(vertices_));
    if (space.order > 1)
      raw_.notes.push_back(
          fmt::format("elements of order {} are taken as linear: nodes are read of tetrahedra of order "
                      "2 to 4",
                      space.order));
    take_linear();
  }

  void take_linear() {
    for (const MfemElement& element : elements_) {
      const auto corners = element.corners();
      if (element.kind < kMfemTet)
        ++raw_.other_elements;
      else if (element.kind == kMfemTet)
        raw_.add_tet(corners, element.attribute);
      else if (element.kind == kMfemCube)
        raw_.add_hexahedron(corners, element.attribute);
      else
        raw_.add_wide_cell(corners, element.attribute);
    }
  }

  void take_curved(const MfemSpace& space, std::span<const Vec3> nodes) {
    const std::size_t each = nodes_of_tet(space.order);
    std::vector<Tet> tets;
    for (const MfemElement& e : elements_) tets.push_back({e.nodes[0], e.nodes[1], e.nodes[2], e.nodes[3]});
    const MfemNumbering numbering(tets, vertices_, space.order);
    const std::size_t wanted = space.is_continuous ? numbering.size() : tets.size() * each;
    if (nodes.size() != wanted)
      input_.fail(fmt::format("has {} nodes, not {} of {} elements of order {}; the file is damaged", nodes.size(),
                              wanted, tets.size(), space.order));
    place_nodes(space, numbering, nodes);
    std::vector<VertexIndex> numbers(each);
    for (TetIndex t = 0; t < tets.size(); ++t) {
      numbering.of_tet(t, numbers);
      const std::int64_t attribute = elements_[t].attribute;
      space.order <= 2 ? raw_.add_tet(numbers, attribute, kPlainMids) : raw_.add_high_tet(numbers, attribute);
    }
  }

  /// Our nodes are numbered as MFEM's continuous ones.
  void place_nodes(const MfemSpace& space, const MfemNumbering& numbering, std::span<const Vec3> nodes) {
    const std::vector<double> matrix = matrix_from_mfem(space.points, space.order);
    raw_.points.assign(numbering.size(), Vec3{});
    if (space.is_continuous && matrix.empty()) {
      raw_.points.assign(nodes.begin(), nodes.end());
      return;
    }
    const std::size_t each = nodes_of_tet(space.order);
    std::vector<bool> is_placed(numbering.size(), false);
    std::vector<VertexIndex> numbers(each);
    std::vector<Vec3> given(each);
    for (TetIndex t = 0; t < elements_.size(); ++t) {
      numbering.of_tet(t, numbers);
      for (std::size_t k = 0; k < each; ++k)
        given[k] = nodes[space.is_continuous ? numbers[k] : t * each + place_in_l2(space.order, k)];
      for (std::size_t k = 0; k < each; ++k) {
        Vec3 place = given[k];
        if (!matrix.empty()) {
          place = {};
          for (std::size_t i = 0; i < each; ++i) place += matrix[k * each + i] * given[i];
        }
        if (is_placed[numbers[k]]) {
          require_together(place, raw_.points[numbers[k]], given, t);
          continue;
        }
        raw_.points[numbers[k]] = place;
        is_placed[numbers[k]] = true;
      }
    }
  }

  /// Where MFEM has node k of tet_lattice() among those of an element of a discontinuous space: by z, y, x.
  static std::size_t place_in_l2(int order, std::size_t k) {
    const TetLattice::Weights& w = tet_lattice(order).weights(k);
    const auto in_triangle = [](int n) { return static_cast<std::size_t>((n + 1) * (n + 2) / 2); };
    std::size_t place = 0;
    for (int z = 0; z < w[3]; ++z) place += in_triangle(order - z);
    for (int y = 0; y < w[2]; ++y) place += static_cast<std::size_t>(order - w[3] - y + 1);
    return place + static_cast<std::size_t>(w[1]);
  }

  /// Discontinuous spaces hold periodic meshes, too, whose elements share nodes that lie apart.
  void require_together(const Vec3& a, const Vec3& b, std::span<const Vec3> element, TetIndex t) const {
    constexpr double kApart = 1e-6;  // of an element's size: rounding of files with seven digits, never a period
    double size = 0;
    for (const Vec3& node : element) size = std::max(size, length(node - element[0]));
    if (length(a - b) > kApart * size)
      input_.fail(
          fmt::format("element {} (counted from 0) has a node at ({}, {}, {}) that its neighbour has elsewhere, as "
                      "in periodic meshes, which are not read from MFEM",
                      t, a.x, a.y, a.z));
  }

  void take_boundary() {
    for (const MfemElement& element : boundary_) {
      if (element.kind != kMfemTriangle && element.kind != kMfemSquare)
        ++raw_.other_elements;
      else
        raw_.add_face(element.corners(), element.attribute);
    }
  }

  /// A set of one attribute is its name, others are sets of elements or faces.
  void take_names(const std::vector<MfemSet>& sets, const std::vector<std::int64_t>& refs,
                  std::map<std::int64_t, std::string>& names, NamedSet::Kind kind) {
    for (const MfemSet& set : sets) {
      if (set.attributes.size() == 1 && names.try_emplace(set.attributes[0], set.name).second) continue;
      RawMesh::Group group{set.name, kind, {}};
      for (std::uint32_t i = 0; i < refs.size(); ++i)
        if (std::ranges::find(set.attributes, refs[i]) != set.attributes.end()) group.members.push_back(i);
      if (!group.members.empty()) raw_.groups.push_back(std::move(group));
    }
  }

  const Input& input_;
  Scanner scan_;
  RawMesh raw_;
  std::vector<MfemElement> elements_, boundary_;
  std::vector<MfemSet> element_sets_, boundary_sets_;
  std::size_t vertices_ = 0;
};

}  // namespace

Told told_mfem(const FileHead& head) {
  return head.first == "MFEM" ? Told::kMagic : Told::kNot;
}

RawMesh read_mfem(const Input& input) {
  return Mfem(input).read();
}

}  // namespace octafront::io
