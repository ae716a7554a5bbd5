// MEDIT (libMeshb): .mesh is text, keywords, each with a count and as many lines; .meshb is binary of versions 1 to 4,
// little-endian, each section with the place of the next one. What is not needed is passed over.

#include "formats/containers/scanner.h"
#include "formats/parts/medit_sections.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

namespace octafront::io {
namespace {

bool is_keyword(std::string_view word) {
  return !word.empty() && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z'));
}

struct ReadSection {
  std::string_view name;
  int code;
  int dimension;      ///< 0 vertices, 1 edges, 2 triangles and quadrilaterals, 3 tetrahedra, -1: others
  std::size_t nodes;  ///< of an element
};
constexpr std::array kSections{ReadSection{"Vertices", 4, 0, 0},
                               ReadSection{"Edges", 5, 1, 2},
                               ReadSection{"EdgesP2", 25, 1, 3},
                               ReadSection{"Triangles", 6, 2, 3},
                               ReadSection{"TrianglesP2", 24, 2, 6},
                               ReadSection{"Tetrahedra", 8, 3, 4},
                               ReadSection{"TetrahedraP2", 30, 3, 10},
                               ReadSection{"Quadrilaterals", 7, 2, 4},
                               ReadSection{"Prisms", 9, 3, 6},
                               ReadSection{"Hexahedra", 10, -1, 8},
                               ReadSection{"QuadrilateralsQ2", 27, 2, 9},
                               ReadSection{"HexahedraQ2", 33, -1, 27},
                               ReadSection{"Pyramids", 49, 3, 5}};

/// What both kinds of file share; `Source` yields numbers and knows how to complain.
template <class Source>
class SectionReader {
 public:
  SectionReader(Source& source, RawMesh& raw) : source_(source), raw_(raw) {}

  void read(const ReadSection& section, std::uint64_t count) {
    if (section.dimension < 0) {
      raw_.other_elements += count;
    } else if (section.dimension == 0) {
      read_vertices(count);
    } else {
      read_elements(section, count);
    }
  }

 private:
  void read_vertices(std::uint64_t count) {
    if (!raw_.points.empty()) source_.fail("a second section Vertices; the file is damaged");
    raw_.points.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double x = source_.real(), y = source_.real(), z = source_.real();
      raw_.points.push_back({x, y, z});
      source_.vertex_reference();
    }
  }

  void read_elements(const ReadSection& section, std::uint64_t count) {
    std::array<VertexIndex, 10> nodes;
    for (std::uint64_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < section.nodes; ++k) nodes[k] = vertex();
      const std::int64_t ref = source_.integer("a reference");
      if (section.dimension == 3) {
        add_solid(std::span(nodes).first(section.nodes), ref);
      } else if (section.dimension == 2) {
        raw_.add_face(std::span(nodes).first(section.nodes), ref);
      } else {
        raw_.edges.push_back({nodes[0], nodes[1]});
        raw_.edge_ref.push_back(ref);
      }
    }
  }

  void add_solid(std::span<const VertexIndex> nodes, std::int64_t ref) {
    const bool is_tet = nodes.size() == 4 || nodes.size() == 10;
    is_tet ? raw_.add_tet(nodes, ref) : static_cast<void>(raw_.add_wide_cell(nodes, ref));
  }

  VertexIndex vertex() {
    const std::int64_t v = source_.integer("the number of a vertex");
    if (v < 1 || static_cast<std::uint64_t>(v) > raw_.points.size())
      source_.fail(
          fmt::format("the corner {} of an element is no vertex (1 to {} are); the file is damaged: export it again", v,
                      raw_.points.size()));
    return static_cast<VertexIndex>(v - 1);
  }

  Source& source_;
  RawMesh& raw_;
};

class MeditText {
 public:
  explicit MeditText(const Input& input) : input_(input), scan_(input, '#') {}

  RawMesh read() {
    RawMesh raw;
    raw.format = "MEDIT";
    SectionReader<MeditText> sections(*this, raw);
    // "MeshVersionFormatted2" is seen as well as "MeshVersionFormatted 2".
    scan_.word();
    bool ended = false;
    while (!ended && !scan_.at_end()) {
      const std::string_view word = scan_.word();
      ended = word == "End";
      if (word == "Dimension") check_dimension(word.data());
      const auto section =
          std::find_if(kSections.begin(), kSections.end(), [&](const ReadSection& s) { return s.name == word; });
      if (is_keyword(word) && section != kSections.end()) sections.read(*section, count(*section));
    }
    if (!ended) scan_.fail_expected("\"End\"");
    return raw;
  }

  double real() { return scan_.number("a coordinate"); }
  void vertex_reference() { scan_.number("the reference of a vertex"); }
  std::int64_t integer(std::string_view what) { return scan_.integer(what); }
  [[noreturn]] void fail(std::string_view message) const { scan_.fail(message); }

 private:
  void check_dimension(const char* at) {
    const std::int64_t dimension = scan_.integer("the dimension");
    if (dimension != 3) input_.fail_at_line(at, fmt::format("the mesh is of dimension {}, not 3", dimension));
  }

  std::uint64_t count(const ReadSection& section) {
    scan_.at_end();
    const char* const at = scan_.position();
    const std::int64_t n = scan_.integer(fmt::format("the number of {}", section.name));
    if (n < 0) input_.fail_at_line(at, fmt::format("{} {}; the file is damaged: export it again", n, section.name));
    check_claim(input_, at, {static_cast<std::uint64_t>(n), 2 * (section.nodes + 1), section.name}, scan_.bytes_left());
    return static_cast<std::uint64_t>(n);
  }

  const Input& input_;
  Scanner scan_;
};

class MeditBinary {
 public:
  explicit MeditBinary(const Input& input) : input_(input), file_(input) {}

  RawMesh read() {
    RawMesh raw;
    raw.format = "MEDIT binary";
    SectionReader<MeditBinary> sections(*this, raw);
    file_.for_each([&](std::int32_t code) {
      const auto section =
          std::find_if(kSections.begin(), kSections.end(), [&](const ReadSection& s) { return s.code == code; });
      if (section != kSections.end()) sections.read(*section, count(*section));
      return true;
    });
    return raw;
  }

  double real() {
    const double value = file_.real();
    if (!std::isfinite(value))
      fail(fmt::format("expected a coordinate, found {}, which is not a finite number", value));
    return value;
  }
  std::int64_t integer(std::string_view) {
    return file_.version() < 4 ? file_.get<std::int32_t>() : file_.get<std::int64_t>();
  }
  void vertex_reference() { integer({}); }
  [[noreturn]] void fail(std::string_view message) const { file_.fail(message); }

 private:
  std::uint64_t count(const ReadSection& section) {
    const char* const at = file_.position();
    const std::int64_t n = integer({});
    const int version = file_.version();
    const std::uint64_t word = version < 4 ? 4 : 8;
    const std::uint64_t each = section.dimension == 0 ? 3 * (version == 1 ? 4 : 8) + word : (section.nodes + 1) * word;
    if (n < 0) fail(fmt::format("{} {}; the file is damaged: export it again", n, section.name));
    check_claim(input_, at, {static_cast<std::uint64_t>(n), each, section.name}, file_.bytes_left());
    return static_cast<std::uint64_t>(n);
  }

  const Input& input_;
  MeditSections file_;
};

}  // namespace

RawMesh read_medit(const Input& input) {
  return MeditText(input).read();
}

RawMesh read_medit_binary(const Input& input) {
  return MeditBinary(input).read();
}

}  // namespace octafront::io
