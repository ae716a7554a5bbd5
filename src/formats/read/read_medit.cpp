// MEDIT (libMeshb): .mesh is text, keywords, each with a count and as many lines; .meshb is binary of versions 1 to 4,
// of either byte order, each section with the place of the next one. What is required, corners and ridges are sets
// (kMeditSets). What is left out is named.

#include <octafront/named_groups.h>

#include "formats/containers/scanner.h"
#include "formats/parts/medit_sections.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using namespace std::string_view_literals;

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
                               ReadSection{"Hexahedra", 10, 3, 8},
                               ReadSection{"QuadrilateralsQ2", 27, 2, 9},
                               ReadSection{"HexahedraQ2", 33, -1, 27},
                               ReadSection{"Pyramids", 49, 3, 5}};

/// A list of entities by their numbers in a section of elements, or of vertices: a set.
struct ListSection {
  std::string_view name;
  int code;
  std::string_view set;  ///< of kMeditSets
  std::string_view of;   ///< the section that numbers count
};
constexpr std::array kLists{ListSection{"Corners", 13, "Corners", "Vertices"},
                            ListSection{"Ridges", 14, "Ridges", "Edges"},
                            ListSection{"RequiredVertices", 15, "RequiredVertices", "Vertices"},
                            ListSection{"RequiredEdges", 16, "RequiredEdges", "Edges"},
                            ListSection{"RequiredTriangles", 17, "RequiredTriangles", "Triangles"},
                            ListSection{"RequiredQuadrilaterals", 18, "RequiredTriangles", "Quadrilaterals"},
                            ListSection{"RequiredTetrahedra", 12, "RequiredTetrahedra", "Tetrahedra"}};

/// The names of other sections by their codes, for notes.
std::string name_of_code(std::int32_t code) {
  constexpr std::array kNames{std::pair{19, "TangentAtEdgeVertices"}, std::pair{20, "NormalAtVertices"},
                              std::pair{21, "NormalAtTriangleVertices"}, std::pair{59, "Tangents"},
                              std::pair{60, "Normals"}};
  for (const auto& [known, name] : kNames)
    if (known == code) return name;
  return fmt::format("number {}", code);
}

/// What both kinds of file share; `Source` yields numbers and knows how to complain.
template <class Source>
class SectionReader {
 public:
  SectionReader(Source& source, RawMesh& raw) : source_(source), raw_(raw) {}

  void read(const ReadSection& section, std::uint64_t count) {
    const std::uint32_t first = items(section.dimension);
    counts_[section.name] = {count, first};
    if (section.dimension < 0) {
      raw_.other_elements += count;
    } else if (section.dimension == 0) {
      read_vertices(count);
    } else {
      read_elements(section, count);
    }
  }

  void read(const ListSection& section, std::uint64_t count) {
    std::vector<std::int64_t>& all = lists_[section.name];
    for (std::uint64_t i = 0; i < count; ++i) all.push_back(source_.integer("the number of an entity"));
  }

  void leave_out(std::string name) {
    if (std::find(left_out_.begin(), left_out_.end(), name) == left_out_.end()) left_out_.push_back(std::move(name));
  }

  /// Sections may stand in any order: what refers to others is known at the end.
  void finish() {
    for (const ListSection& list : kLists) add_list(list);
    if (referenced_ > 0)
      raw_.notes.push_back(
          fmt::format("{} vertices have reference numbers ({} to {}): only elements have numbers here, "
                      "and those of vertices are left out",
                      referenced_, least_, largest_));
    if (left_out_.empty()) return;
    constexpr std::size_t kNamed = 6;
    std::string names;
    for (std::size_t i = 0; i < std::min(kNamed, left_out_.size()); ++i)
      names += (names.empty() ? "" : ", ") + left_out_[i];
    raw_.notes.push_back(fmt::format("sections left out: {}{}", names, left_out_.size() > kNamed ? ", ..." : ""));
  }

 private:
  /// How many there are of the dimension so far.
  std::uint32_t items(int dimension) const {
    const std::size_t n = dimension == 3   ? raw_.tets.size()
                          : dimension == 2 ? raw_.triangles.size()
                          : dimension == 1 ? raw_.edges.size()
                                           : 0;
    return static_cast<std::uint32_t>(n);
  }

  void add_list(const ListSection& list) {
    const std::vector<std::int64_t>& numbers = lists_[list.name];
    if (numbers.empty()) return;
    const auto kind = std::find_if(kMeditSets.begin(), kMeditSets.end(), [&](const MeditSet& set) {
                        return set.name == list.set;
                      })->kind;
    const auto [count, first] = counts_[list.of];
    const std::uint32_t each = list.of == "Quadrilaterals" ? 2 : 1;
    RawMesh::Group group{std::string(list.set), kind, {}};
    std::size_t unknown = 0;
    for (const std::int64_t n : numbers) {
      const bool is_known = n >= 1 && static_cast<std::uint64_t>(n) <= count;
      unknown += !is_known;
      for (std::uint32_t k = 0; is_known && k < each; ++k)
        group.members.push_back(first + each * static_cast<std::uint32_t>(n - 1) + k);
    }
    if (unknown > 0)
      raw_.notes.push_back(
          fmt::format("{} of {} name none of the {} {} of the file: left out", unknown, list.name, count, list.of));
    const auto known = std::find_if(raw_.groups.begin(), raw_.groups.end(),
                                    [&](const RawMesh::Group& g) { return g.name == group.name && g.kind == kind; });
    if (known == raw_.groups.end()) {
      raw_.groups.push_back(std::move(group));
    } else {
      known->members.insert(known->members.end(), group.members.begin(), group.members.end());
    }
  }

