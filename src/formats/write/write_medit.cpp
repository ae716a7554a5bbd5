// MEDIT, as text or binary (libMeshb, version 3: 64-bit positions). References count from 1: 0 means "none" to programs
// that read them.

#include <octafront/error.h>

#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <array>
#include <cstring>
#include <limits>

namespace octafront::io {
namespace {

/// A section of elements: its keyword, linear and of second order, as text and number.
struct WrittenSection {
  const char *name, *name2;
  std::int32_t code, code2;
};
constexpr WrittenSection kEdges{"Edges", "EdgesP2", 5, 25}, kTriangles{"Triangles", "TrianglesP2", 6, 24},
    kQuadrilaterals{"Quadrilaterals", nullptr, 7, 0};
constexpr std::array<WrittenSection, MixedCells::kKinds> kSolids{WrittenSection{"Tetrahedra", "TetrahedraP2", 8, 30},
                                                                 WrittenSection{"Pyramids", nullptr, 49, 0},
                                                                 WrittenSection{"Prisms", nullptr, 9, 0}};

/// Calls write(section, count, nodes each, node_at(i, k), reference_at(i)) for each section.
template <class Write>
void for_each_section(const MeshParts& mesh, const Write& write) {
  const MixedCells cells(mesh);
  if (mesh.edges() > 0)
    write(
        kEdges, mesh.edges(), mesh.nodes_per_edge(), [&](std::size_t i, std::size_t k) { return mesh.edge_node(i, k); },
        [&](std::size_t i) { return mesh.curve_of(i) + 1; });
  const auto write_faces = [&](const WrittenSection& section, std::size_t begin, std::size_t end, std::size_t nodes) {
    if (begin == end) return;
    write(
        section, end - begin, nodes, [&](std::size_t i, std::size_t k) { return cells.face_node(begin + i, k); },
        [&](std::size_t i) { return mesh.patch_of(cells.first_face(begin + i)) + 1; });
  };
  write_faces(kTriangles, 0, cells.triangles(), mesh.nodes_per_face());
  write_faces(kQuadrilaterals, cells.triangles(), cells.faces(), cells.nodes_per_quad());
  for (const MixedCells::Kind kind : MixedCells::kAllKinds) {
    const std::size_t begin = cells.begin(kind), end = cells.end(kind);
    if (begin == end) continue;
    write(
        kSolids[kind], end - begin, cells.nodes_per(kind),
        [&](std::size_t i, std::size_t k) { return cells.node(begin + i, k); },
        [&](std::size_t i) { return mesh.tag_of_region(mesh.region_of(cells.first_tet(begin + i))); });
  }
}

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
  out << "\nEnd\n";
}

void write_medit_binary(MeshOutput& output, const MeshParts& mesh) {
  if (mesh.points() > std::numeric_limits<std::int32_t>::max())
    throw OutputError(output.target().string() +
                      ": binary MEDIT has 32-bit numbers, too few for this mesh; write .vtu");
  AtomicFile& out = output.file();
  const auto put = [&](auto value) { out.write(&value, sizeof value); };
  constexpr std::int32_t kVersion = 3, kDimension = 3, kVertices = 4, kEnd = 54;
  constexpr std::size_t kHead = 16;  // keyword, where the next one is, count
  const auto head = [&](std::int32_t code, std::size_t count, std::size_t bytes_each) {
    const std::uint64_t next = out.position() + kHead + count * bytes_each;
    put(code);
    put(next);
    put(static_cast<std::int32_t>(count));
  };
  put(std::int32_t{1});
  put(kVersion);
  head(kDimension, 3, 0);  // its value stands where others have the count
  head(kVertices, mesh.points(), 28);
  for (std::size_t v = 0; v < mesh.points(); ++v) {
    std::array<char, 28> record{};
    const Vec3 p = mesh.mesh().points[v];
    const std::array<double, 3> xyz{p.x, p.y, p.z};
    std::memcpy(record.data(), xyz.data(), sizeof xyz);
    out.write(record.data(), record.size());
  }
  for_each_section(mesh, [&](const WrittenSection& section, std::size_t count, std::size_t nodes, const auto& node_at,
                             const auto& reference_at) {
    head(mesh.second_order() ? section.code2 : section.code, count, 4 * (nodes + 1));
    std::array<std::uint32_t, 11> record;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < nodes; ++k) record[k] = node_at(i, k) + 1;
      record[nodes] = reference_at(i);
      out.write(record.data(), 4 * (nodes + 1));
    }
  });
  put(kEnd);
  put(std::uint64_t{0});
}

}  // namespace octafront::io
