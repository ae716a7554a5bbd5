// Gmsh MSH 2.2, binary or text: regions, patches and curves are physical groups and entities. Node and element tags are
// indices plus 1, elements counting edges first, then faces, then cells. Of a periodic cell, $Periodic pairs the nodes
// of each patch that is a copy with those of its original.

#include "formats/write/msh_writing.h"
#include "formats/write/writers.h"

namespace octafront::io {
namespace {

/// Elements with two tags each: their physical group, and the same as their entity.
class Msh2Writer {
 public:
  Msh2Writer(AtomicFile& file, const MeshParts& mesh, std::span<const MeshField> fields, bool as_text)
      : text_(file), out_(file, as_text), mesh_(mesh), fields_(fields), cells_(mesh), nodes_of_(mesh, cells_) {}

  void write() {
    write_format(text_, out_, "2.2");
    write_physical_names(text_, mesh_, physical_tags(mesh_), false);
    text_.line("$Nodes\n{}", mesh_.points());
    for (std::size_t v = 0; v < mesh_.points(); ++v) {
      put(static_cast<std::int32_t>(v) + 1);
      out_.put(mesh_.mesh().points[v]);
      out_.end_record();
    }
    out_.close("Nodes");
    text_.line("$Elements\n{}", mesh_.edges() + cells_.faces() + cells_.cells());
    write_elements(1, 0, mesh_.edges(), mesh_.nodes_per_edge());
    write_elements(2, 0, cells_.triangles(), mesh_.nodes_per_face());
    write_elements(2, cells_.triangles(), cells_.faces(), cells_.nodes_per_quad());
    for (const MixedCells::Kind kind : MixedCells::kAllKinds)
      write_elements(3, cells_.begin(kind), cells_.end(kind), cells_.nodes_per(kind));
    out_.close("Elements");
    if (!mesh_.mesh().periods.empty() && !mesh_.cells_only()) write_periodic();
    const std::size_t before = mesh_.edges() + cells_.faces();
    write_fields(
        text_, out_, fields_,
        [&](const MeshField& field, std::size_t i) { return (field.of_elements ? before : 0) + i + 1; }, &cells_);
  }

 private:
  void put(std::int32_t value) { out_.put(value); }

  /// Always text, also in binary files.
  void write_periodic() {
    const PeriodicLinks links(mesh_, [&](std::size_t f) {
      return static_cast<std::int32_t>(mesh_.tag_of(Part::Origin::kPatch, mesh_.patch_of(f)));
    });
    text_.line("$Periodic\n{}", links.size());
    links.for_each([&](std::int32_t tag, std::int32_t of, const std::array<double, 16>& matrix, const auto& pairs) {
      text_.line("2 {} {}", tag, of);
      text_ << "Affine";
      for (const double value : matrix) text_ << ' ' << value;
      text_.line("\n{}", pairs.size());
      for (const auto& [copy, original] : pairs) text_.line("{} {}", copy + 1, original + 1);
    });
    text_ << "$EndPeriodic\n";
  }

  /// The elements of a dimension from `begin` to `end`, which have so many nodes each.
  void write_elements(std::size_t dimension, std::size_t begin, std::size_t end, std::size_t nodes) {
    if (begin == end) return;
    constexpr std::int32_t kTags = 2;
    const std::size_t count = end - begin;
    const std::int32_t type = gmsh_type_of(dimension, nodes);
    // A binary file says once what a text says in every line.
    if (!out_.as_text())
      for (const std::int32_t n : {type, static_cast<std::int32_t>(count), kTags}) put(n);
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
      put(++tag_);
      if (out_.as_text())
        for (const std::int32_t n : {type, kTags}) put(n);
      const std::uint32_t part_tag = dimension == 1 ? mesh_.tag_of(Part::Origin::kCurve, mesh_.curve_of(i))
                                     : dimension == 2
                                         ? mesh_.tag_of(Part::Origin::kPatch, mesh_.patch_of(cells_.first_face(i)))
                                         : mesh_.tag_of_region(mesh_.region_of(cells_.first_tet(i)));
      for (int k = 0; k < kTags; ++k) put(static_cast<std::int32_t>(part_tag));
      nodes_of_.put<std::int32_t>(dimension, i, [&](std::int32_t tag) { put(tag); });
      out_.end_record();
    }
  }

  TextWriter text_;
  MshNumbers out_;
  const MeshParts& mesh_;
  std::span<const MeshField> fields_;
  MixedCells cells_;
  ElementNodes nodes_of_;
  std::int32_t tag_ = 0;
};

}  // namespace

void write_msh2(MeshOutput& out, const MeshParts& mesh) {
  out.require_32_bits(std::max(mesh.points(), mesh.edges() + mesh.faces() + mesh.tets()),
                      "MSH 2.2 counts with 32 bits, too few for this mesh; write MSH 4.1");
  note_fields_left_out(out);
  Msh2Writer(out.file(), mesh, out.fields(), out.as_text()).write();
}

}  // namespace octafront::io
