// MEDIT .mesh (libMeshb), text: keywords, each with a count and as many lines. What is not needed is passed over.

#include "io/raw_mesh.h"
#include "io/readers.h"
#include "io/scanner.h"
#include "io/surface_builder.h"

#include <array>

#include <fmt/core.h>

namespace octafront::io {
namespace {

bool is_keyword(std::string_view word) {
  return !word.empty() && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z'));
}

class Medit {
 public:
  explicit Medit(const Input& input) : input_(input), scan_(input, '#') {}

  TetMesh read() {
    // "MeshVersionFormatted2" is seen as well as "MeshVersionFormatted 2".
    scan_.word();
    bool ended = false;
    while (!ended && !scan_.at_end()) {
      const std::string_view word = scan_.word();
      ended = word == "End";
      if (is_keyword(word)) read_section(word);
    }
    if (!ended) scan_.fail_expected("\"End\"");
    return ordered_mesh(std::move(raw_), input_);
  }

 private:
  void read_section(std::string_view keyword) {
    if (keyword == "Dimension") {
      const char* const at = keyword.data();
      const std::int64_t dimension = scan_.integer("the dimension");
      if (dimension != 3) input_.fail_at_line(at, fmt::format("the mesh is of dimension {}, not 3", dimension));
    } else if (keyword == "Vertices") {
      read_vertices();
    } else if (keyword == "Triangles") {
      read_elements(raw_.triangles, raw_.triangle_ref);
    } else if (keyword == "Tetrahedra") {
      read_elements(raw_.tets, raw_.tet_ref);
    } else if (keyword == "Hexahedra" || keyword == "Prisms" || keyword == "Pyramids" || keyword == "Quadrilaterals" ||
               keyword == "TetrahedraP2" || keyword == "HexahedraQ2") {
      raw_.other_elements += count(keyword, 2);
    }
  }

  std::uint64_t count(std::string_view keyword, std::uint64_t bytes_each) {
    scan_.at_end();
    const char* const at = scan_.position();
    const std::int64_t n = scan_.integer(fmt::format("the number of {}", keyword));
    if (n < 0) input_.fail_at_line(at, fmt::format("{} {}; the file is damaged: export it again", n, keyword));
    check_claim(input_, at, {static_cast<std::uint64_t>(n), bytes_each, keyword}, scan_.bytes_left());
    return static_cast<std::uint64_t>(n);
  }

  void read_vertices() {
    if (!raw_.points.empty()) scan_.fail("a second section Vertices; the file is damaged");
    const std::uint64_t n = count("Vertices", 8);
    raw_.points.reserve(n);
    for (std::uint64_t i = 0; i < n; ++i) {
      const double x = scan_.number("a coordinate"), y = scan_.number("a coordinate"), z = scan_.number("a coordinate");
      raw_.points.push_back({x, y, z});
      scan_.number("the reference of a vertex");
    }
  }

  template <std::size_t N>
  void read_elements(std::vector<std::array<VertexIndex, N>>& elements, std::vector<std::int64_t>& refs) {
    const std::uint64_t n = count(N == 3 ? "Triangles" : "Tetrahedra", 2 * (N + 1));
    elements.reserve(elements.size() + n);
    refs.reserve(refs.size() + n);
    for (std::uint64_t i = 0; i < n; ++i) {
      std::array<VertexIndex, N> corners;
      for (VertexIndex& v : corners) v = vertex();
      elements.push_back(corners);
      refs.push_back(scan_.integer("a reference"));
    }
  }

  VertexIndex vertex() {
    const std::int64_t v = scan_.integer("the number of a vertex");
    if (v < 1 || static_cast<std::uint64_t>(v) > raw_.points.size())
      scan_.fail(
          fmt::format("the corner {} of an element is no vertex (1 to {} are); the file is damaged: export it again", v,
                      raw_.points.size()));
    return static_cast<VertexIndex>(v - 1);
  }

  const Input& input_;
  Scanner scan_;
  RawMesh raw_;
};

}  // namespace

TetMesh read_medit(const Input& input) {
  return Medit(input).read();
}

}  // namespace octafront::io
