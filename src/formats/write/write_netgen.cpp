// Netgen .vol: surface elements, volume elements, edge segments, points, names. Netgen's tetrahedra are negative in our
// terms: their second and third corner are exchanged. Mid-side nodes: of tetrahedra 12 13 14 23 24 34, of triangles
// opposite to each corner. Of orders 3 and 4 elements are linear, and curves follow (formats/parts/netgen_curves.h).

#include "base/geometry/curved_tet.h"
#include "formats/containers/text_writer.h"
#include "formats/parts/netgen_curves.h"
#include "formats/write/writers.h"

#include <array>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/core.h>

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

class NetgenWriter {
 public:
  NetgenWriter(MeshOutput& output, const MeshParts& mesh)
      : output_(output), out_(output.file()), mesh_(mesh), is_high_(mesh.order() > 2) {}

  void write() {
    write_faces();
    write_tets();
    write_edges();
    write_points();
    write_names("materials", Part::Origin::kRegion);
    write_names("bcnames", Part::Origin::kPatch);
    write_names("cd2names", Part::Origin::kCurve);
    if (is_high_) write_curves();
    out_ << "\nendmesh\n";
  }

 private:
  void write_faces() {
    // Regions on the side that a face looks to, and on the other one; 0: outside.
    const auto behind = [&](std::size_t f) { return mesh_.region_of(mesh_.sides()[f].tet) + 1; };
    const std::size_t nodes = is_high_ ? 3 : mesh_.nodes_per_face();
    out_.line("mesh3d\ndimension\n3\ngeomtype\n0\n\n# surfnr bcnr domin domout np p1 p2 p3\nsurfaceelements\n{}",
              mesh_.faces());
    for (std::size_t f = 0; f < mesh_.faces(); ++f) {
      const std::uint32_t patch = mesh_.patch_of(f) + 1;
      out_ << patch << ' ' << patch << ' ' << behind(f) << " 0 " << std::uint64_t{nodes};
      for (std::size_t k = 0; k < nodes; ++k) out_ << ' ' << mesh_.face_node(f, kNetgenTriangle[k]) + 1;
      out_ << '\n';
    }
  }

  void write_tets() {
    const std::size_t nodes = is_high_ ? 4 : mesh_.nodes_per_tet();
    out_.line("\n# matnr np p1 p2 p3 p4\nvolumeelements\n{}", mesh_.tets());
    for (std::size_t t = 0; t < mesh_.tets(); ++t) {
      out_ << mesh_.region_of(t) + 1 << ' ' << std::uint64_t{nodes};
      for (std::size_t k = 0; k < nodes; ++k) out_ << ' ' << mesh_.tet_node(t, kNetgenTet[k]) + 1;
      out_ << '\n';
    }
  }

  void write_edges() {
    out_.line("\n# surfid 0 p1 p2 trignum1 trignum2 domin domout ednr1 dist1 ednr2 dist2\nedgesegmentsgi2\n{}",
              mesh_.edges());
    for (std::size_t e = 0; e < mesh_.edges(); ++e) {
      const std::uint32_t curve = mesh_.curve_of(e) + 1;
      out_ << "1 0 " << mesh_.edge_node(e, 0) + 1 << ' ' << mesh_.edge_node(e, 1) + 1 << " -1 -1 0 0 " << curve << " 0 "
           << curve << " 0\n";
    }
  }

  void write_points() {
    const std::size_t points = is_high_ ? mesh_.corner_points() : mesh_.points();
    out_.line("\n# X Y Z\npoints\n{}", points);
    for (std::size_t v = 0; v < points; ++v) write_numbers(mesh_.mesh().points[v], ' ');
  }

  void write_numbers(const Vec3& p, char between) { out_ << p.x << between << p.y << between << p.z << '\n'; }

  void write_names(std::string_view section, Part::Origin origin) {
    std::vector<Part> parts(mesh_.parts(origin).begin(), mesh_.parts(origin).end());
    LegalNames legal({.also = "_-.:+<>&\"'()[]{}/*", .letter_first = false, .ignores_case = false});
    for (Part& part : parts) part.name = legal.legal(part.name);
    output_.note(legal.note());
    write_names_of_parts(out_, section, parts);
  }

  Vec3 node(TetIndex t, std::size_t k) const { return mesh_.mesh().points[mesh_.lattice_node(t, k)]; }

  template <class T>
  void write_list(const std::vector<T>& list) {
    out_ << std::uint64_t{list.size()} << '\n';
    for (const T& item : list) {
      if constexpr (std::is_same_v<T, Vec3>)
        write_numbers(item, '\n');
      else
        out_ << item << '\n';
    }
  }

  /// As Netgen's archives of text have them.
  void write_curves() {
    const NetgenCurves curves(mesh_.mesh().tets, mesh_.corner_points(), mesh_.order(),
                              [&](TetIndex t, std::size_t k) { return node(t, k); });
    out_ << "\ncurvedelements\n";
    write_list(curves.edges.order), write_list(curves.faces.order);
    write_list(curves.edges.first), write_list(curves.faces.first);
    write_list(curves.edges.coefficients), write_list(curves.faces.coefficients);
    out_.line("0\n{}\nf\nt", mesh_.order());  // no weights; the order; not rational, but of high order
    output_.note(
        "orders 3 and 4 are read by Netgen, and so by NGSolve, from April 2026 on; older ones take elements as linear");
    if (mesh_.order() == 4) note_inner_nodes(curves);
  }

  /// Netgen adds nothing inside elements.
  void note_inner_nodes(const NetgenCurves& curves) {
    std::size_t moved = 0, unproven = 0;
    std::vector<Vec3> nodes(mesh_.nodes_per_tet());
    for (TetIndex t = 0; t < mesh_.tets(); ++t) {
      for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = node(t, k);
      constexpr double kQuarter = 0.25, kSame = 1e-12;  // of the element: what rounding may make of it
      const Vec3 inner = kQuarter * (nodes[0] + nodes[1] + nodes[2] + nodes[3]) +
                         curves.added(t, {kQuarter, kQuarter, kQuarter, kQuarter});
      if (length(inner - nodes.back()) <= kSame * length(nodes[1] - nodes[0])) continue;
      ++moved;
      nodes.back() = inner;
      unproven += validity_of(4, nodes) != Validity::kValid;
    }
    if (moved > 0)
      output_.note(
          fmt::format("Netgen keeps no nodes inside elements: {} have the one of order 4 elsewhere, {} of them "
                      "are not proven valid so{}",
                      moved, unproven, unproven > 0 ? "; order 3 keeps all" : ""));
  }

  MeshOutput& output_;
  TextWriter out_;
  const MeshParts& mesh_;
  bool is_high_;
};

}  // namespace

void write_netgen(MeshOutput& output, const MeshParts& mesh) {
  NetgenWriter(output, mesh).write();
}

}  // namespace octafront::io
