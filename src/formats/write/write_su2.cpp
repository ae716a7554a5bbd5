// SU2 native: elements and points counted from 0 (types and orders of VTK), a marker per patch of the boundary.

#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <vector>

namespace octafront::io {

void write_su2(MeshOutput& output, const MeshParts& mesh) {
  TextWriter out(output.file());
  const std::vector<std::string> names = legal_names(output, mesh, {}, std::array{Part::Origin::kPatch});
  const MixedCells cells(mesh);
  constexpr std::array<const char*, MixedCells::kKinds> kTypes{"10", "14", "13"};
  CellRoom room;
  out.line("% Mesh by octafront\nNDIME= 3\nNELEM= {}", cells.cells());
  for (std::size_t c = 0; c < cells.cells(); ++c) {
    out << kTypes[cells.kind(c)];
    for (const VertexIndex v : cells.nodes(c, room, kVtkWide)) out << ' ' << v;
    out << ' ' << std::uint64_t{c} << '\n';
  }
  out.line("NPOIN= {}", mesh.points());
  for (std::size_t v = 0; v < mesh.points(); ++v) {
    const Vec3 p = mesh.mesh().points[v];
    out << p.x << ' ' << p.y << ' ' << p.z << ' ' << std::uint64_t{v} << '\n';
  }
  const auto outside = [&](const Part& part) {
    std::vector<std::uint32_t> faces = cells.members(part);
    std::erase_if(faces, [&](std::uint32_t f) { return cells.first_face(f) >= mesh.mesh().boundary.size(); });
    return faces;
  };
  const auto is_marker = [&](const Part& part) {
    return part.origin == Part::Origin::kPatch && !outside(part).empty();
  };
  out.line("NMARK= {}", std::count_if(mesh.parts().begin(), mesh.parts().end(), is_marker));
  FaceRoom face_room;
  for (std::size_t p = 0; p < names.size(); ++p) {
    const Part& part = mesh.parts()[p];
    if (!is_marker(part)) continue;
    if (names[p] != part.name) out.line("% {} is \"{}\"", names[p], one_line(part.name));
    const std::vector<std::uint32_t> faces = outside(part);
    out.line("MARKER_TAG= {}\nMARKER_ELEMS= {}", names[p], faces.size());
    for (const std::uint32_t f : faces) {
      const auto nodes = cells.face_nodes(f, face_room);
      out << (nodes.size() == 4 ? "9" : "5");
      for (const VertexIndex v : nodes.first(nodes.size() == 4 ? 4 : 3)) out << ' ' << v;
      out << '\n';
    }
  }
}

}  // namespace octafront::io
