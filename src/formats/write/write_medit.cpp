// MEDIT, as text or binary (libMeshb, version 2, or 3 where positions need 64 bits). Without numbers of their own
// references count from 1: 0 means "none" to programs that read them. Sets of kMeditSets are sections.

#include <octafront/error.h>
#include <octafront/named_groups.h>

#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace octafront::io {
namespace {

/// A section of elements: its keyword, linear and of second order, as text and number.
struct WrittenSection {
  const char *name, *name2;
  std::int32_t code, code2;
};
constexpr WrittenSection kEdges{"Edges", "EdgesP2", 5, 25}, kTriangles{"Triangles", "TrianglesP2", 6, 24},
    kQuadrilaterals{"Quadrilaterals", nullptr, 7, 0};
constexpr std::array<WrittenSection, MixedCells::kKinds> kMeditSolids{
    WrittenSection{"Tetrahedra", "TetrahedraP2", 8, 30}, WrittenSection{"Pyramids", nullptr, 49, 0},
    WrittenSection{"Prisms", nullptr, 9, 0}};

/// Calls write(section, count, nodes each, node_at(i, k), reference_at(i)) for each section.
template <class Write>
void for_each_section(const MeshParts& mesh, const Write& write) {
  const MixedCells cells(mesh);
  if (mesh.edges() > 0)
    write(
        kEdges, mesh.edges(), mesh.nodes_per_edge(), [&](std::size_t i, std::size_t k) { return mesh.edge_node(i, k); },
        [&](std::size_t i) { return mesh.number_of(Part::Origin::kCurve, mesh.curve_of(i)); });
  const auto write_faces = [&](const WrittenSection& section, std::size_t begin, std::size_t end, std::size_t nodes) {
    if (begin == end) return;
    write(
        section, end - begin, nodes, [&](std::size_t i, std::size_t k) { return cells.face_node(begin + i, k); },
        [&](std::size_t i) {
          return mesh.number_of(Part::Origin::kPatch, mesh.patch_of(cells.first_face(begin + i)));
        });
  };
  write_faces(kTriangles, 0, cells.triangles(), mesh.nodes_per_face());
  write_faces(kQuadrilaterals, cells.triangles(), cells.faces(), cells.nodes_per_quad());
  for (const MixedCells::Kind kind : MixedCells::kAllKinds) {
    const std::size_t begin = cells.begin(kind), end = cells.end(kind);
    if (begin == end) continue;
    write(
        kMeditSolids[kind], end - begin, cells.nodes_per(kind),
        [&](std::size_t i, std::size_t k) { return cells.node(begin + i, k); },
        [&](std::size_t i) {
          return mesh.number_of(Part::Origin::kRegion, mesh.region_of(cells.first_tet(begin + i)));
        });
  }
}

/// A section that lists entities by number.
struct WrittenList {
  const char* name;
  std::int32_t code;
  std::vector<std::uint64_t> numbers;
};

/// What the sets of the mesh are in this format: faces as triangles, or as quadrilaterals where they are halves of one.
/// A file has one list of each kind.
std::vector<WrittenList> lists_of(const MeshParts& mesh) {
  const MixedCells cells(mesh);
  std::vector<WrittenList> lists{
      {"Corners", 13, {}},           {"RequiredVertices", 15, {}},  {"Ridges", 14, {}},
      {"RequiredEdges", 16, {}},     {"RequiredTriangles", 17, {}}, {"RequiredQuadrilaterals", 18, {}},
      {"RequiredTetrahedra", 12, {}}};
  for (const Part& part : mesh.parts(Part::Origin::kSet)) {
    if (medit_set(mesh.mesh().sets[part.number]) == nullptr) continue;
    const auto list =
        std::find_if(lists.begin(), lists.end(), [&](const WrittenList& l) { return l.name == part.name; });
    for (const std::uint32_t m : cells.members(part)) {
      if (part.kind == NamedSet::Kind::kFaces && m >= cells.triangles())
        lists[5].numbers.push_back(m - cells.triangles() + 1);
      else if (part.kind != NamedSet::Kind::kElements || m < cells.end(MixedCells::kTet))
        list->numbers.push_back(std::uint64_t{m} + 1);
    }
  }
  std::erase_if(lists, [](const WrittenList& list) { return list.numbers.empty(); });
  return lists;
}

/// The binary file; its version is that of the positions.
class BinaryWriter {
 public:
  BinaryWriter(AtomicFile& out, const MeshParts& mesh) : out_(out), mesh_(mesh), lists_(lists_of(mesh)) {
    // Version 2 has signed positions.
    is_long_ = size() > std::numeric_limits<std::int32_t>::max();
  }

