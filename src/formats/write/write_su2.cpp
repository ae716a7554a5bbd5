// SU2 native: elements and points counted from 0 (types of VTK), a marker per patch of the boundary.

#include "formats/containers/text_writer.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>

namespace octafront::io {

void write_su2(MeshOutput& output, const MeshParts& mesh) {
  TextWriter out(output.file());
  const std::vector<std::string> names = legal_names(output, mesh, {}, std::array{Part::Origin::kPatch});
  out.line("% Mesh by octafront\nNDIME= 3\nNELEM= {}", mesh.tets());
  for (std::size_t t = 0; t < mesh.tets(); ++t) {
    out << "10";
    for (std::size_t k = 0; k < 4; ++k) out << ' ' << mesh.tet_node(t, k);
    out << ' ' << std::uint64_t{t} << '\n';
  }
  out.line("NPOIN= {}", mesh.points());
  for (std::size_t v = 0; v < mesh.points(); ++v) {
    const Vec3 p = mesh.mesh().points[v];
    out << p.x << ' ' << p.y << ' ' << p.z << ' ' << std::uint64_t{v} << '\n';
  }
  const auto outside = [&](const Part& part) {
    // Members ascend: faces of the boundary come first.
    return static_cast<std::size_t>(
        std::lower_bound(part.members.begin(), part.members.end(), mesh.mesh().boundary.size()) - part.members.begin());
  };
  const auto is_marker = [&](const Part& part) { return part.origin == Part::Origin::kPatch && outside(part) > 0; };
  out.line("NMARK= {}", std::count_if(mesh.parts().begin(), mesh.parts().end(), is_marker));
  for (std::size_t p = 0; p < names.size(); ++p) {
    const Part& part = mesh.parts()[p];
    if (!is_marker(part)) continue;
    if (names[p] != part.name) out.line("% {} is \"{}\"", names[p], one_line(part.name));
    out.line("MARKER_TAG= {}\nMARKER_ELEMS= {}", names[p], outside(part));
    for (const std::uint32_t f : part.members.first(outside(part))) {
      const auto& [a, b, c] = mesh.face(f);
      out << "5 " << a << ' ' << b << ' ' << c << '\n';
    }
  }
}

}  // namespace octafront::io
