// Netgen .vol: surface elements, volume elements, edge segments, points, names. Netgen's tetrahedra are negative in our
// terms: their second and third corner are exchanged. Mid-side nodes: of tetrahedra 12 13 14 23 24 34, of triangles
// opposite to each corner.

#include "formats/containers/text_writer.h"
#include "formats/write/writers.h"

#include <array>

namespace octafront::io {
namespace {

/// Places of VTK's nodes in Netgen's list.
constexpr std::array<std::uint8_t, 10> kNetgenTet{0, 2, 1, 3, 6, 4, 7, 5, 9, 8};
constexpr std::array<std::uint8_t, 6> kNetgenTriangle{0, 1, 2, 4, 5, 3};

/// Names of the parts of one origin by number, counted from 1; those without one get what they are called elsewhere.
void write_names_of_parts(TextWriter& out, std::string_view section, std::span<const Part> parts) {
  if (parts.empty()) return;
  out.line("\n{}\n{}", section, parts.size());
  for (const Part& part : parts) out.line("{} {}", part.number + 1, part.name);
}

}  // namespace

void write_netgen(MeshOutput& output, const MeshParts& mesh) {
  TextWriter out(output.file());
  // Regions on the side that a face looks to, and on the other one; 0: outside.
  const auto behind = [&](std::size_t f) { return mesh.region_of(mesh.sides()[f].tet) + 1; };
  out.line("mesh3d\ndimension\n3\ngeomtype\n0\n\n# surfnr bcnr domin domout np p1 p2 p3\nsurfaceelements\n{}",
           mesh.faces());
  for (std::size_t f = 0; f < mesh.faces(); ++f) {
    const std::uint32_t patch = mesh.patch_of(f) + 1;
    out << patch << ' ' << patch << ' ' << behind(f) << " 0 " << std::uint64_t{mesh.nodes_per_face()};
    for (std::size_t k = 0; k < mesh.nodes_per_face(); ++k) out << ' ' << mesh.face_node(f, kNetgenTriangle[k]) + 1;
    out << '\n';
  }
  out.line("\n# matnr np p1 p2 p3 p4\nvolumeelements\n{}", mesh.tets());
  for (std::size_t t = 0; t < mesh.tets(); ++t) {
    out << mesh.region_of(t) + 1 << ' ' << std::uint64_t{mesh.nodes_per_tet()};
    for (std::size_t k = 0; k < mesh.nodes_per_tet(); ++k) out << ' ' << mesh.tet_node(t, kNetgenTet[k]) + 1;
    out << '\n';
  }
  out.line("\n# surfid 0 p1 p2 trignum1 trignum2 domin domout ednr1 dist1 ednr2 dist2\nedgesegmentsgi2\n{}",
           mesh.edges());
  for (std::size_t e = 0; e < mesh.edges(); ++e) {
    const std::uint32_t curve = mesh.curve_of(e) + 1;
    out << "1 0 " << mesh.edge_node(e, 0) + 1 << ' ' << mesh.edge_node(e, 1) + 1 << " -1 -1 0 0 " << curve << " 0 "
        << curve << " 0\n";
  }
  out.line("\n# X Y Z\npoints\n{}", mesh.points());
  for (std::size_t v = 0; v < mesh.points(); ++v) {
    const Vec3 p = mesh.mesh().points[v];
    out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  }
  const auto with_one_word = [&](Part::Origin origin) {
    std::vector<Part> parts(mesh.parts(origin).begin(), mesh.parts(origin).end());
    LegalNames legal({.also = "_-.:+<>&\"'()[]{}/*", .letter_first = false, .ignores_case = false});
    for (Part& part : parts) part.name = legal.legal(part.name);
    output.note(legal.note());
    return parts;
  };
  write_names_of_parts(out, "materials", with_one_word(Part::Origin::kRegion));
  write_names_of_parts(out, "bcnames", with_one_word(Part::Origin::kPatch));
  write_names_of_parts(out, "cd2names", with_one_word(Part::Origin::kCurve));
  out << "\nendmesh\n";
}

}  // namespace octafront::io
