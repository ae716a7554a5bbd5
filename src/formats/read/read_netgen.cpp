// Netgen .vol: sections with a count, then as many lines; what is not needed is passed over. Points come last, so that
// indices are checked at the end. See write_netgen.cpp for the order of nodes.

#include "base/geometry/tet_lattice.h"
#include "formats/containers/scanner.h"
#include "formats/parts/mfem_nodes.h"
#include "formats/parts/netgen_curves.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Mid-side nodes behind the corners 1 2 3 4: 12 13 14 23 24 34.
constexpr MidOrder kNetgenMids = kPlainMids;

/// What "curvedelements" says.
struct CurvesOfFile {
  struct Part {
    std::vector<std::int64_t> order, first;
    std::vector<Vec3> coefficients;
  };
  Part edges, faces;
  std::int64_t order = 1;
  bool is_rational = false;
};

class Netgen {
 public:
  explicit Netgen(const Input& input) : input_(input), scan_(input, '#') { raw_.format = "Netgen"; }

  RawMesh read() {
    scan_.word();
    bool ended = false;
    while (!ended && !scan_.at_end()) {
      const std::string_view section = scan_.word();
      ended = section == "endmesh";
      if (section == "dimension") {
        if (scan_.integer("the dimension") != 3) scan_.fail("the mesh is not of dimension 3");
      } else if (section == "surfaceelements" || section == "surfaceelementsgi" || section == "surfaceelementsuv") {
        for_each(section, 12, [this] { read_surface_element(); });
      } else if (section == "volumeelements") {
        for_each(section, 12, [this] { read_volume_element(); });
      } else if (section == "edgesegmentsgi2") {
        for_each(section, 8, [this] { read_segment(); });
      } else if (section == "edgesegmentsgi3") {
        for_each(section, 8, [this] { read_segment_of_2026(); });
      } else if (section == "edgedescriptors") {
        for_each(section, 8, [this] { read_edge_descriptor(); });
      } else if (section == "points") {
        for_each(section, 6, [this] { raw_.points.push_back(scan_.point()); });
      } else if (section == "curvedelements") {
        read_curves();
      } else if (section == "materials") {
        read_names(section, raw_.region_names);
      } else if (section == "bcnames") {
        read_names(section, raw_.surface_names);
      } else if (section == "cd2names") {
        read_names(section, raw_.curve_names);
      }
    }
    if (!ended) scan_.fail_expected("\"endmesh\"");
    check_indices();
    number_edges_by_descriptors();
    if (curves_) take_curves();
    return std::move(raw_);
  }

 private:
  template <class Read>
  void for_each(std::string_view section, std::uint64_t least_bytes, const Read& read_one) {
    const std::uint64_t count = read_count(scan_, input_, "a count", section, least_bytes);
    for (std::uint64_t i = 0; i < count; ++i) {
      read_one();
      scan_.skip_line();
    }
  }

  VertexIndex vertex() {
    const std::int64_t v = scan_.integer("the number of a point");
    if (v < 1 || v >= std::int64_t{kNone}) scan_.fail(fmt::format("there is no point {}; the file is damaged", v));
    return static_cast<VertexIndex>(v - 1);
  }

  void read_surface_element() {
    scan_.integer("a surface");
    const std::int64_t patch = scan_.integer("a boundary condition");
    scan_.integer("a domain");
    scan_.integer("a domain");
    const std::int64_t nodes = scan_.integer("the number of its points");
    if (nodes != 3 && nodes != 6) {
      ++raw_.other_elements;
      return;
    }
    const VertexIndex a = vertex(), b = vertex(), c = vertex();
    raw_.triangles.push_back({a, b, c});
    raw_.triangle_ref.push_back(patch);
  }

