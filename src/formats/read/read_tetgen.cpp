// TetGen: NAME.node, NAME.ele, and, where they are there, NAME.face and NAME.edge. Numbers count from 0 or 1, as the
// first node says. Markers and the first attribute of tetrahedra are references.

#include "formats/containers/named_file.h"
#include "formats/containers/scanner.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Mid-side nodes behind the corners: 34 14 12 23 24 13.
constexpr MidOrder kTetgenMids{5, 2, 0, 3, 4, 1};

class Tetgen {
 public:
  explicit Tetgen(const TetgenFiles& files) : files_(files) { raw_.format = "TetGen"; }

  RawMesh read() {
    read_nodes();
    read_tets();
    if (files_.face)
      read_rows(*files_.face, "triangles", [&](Scanner& scan, bool has_marker) {
        raw_.triangles.push_back({vertex(scan), vertex(scan), vertex(scan)});
        raw_.triangle_ref.push_back(has_marker ? scan.integer("a marker") : 1);
      });
    if (files_.edge)
      read_rows(*files_.edge, "edges", [&](Scanner& scan, bool has_marker) {
        raw_.edges.push_back({vertex(scan), vertex(scan)});
        raw_.edge_ref.push_back(has_marker ? scan.integer("a marker") : 1);
      });
    return std::move(raw_);
  }

 private:
  void read_nodes() {
    Scanner scan(files_.node, '#');
    const auto n = static_cast<std::int64_t>(read_count(scan, files_.node, "nodes", 8));
    if (scan.integer("the dimension") != 3) scan.fail("the nodes are not of dimension 3");
    scan.skip_line();
    for (std::int64_t i = 0; i < n; ++i) {
      const std::int64_t id = scan.integer("the number of a node");
      if (i == 0) first_ = id;
      if ((first_ != 0 && first_ != 1) || id != first_ + i)
        scan.fail(
            fmt::format("expected node {}, found {}; nodes count from 0 or 1, one after the other", first_ + i, id));
      raw_.points.push_back(scan.point());
      scan.skip_line();
    }
  }

  VertexIndex vertex(Scanner& scan) const {
    const std::int64_t v = scan.integer("a node");
    if (v < first_ || static_cast<std::uint64_t>(v - first_) >= raw_.points.size())
      scan.fail(fmt::format("there is no node {}; the file is damaged", v));
    return static_cast<VertexIndex>(v - first_);
  }

  void read_tets() {
    Scanner scan(files_.ele, '#');
    const auto n = static_cast<std::int64_t>(read_count(scan, files_.ele, "tetrahedra", 10));
    const std::int64_t nodes = scan.integer("the nodes of each"), attributes = scan.integer("the number of attributes");
    if (nodes != 4 && nodes != 10) scan.fail(fmt::format("tetrahedra of {} nodes; expected 4 or 10", nodes));
    std::array<VertexIndex, 10> all;
    for (std::int64_t i = 0; i < n; ++i) {
      scan.integer("the number of a tetrahedron");
      for (std::size_t k = 0; k < static_cast<std::size_t>(nodes); ++k) all[k] = vertex(scan);
      // Attributes are reals that mostly are whole.
      const double region = attributes > 0 ? scan.number("an attribute") : 1;
      const bool is_whole = std::abs(region) < 1e15 && region == std::floor(region);
      raw_.add_tet(std::span(all).first(static_cast<std::size_t>(nodes)),
                   is_whole ? static_cast<std::int64_t>(region) : 1, kTetgenMids);
      scan.skip_line();
    }
  }

  template <class Row>
  void read_rows(const Input& input, std::string_view what, const Row& row) {
    Scanner scan(input, '#');
    const auto n = static_cast<std::int64_t>(read_count(scan, input, what, 6));
    const bool has_marker = scan.integer("whether there are markers") > 0;
    scan.skip_line();
    for (std::int64_t i = 0; i < n; ++i) {
      scan.integer("a number");
      row(scan, has_marker);
      scan.skip_line();
    }
  }

  const TetgenFiles& files_;
  std::int64_t first_ = 1;
  RawMesh raw_;
};

}  // namespace

Told told_tetgen(const FileHead& head) {
  const bool is_ls_dyna = head.input.bytes.starts_with("*KEYWORD");
  return head.ends_in({".ele", ".node"}) && !is_ls_dyna ? Told::kEnding : Told::kNot;
}

RawMesh read_tetgen(const TetgenFiles& files) {
  return Tetgen(files).read();
}

RawMesh read_tetgen(const Input& input) {
  const auto load = [&](const char* ending) {
    const std::filesystem::path name = std::filesystem::path(input.name).replace_extension(ending);
    return LoadedFile(named_file(input, name.filename().string()), input.context);
  };
  const LoadedFile node = load(".node"), ele = load(".ele");
  std::optional<LoadedFile> face, edge;
  if (!sibling_file(input, ".face").empty()) face.emplace(load(".face"));
  if (!sibling_file(input, ".edge").empty()) edge.emplace(load(".edge"));
  return read_tetgen(
      TetgenFiles{node.input(), ele.input(), face ? &face->input() : nullptr, edge ? &edge->input() : nullptr});
}

}  // namespace octafront::io
