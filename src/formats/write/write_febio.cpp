// FEBio 4.0: the sections Mesh and MeshDomains. A region is a list of elements and a domain whose material has its
// name; the materials themselves are to be added. Patches are surfaces, curves edges, sets of nodes and elements
// NodeSet and ElementSet.

#include "formats/containers/text_writer.h"
#include "formats/containers/vtk_xml.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <array>
#include <span>
#include <string>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

class FebioWriter {
 public:
  FebioWriter(MeshOutput& out, const MeshParts& mesh) : text_(out.file()), mesh_(mesh), cells_(mesh) {
    LegalNames unique({.longest = 1000, .also = " _-.()[]{}#+*/%$!?=~^@|:;'<>&\"", .letter_first = false});
    for (const Part& part : mesh.parts()) names_.push_back(escaped(unique.legal(part.name)));
    out.note(unique.note());
  }

  void write() {
    text_ << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<febio_spec version=\"4.0\">\n  <Module type=\"solid\"/>\n"
             "  <!-- Mesh by octafront: add a <Material> with the name of each SolidDomain's mat. -->\n  <Mesh>\n"
             "    <Nodes name=\"all nodes\">\n";
    for (std::uint32_t v = 0; v < mesh_.points(); ++v) {
      const Vec3 p = mesh_.mesh().points[v];
      text_ << "      <node id=\"" << v + 1 << "\">" << p.x << ',' << p.y << ',' << p.z << "</node>\n";
    }
    text_ << "    </Nodes>\n";
    // All elements before what refers to them.
    for (const bool regions : {true, false})
      for (std::size_t p = 0; p < names_.size(); ++p)
        if ((mesh_.parts()[p].origin == Part::Origin::kRegion) == regions) write_part(mesh_.parts()[p], names_[p]);
    text_ << "  </Mesh>\n  <MeshDomains>\n";
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (mesh_.parts()[p].origin == Part::Origin::kRegion)
        for (const MixedCells::Kind kind : MixedCells::kAllKinds)
          if (!cells_of(mesh_.parts()[p], kind).empty())
            text_.line("    <SolidDomain name=\"{}\" mat=\"{}\"/>", domain_name(names_[p], kind), names_[p]);
    text_ << "  </MeshDomains>\n</febio_spec>\n";
  }

 private:
  void nodes(std::string_view tag, std::uint32_t id, std::span<const VertexIndex> all) {
    text_ << "      <" << tag << " id=\"" << id << "\">";
    for (std::size_t k = 0; k < all.size(); ++k) text_ << (k > 0 ? "," : "") << all[k] + 1;
    text_ << "</" << tag << ">\n";
  }

  void ids(std::string_view tag, const std::string& name, std::span<const std::uint32_t> members) {
    text_.line("    <{} name=\"{}\">", tag, name);
    constexpr std::size_t kInLine = 16;
    for (std::size_t i = 0; i < members.size(); ++i)
      text_ << members[i] + 1 << (i + 1 == members.size() ? "\n" : i % kInLine == kInLine - 1 ? ",\n" : ",");
    text_.line("    </{}>", tag);
  }

  /// Elements of one kind are a list of their own.
  static std::string domain_name(const std::string& name, MixedCells::Kind kind) {
    constexpr std::array<const char*, MixedCells::kKinds> kSuffixes{"", " pyramids", " wedges"};
    return name + kSuffixes[kind];
  }
  std::vector<std::uint32_t> cells_of(const Part& region, MixedCells::Kind kind) const {
    std::vector<std::uint32_t> cells = cells_.members(region);
    std::erase_if(cells, [&](std::uint32_t c) { return cells_.kind(c) != kind; });
    return cells;
  }

  void write_domain(const Part& region, const std::string& name, MixedCells::Kind kind) {
    constexpr std::array<const char*, MixedCells::kKinds> kTypes{"tet", "pyra", "penta"};
    const std::vector<std::uint32_t> cells = cells_of(region, kind);
    if (cells.empty()) return;
    text_.line("    <Elements type=\"{}{}\" name=\"{}\">", kTypes[kind], cells_.nodes_per(kind),
               domain_name(name, kind));
    CellRoom room;
    for (const std::uint32_t c : cells) nodes("elem", c + 1, cells_.nodes(c, room));
    text_ << "    </Elements>\n";
  }

  void write_part(const Part& part, const std::string& name) {
    std::uint32_t id = 0;
    const bool second = mesh_.second_order();
    if (part.origin == Part::Origin::kRegion) {
      for (const MixedCells::Kind kind : MixedCells::kAllKinds) write_domain(part, name, kind);
    } else if (part.kind == Kind::kFaces) {
      text_.line("    <Surface name=\"{}\">", name);
      FaceRoom room;
      for (const std::uint32_t f : cells_.members(part)) {
        const auto all = cells_.face_nodes(f, room);
        nodes(fmt::format("{}{}", f < cells_.triangles() ? "tri" : "quad", all.size()), ++id, all);
      }
      text_ << "    </Surface>\n";
    } else if (part.kind == Kind::kEdges) {
      text_.line("    <Edge name=\"{}\">", name);
      EdgeRoom room;
      for (const std::uint32_t e : part.members) nodes(second ? "line3" : "line2", ++id, mesh_.edge_nodes(e, room));
      text_ << "    </Edge>\n";
    } else {
      ids(part.kind == Kind::kNodes ? "NodeSet" : "ElementSet", name, cells_.members(part));
    }
  }

  TextWriter text_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<std::string> names_;  ///< of the parts, escaped
};

}  // namespace

void write_febio(MeshOutput& out, const MeshParts& mesh) {
  FebioWriter(out, mesh).write();
}

}  // namespace octafront::io