  void read_volume_element() {
    const std::int64_t region = scan_.integer("a material");
    const std::int64_t count = scan_.integer("the number of its points");
    if (count != 4 && count != 10) {
      ++raw_.other_elements;
      return;
    }
    std::array<VertexIndex, 10> nodes;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) nodes[k] = vertex();
    // Netgen's corners turn the other way: exchanging the second and third exchanges 12 with 13, and 24 with 34.
    std::swap(nodes[1], nodes[2]);
    if (count == 10) {
      std::swap(nodes[4], nodes[5]);
      std::swap(nodes[8], nodes[9]);
    }
    raw_.add_tet(std::span(nodes).first(static_cast<std::size_t>(count)), region, kNetgenMids);
  }

  void read_segment() {
    scan_.integer("a surface");
    scan_.integer("0");
    const VertexIndex a = vertex(), b = vertex();
    for (int i = 0; i < 4; ++i) scan_.integer("a number of a segment");
    raw_.edges.push_back({a, b});
    raw_.edge_ref.push_back(scan_.integer("the number of an edge"));
  }

  /// Since April 2026: its last number is that of a descriptor, from 0 on.
  void read_segment_of_2026() {
    const VertexIndex a = vertex(), b = vertex();
    scan_.integer("a triangle"), scan_.integer("a triangle");
    scan_.number("a distance"), scan_.number("a distance");
    raw_.edges.push_back({a, b});
    raw_.edge_ref.push_back(scan_.integer("the number of a descriptor"));
    has_descriptors_ = true;
  }

  /// The number of an edge, seven more, its name.
  void read_edge_descriptor() {
    descriptors_.push_back(scan_.integer("the number of an edge"));
    std::string_view name;
    for (int word = 0; word < 8 && !scan_.at_line_end(); ++word) name = scan_.word();
    if (!name.empty() && name != "default") raw_.curve_names.try_emplace(descriptors_.back(), name);
  }

  void number_edges_by_descriptors() {
    if (!has_descriptors_) return;
    for (std::int64_t& ref : raw_.edge_ref) {
      const bool is_known = ref >= 0 && ref < static_cast<std::int64_t>(descriptors_.size());
      ref = is_known ? descriptors_[static_cast<std::size_t>(ref)] : ref + 1;
    }
  }

  void read_names(std::string_view section, std::map<std::int64_t, std::string>& names) {
    for_each(section, 3, [&] {
      const std::int64_t number = scan_.integer("a number");
      names[number] = scan_.rest_of_line();
    });
  }

  template <class T, class Read>
  std::vector<T> read_list(std::string_view what, std::uint64_t least_bytes, const Read& read_one) {
    std::vector<T> all;
    for_each(what, least_bytes, [&] { all.push_back(read_one()); });
    return all;
  }

  void read_curves() {
    const auto number = [&] { return scan_.integer("a number of curved elements"); };
    const auto vector = [&] { return scan_.point("a coefficient"); };
    CurvesOfFile& curves = curves_.emplace();
    curves.edges.order = read_list<std::int64_t>("edges", 2, number);
    curves.faces.order = read_list<std::int64_t>("faces", 2, number);
    curves.edges.first = read_list<std::int64_t>("edges", 2, number);
    curves.faces.first = read_list<std::int64_t>("faces", 2, number);
    curves.edges.coefficients = read_list<Vec3>("coefficients", 6, vector);
    curves.faces.coefficients = read_list<Vec3>("coefficients", 6, vector);
    read_list<double>("weights", 2, [&] { return scan_.number("a weight"); });
    curves.order = scan_.integer("an order");
    curves.is_rational = scan_.word() == "t";
    scan_.word();  // whether it is of high order
  }

  /// Whether the lists are those of these edges or faces.
  static bool fits(const CurvesOfFile::Part& given, const NetgenCurves::Part& own, std::int64_t order, bool is_edge) {
    const std::size_t count = own.order.size();
    if (given.order.size() != count || given.first.size() != count + 1) return false;
    const auto all = static_cast<std::int64_t>(given.coefficients.size());
    for (std::size_t n = 0; n < count; ++n) {
      if (given.order[n] < 1 || given.order[n] > order || given.first[n] < 0) return false;
      if (given.first[n] > all - netgen_coefficients(given.order[n], is_edge)) return false;
    }
    return true;
  }

  void take_curves() {
    const CurvesOfFile& given = *curves_;
    NetgenCurves curves(raw_.tets, raw_.points.size());
    const bool is_known = !given.is_rational && given.order >= 2 && given.order <= kMostOrder &&
                          raw_.mid_nodes.empty() && fits(given.edges, curves.edges, given.order, true) &&
                          fits(given.faces, curves.faces, given.order, false);
    if (!is_known) {
      raw_.notes.emplace_back(
          "curved elements are taken as they are without: curves are read of tetrahedra of order 2 to "
          "4 that are all of the mesh, and not rational");
      return;
    }
    for (const bool of_edges : {true, false}) {
      const CurvesOfFile::Part& from = of_edges ? given.edges : given.faces;
      NetgenCurves::Part& to = of_edges ? curves.edges : curves.faces;
      to.order = from.order, to.first = from.first, to.coefficients = from.coefficients;
    }
    add_curved_nodes(curves, static_cast<int>(given.order));
  }

  /// Nodes of edges and faces once, as the first element that has them sees them.
  void add_curved_nodes(const NetgenCurves& curves, int order) {
    const TetLattice& lattice = tet_lattice(order);
    const MfemNumbering numbering(raw_.tets, raw_.points.size(), order);
    raw_.points.resize(numbering.size());
    std::vector<bool> is_placed(numbering.size(), false);
    std::vector<VertexIndex> nodes(lattice.size());
    for (TetIndex t = 0; t < raw_.tets.size(); ++t) {
      numbering.of_tet(t, nodes);
      for (std::size_t k = 4; k < nodes.size(); ++k) {
        if (is_placed[nodes[k]]) continue;
        is_placed[nodes[k]] = true;
        std::array<double, 4> at;
        Vec3 place;
        for (std::size_t c = 0; c < 4; ++c) {
          at[c] = static_cast<double>(lattice.weights(k)[c]) / order;
          place += at[c] * raw_.points[raw_.tets[t][c]];
        }
        raw_.points[nodes[k]] = place + curves.added(t, at);
      }
      take_nodes_of_tet(nodes, order);
    }
  }

  void take_nodes_of_tet(std::span<const VertexIndex> nodes, int order) {
    if (order == 2) {
      std::copy_n(nodes.begin() + 4, 6, raw_.mid_nodes.emplace_back().begin());
      return;
    }
    raw_.high_order = static_cast<std::uint32_t>(order);
    raw_.high_nodes.insert(raw_.high_nodes.end(), nodes.begin() + 4, nodes.end());
  }

  void check_indices() const {
    const auto check = [&](const auto& rows) {
      for (const auto& row : rows)
        for (const VertexIndex v : row)
          if (v >= raw_.points.size() && v != kNone)
            input_.fail(
                fmt::format("an element has the point {}, but there are only {}; the file is damaged: export it "
                            "again",
                            v + 1, raw_.points.size()));
    };
    check(raw_.tets);
    check(raw_.mid_nodes);
    check(raw_.triangles);
    check(raw_.edges);
  }

  const Input& input_;
  Scanner scan_;
  RawMesh raw_;
  std::optional<CurvesOfFile> curves_;
  std::vector<std::int64_t> descriptors_;  ///< the number of the edge of each
  bool has_descriptors_ = false;           ///< segments tell one
};

}  // namespace

Told told_netgen(const FileHead& head) {
  return head.first == "mesh3d" ? Told::kMagic : Told::kNot;
}

RawMesh read_netgen(const Input& input) {
  return Netgen(input).read();
}

}  // namespace octafront::io