  void read_vertices(std::uint64_t count) {
    if (!raw_.points.empty()) source_.fail("a second section Vertices; the file is damaged");
    raw_.points.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double x = source_.real(), y = source_.real(), z = source_.real();
      raw_.points.push_back({x, y, z});
      const std::int64_t ref = source_.vertex_reference();
      if (ref == 0) continue;
      least_ = referenced_ == 0 ? ref : std::min(least_, ref);
      largest_ = referenced_ == 0 ? ref : std::max(largest_, ref);
      ++referenced_;
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
    if (nodes.size() == 8) return static_cast<void>(raw_.add_hexahedron(nodes, ref));
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
  std::map<std::string_view, std::pair<std::uint64_t, std::uint32_t>> counts_;  ///< of sections, and their first items
  std::map<std::string_view, std::vector<std::int64_t>> lists_;
  std::vector<std::string> left_out_;
  std::uint64_t referenced_ = 0;  ///< vertices with references
  std::int64_t least_ = 0, largest_ = 0;
};

template <class Section>
const Section* section_named(std::span<const Section> all, std::string_view name) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const Section& s) { return s.name == name; });
  return at == all.end() ? nullptr : &*at;
}
template <class Section>
const Section* section_of_code(std::span<const Section> all, int code) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const Section& s) { return s.code == code; });
  return at == all.end() ? nullptr : &*at;
}

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
      if (!is_keyword(word) || word == "End" || word == "Dimension") continue;
      if (const auto* section = section_named<ReadSection>(kSections, word)) {
        sections.read(*section, count(section->name, section->nodes + 1));
      } else if (const auto* list = section_named<ListSection>(kLists, word)) {
        sections.read(*list, count(list->name, 1));
      } else {
        sections.leave_out(std::string(word));
      }
    }
    if (!ended) require_whole(raw);
    sections.finish();
    return raw;
  }

  double real() { return scan_.number("a coordinate"); }
  std::int64_t vertex_reference() { return static_cast<std::int64_t>(scan_.number("the reference of a vertex")); }
  std::int64_t integer(std::string_view what) { return scan_.integer(what); }
  [[noreturn]] void fail(std::string_view message) const { scan_.fail(message); }

 private:
  /// Some programs write no End. A file that ends behind a line of elements is taken for one of theirs.
  void require_whole(RawMesh& raw) {
    const bool has_elements = !raw.tets.empty() || !raw.triangles.empty();
    if (!has_elements || !input_.bytes.ends_with('\n')) scan_.fail_expected("\"End\"");
    raw.notes.emplace_back("the file has no End behind its last section: if more was there, it is truncated");
  }

  void check_dimension(const char* at) {
    const std::int64_t dimension = scan_.integer("the dimension");
    if (dimension != 3) input_.fail_at_line(at, fmt::format("the mesh is of dimension {}, not 3", dimension));
  }

  /// `words`: of each item.
  std::uint64_t count(std::string_view name, std::size_t words) {
    scan_.at_end();
    const char* const at = scan_.position();
    const std::int64_t n = scan_.integer(fmt::format("the number of {}", name));
    if (n < 0) input_.fail_at_line(at, fmt::format("{} {}; the file is damaged: export it again", n, name));
    check_claim(input_, at, {static_cast<std::uint64_t>(n), 2 * words, name}, scan_.bytes_left() + 1);
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
      if (const auto* section = section_of_code<ReadSection>(kSections, code)) {
        const std::uint64_t word = file_.version() < 4 ? 4 : 8, real = file_.version() == 1 ? 4 : 8;
        const bool is_vertices = section->dimension == 0;
        sections.read(*section, count(section->name, is_vertices ? 3 * real + word : (section->nodes + 1) * word));
      } else if (const auto* list = section_of_code<ListSection>(kLists, code)) {
        sections.read(*list, count(list->name, file_.version() < 4 ? 4 : 8));
      } else {
        sections.leave_out(name_of_code(code));
      }
      return true;
    });
    sections.finish();
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
  std::int64_t vertex_reference() { return integer({}); }
  [[noreturn]] void fail(std::string_view message) const { file_.fail(message); }

 private:
  /// `bytes`: of each item.
  std::uint64_t count(std::string_view name, std::uint64_t bytes) {
    const char* const at = file_.position();
    const std::int64_t n = integer({});
    if (n < 0) fail(fmt::format("{} {}; the file is damaged: export it again", n, name));
    check_claim(input_, at, {static_cast<std::uint64_t>(n), bytes, name}, file_.bytes_left());
    return static_cast<std::uint64_t>(n);
  }

  const Input& input_;
  MeditSections file_;
};

bool is_binary_medit(std::string_view bytes) {
  // In either byte order: 1, and the version.
  constexpr std::string_view kOne("\x01\0\0\0"sv), kSwapped("\0\0\0\x01\0\0\0"sv);
  if (bytes.size() <= 8) return false;
  return (bytes.starts_with(kOne) && bytes[4] >= 1 && bytes[4] <= 4) ||
         (bytes.starts_with(kSwapped) && bytes[7] >= 1 && bytes[7] <= 4);
}

}  // namespace

Told told_medit(const FileHead& head) {
  return head.first.starts_with("MeshVersionFormatted") ? Told::kMagic : Told::kNot;
}

Told told_medit_binary(const FileHead& head) {
  return is_binary_medit(head.input.bytes) ? Told::kMagic : Told::kNot;
}

RawMesh read_medit(const Input& input) {
  return MeditText(input).read();
}

RawMesh read_medit_binary(const Input& input) {
  return MeditBinary(input).read();
}

}  // namespace octafront::io