  void write() {
    constexpr std::int32_t kDimension = 3, kVertices = 4, kEnd = 54;
    put(std::int32_t{1});
    put(std::int32_t{is_long_ ? 3 : 2});
    head(kDimension, 3, 0);  // its value stands where others have the count
    head(kVertices, mesh_.points(), kVertexBytes);
    for (std::size_t v = 0; v < mesh_.points(); ++v) {
      std::array<char, kVertexBytes> record{};
      const Vec3 p = mesh_.mesh().points[v];
      const std::array<double, 3> xyz{p.x, p.y, p.z};
      std::memcpy(record.data(), xyz.data(), sizeof xyz);
      out_.write(record.data(), record.size());
    }
    for_each_section(mesh_, [&](const WrittenSection& section, std::size_t count, std::size_t nodes,
                                const auto& node_at, const auto& reference_at) {
      head(mesh_.second_order() ? section.code2 : section.code, count, 4 * (nodes + 1));
      std::array<std::uint32_t, 11> record;
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < nodes; ++k) record[k] = node_at(i, k) + 1;
        record[nodes] = static_cast<std::uint32_t>(static_cast<std::int32_t>(reference_at(i)));
        out_.write(record.data(), 4 * (nodes + 1));
      }
    });
    for (const WrittenList& list : lists_) {
      head(list.code, list.numbers.size(), 4);
      for (const std::uint64_t n : list.numbers) put(static_cast<std::int32_t>(n));
    }
    put(kEnd);
    put_position(0);
  }

 private:
  static constexpr std::size_t kVertexBytes = 28;

  /// Of the file, with the longer positions.
  std::uint64_t size() const {
    constexpr std::uint64_t kLongHead = 16;
    std::uint64_t bytes = 4 * kLongHead + kVertexBytes * mesh_.points();
    for_each_section(mesh_, [&](const WrittenSection&, std::size_t count, std::size_t nodes, const auto&, const auto&) {
      bytes += kLongHead + count * 4 * (nodes + 1);
    });
    for (const WrittenList& list : lists_) bytes += kLongHead + 4 * list.numbers.size();
    return bytes;
  }

  template <class T>
  void put(T value) {
    out_.write(&value, sizeof value);
  }
  void put_position(std::uint64_t position) { is_long_ ? put(position) : put(static_cast<std::uint32_t>(position)); }
  /// Keyword, where the next one is, count.
  void head(std::int32_t code, std::size_t count, std::size_t bytes_each) {
    const std::uint64_t next = out_.position() + (is_long_ ? 16 : 12) + count * bytes_each;
    put(code);
    put_position(next);
    put(static_cast<std::int32_t>(count));
  }

  AtomicFile& out_;
  const MeshParts& mesh_;
  std::vector<WrittenList> lists_;
  bool is_long_ = false;
};

}  // namespace

void write_medit(MeshOutput& output, const MeshParts& mesh) {
  TextWriter out(output.file());
  out << "MeshVersionFormatted 2\n\nDimension 3\n\nVertices\n" << std::uint64_t{mesh.points()} << '\n';
  for (std::size_t v = 0; v < mesh.points(); ++v) {
    const Vec3 p = mesh.mesh().points[v];
    out << p.x << ' ' << p.y << ' ' << p.z << " 0\n";
  }
  for_each_section(mesh, [&](const WrittenSection& section, std::size_t count, std::size_t nodes, const auto& node_at,
                             const auto& reference_at) {
    out << '\n' << (mesh.second_order() ? section.name2 : section.name) << '\n' << std::uint64_t{count} << '\n';
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < nodes; ++k) out << node_at(i, k) + 1 << ' ';
      out << reference_at(i) << '\n';
    }
  });
  for (const WrittenList& list : lists_of(mesh)) {
    out << '\n' << list.name << '\n' << std::uint64_t{list.numbers.size()} << '\n';
    for (const std::uint64_t n : list.numbers) out << n << '\n';
  }
  out << "\nEnd\n";
}

void write_medit_binary(MeshOutput& output, const MeshParts& mesh) {
  if (mesh.points() > std::numeric_limits<std::int32_t>::max())
    throw OutputError(output.target().string() +
                      ": binary MEDIT has 32-bit numbers, too few for this mesh; write .vtu");
  BinaryWriter(output.file(), mesh).write();
}

}  // namespace octafront::io
