// TetGen: NAME.node, NAME.ele, and NAME.face and NAME.edge, whose markers are the numbers of regions, patches and
// curves counted from 1. All numbers count from 1. Mid-side nodes as `tetgen -o2` writes them.

#include "formats/containers/text_writer.h"
#include "formats/write/writers.h"

#include <array>

namespace octafront::io {
namespace {

/// Places of VTK's nodes in TetGen's list: mid-side nodes are those of 34 14 12 23 24 13.
constexpr std::array<std::uint8_t, 10> kTetgenTet{0, 1, 2, 3, 9, 7, 4, 5, 8, 6};

}  // namespace

void write_tetgen(MeshOutput& output, const MeshParts& mesh) {
  {
    TextWriter out(output.sibling(".node"));
    out.line("{} 3 0 0", mesh.points());
    for (std::size_t v = 0; v < mesh.points(); ++v) {
      const Vec3 p = mesh.mesh().points[v];
      out << std::uint64_t{v} + 1 << ' ' << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
  }
  {
    TextWriter out(output.sibling(".ele"));
    out.line("{} {} 1", mesh.tets(), mesh.nodes_per_tet());
    for (std::size_t t = 0; t < mesh.tets(); ++t) {
      out << std::uint64_t{t} + 1;
      for (std::size_t k = 0; k < mesh.nodes_per_tet(); ++k) out << ' ' << mesh.tet_node(t, kTetgenTet[k]) + 1;
      out << ' ' << mesh.number_of(Part::Origin::kRegion, mesh.region_of(t)) << '\n';
    }
  }
  {
    TextWriter out(output.sibling(".face"));
    out.line("{} 1", mesh.faces());
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
      const auto& [a, b, c] = mesh.face(f);
      out << std::uint64_t{f} + 1 << ' ' << a + 1 << ' ' << b + 1 << ' ' << c + 1 << ' '
          << mesh.number_of(Part::Origin::kPatch, mesh.patch_of(f)) << '\n';
    }
  }
  // Without edges too: an older file of this name would be taken for ours.
  TextWriter out(output.sibling(".edge"));
  out.line("{} 1", mesh.edges());
  for (std::size_t e = 0; e < mesh.edges(); ++e)
    out << std::uint64_t{e} + 1 << ' ' << mesh.edge_node(e, 0) + 1 << ' ' << mesh.edge_node(e, 1) + 1 << ' '
        << mesh.number_of(Part::Origin::kCurve, mesh.curve_of(e)) << '\n';
}

}  // namespace octafront::io
