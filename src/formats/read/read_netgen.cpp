// Netgen .vol: sections with a count, then as many lines; what is not needed is passed over. Points come last, so that
// indices are checked at the end. See write_netgen.cpp for the order of nodes.

#include "formats/containers/scanner.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <array>
#include <map>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Mid-side nodes behind the corners 1 2 3 4: 12 13 14 23 24 34.
constexpr MidOrder kNetgenMids = kPlainMids;

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
      } else if (section == "points") {
        for_each(section, 6, [this] {
          const double x = scan_.number("a coordinate"), y = scan_.number("a coordinate"),
                       z = scan_.number("a coordinate");
          raw_.points.push_back({x, y, z});
        });
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
    return std::move(raw_);
  }

 private:
  template <class Read>
  void for_each(std::string_view section, std::uint64_t least_bytes, const Read& read_one) {
    scan_.at_end();
    const char* const at = scan_.position();
    const std::int64_t count = scan_.integer("a count");
    if (count < 0) scan_.fail(fmt::format("{} {}; the file is damaged", count, section));
    check_claim(input_, at, {static_cast<std::uint64_t>(count), least_bytes, section}, scan_.bytes_left());
    for (std::int64_t i = 0; i < count; ++i) {
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

  void read_names(std::string_view section, std::map<std::int64_t, std::string>& names) {
    for_each(section, 3, [&] {
      const std::int64_t number = scan_.integer("a number");
      names[number] = scan_.rest_of_line();
    });
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
};

}  // namespace

Told told_netgen(const FileHead& head) {
  return head.first == "mesh3d" ? Told::kMagic : Told::kNot;
}

RawMesh read_netgen(const Input& input) {
  return Netgen(input).read();
}

}  // namespace octafront::io
