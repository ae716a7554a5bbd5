// MFEM's mesh files: elements and boundary by attribute, kind and vertices, vertices, and of curved meshes their nodes
// as a grid function of a continuous space. Nodes are ours as they are: MFEM's H1 spaces know equispaced points, too
// ("H1@U"; at order 2 the usual ones are these). Names are sets of attributes, which MFEM reads from 4.7 on (v1.3); a
// mesh without names is one that all read (v1.0).

#include "base/geometry/tet_lattice.h"
#include "formats/containers/text_writer.h"
#include "formats/parts/mfem_nodes.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {
namespace {

using Origin = Part::Origin;

class MfemWriter {
 public:
  MfemWriter(AtomicFile& file, const MeshParts& mesh) : out_(file), mesh_(mesh), cells_(mesh) {}

  void write() {
    const bool with_names = has_names(Origin::kRegion) || has_names(Origin::kPatch);
    out_.line(
        "MFEM mesh v1.{}\n\n# attribute, kind, vertices: 2 triangle, 3 quadrilateral, 4 tetrahedron, 6 wedge, 7 "
        "pyramid\n\ndimension\n3",
        with_names ? 3 : 0);
    write_elements();
    if (with_names) write_sets("attribute_sets", Origin::kRegion);
    write_boundary();
    if (with_names) write_sets("bdr_attribute_sets", Origin::kPatch);
    mesh_.order() == 1 ? write_vertices() : write_nodes();
    if (with_names) out_ << "\nmfem_mesh_end\n";
  }

 private:
  bool has_names(Origin origin) const {
    return std::ranges::any_of(mesh_.parts(origin), [](const Part& part) { return part.is_named; });
  }

  void write_elements() {
    constexpr std::array kKinds{4, 7, 6};  // of MixedCells::Kind
    out_.line("\nelements\n{}", cells_.cells());
    for (std::size_t c = 0; c < cells_.cells(); ++c) {
      const MixedCells::Kind kind = cells_.kind(c);
      out_ << mesh_.tag_of_region(mesh_.region_of(cells_.first_tet(c))) << ' ' << kKinds[kind];
      for (std::size_t k = 0; k < 4 + static_cast<std::size_t>(kind); ++k) out_ << ' ' << cells_.node(c, k);
      out_ << '\n';
    }
  }

  void write_boundary() {
    out_.line("\nboundary\n{}", cells_.faces());
    for (std::size_t f = 0; f < cells_.faces(); ++f) {
      const std::size_t corners = f < cells_.triangles() ? 3 : 4;
      out_ << mesh_.tag_of(Origin::kPatch, mesh_.patch_of(cells_.first_face(f))) << ' ' << corners - 1;
      for (std::size_t k = 0; k < corners; ++k) out_ << ' ' << cells_.face_node(f, k);
      out_ << '\n';
    }
  }

  void write_sets(std::string_view section, Origin origin) {
    std::vector<std::pair<std::string, std::vector<std::uint32_t>>> sets;
    for (const Part& part : mesh_.parts(origin)) {
      if (!part.is_named) continue;
      const auto same = std::ranges::find(sets, part.name, [](const auto& set) { return set.first; });
      (same == sets.end() ? sets.emplace_back(part.name, std::vector<std::uint32_t>()) : *same)
          .second.push_back(part.tag);
    }
    out_.line("\n{}\n{}", section, sets.size());
    for (const auto& [name, tags] : sets) {
      out_.line("{}\n{}", quoted_for_mfem(name), tags.size());
      for (const std::uint32_t tag : tags) out_ << tag << (tag == tags.back() ? '\n' : ' ');
    }
  }

  /// As std::quoted has it.
  static std::string quoted_for_mfem(std::string_view name) {
    std::string text = "\"";
    for (const char c : name) {
      if (c == '"' || c == '\\') text += '\\';
      text += c;
    }
    return text + '"';
  }

  void write_place(VertexIndex v) {
    const Vec3 p = mesh_.mesh().points[v];
    out_ << p.x << ' ' << p.y << ' ' << p.z << '\n';
  }

  void write_vertices() {
    out_.line("\nvertices\n{}\n3", mesh_.points());
    for (VertexIndex v = 0; v < mesh_.points(); ++v) write_place(v);
  }

  void write_nodes() {
    const std::size_t corners = mesh_.corner_points();
    out_.line(
        "\nvertices\n{}\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: H1{}_3D_P{}\nVDim: 3\nOrdering: 1\n",
        corners, mesh_.order() == 2 ? "" : "@U", mesh_.order());
    for (const VertexIndex v : in_order(corners)) write_place(v);
  }

  /// The points by MFEM's numbers.
  std::vector<VertexIndex> in_order(std::size_t corners) const {
    const MfemNumbering numbering(mesh_.mesh().tets, corners, mesh_.order());
    std::vector<VertexIndex> points(numbering.size());
    CellRoom numbers;
    for (TetIndex t = 0; t < mesh_.tets(); ++t) {
      numbering.of_tet(t, numbers);
      for (std::size_t k = 0; k < mesh_.nodes_per_tet(); ++k) points[numbers[k]] = mesh_.lattice_node(t, k);
    }
    return points;
  }

  TextWriter out_;
  const MeshParts& mesh_;
  MixedCells cells_;
};

}  // namespace

void write_mfem(MeshOutput& out, const MeshParts& mesh) {
  MfemWriter(out.file(), mesh).write();
}

}  // namespace octafront::io
