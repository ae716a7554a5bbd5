// FEBio 4.0: the sections Mesh and MeshDomains. A region is a list of elements and a domain whose material has its
// name; the materials themselves are to be added. Patches are surfaces, curves edges, sets of nodes and elements
// NodeSet and ElementSet.

#include "formats/containers/text_writer.h"
#include "formats/containers/vtk_xml.h"
#include "formats/write/writers.h"

#include <array>
#include <span>
#include <string>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

class FebioWriter {
 public:
  FebioWriter(MeshOutput& out, const MeshParts& mesh) : text_(out.file()), mesh_(mesh) {
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
        text_.line("    <SolidDomain name=\"{0}\" mat=\"{0}\"/>", names_[p]);
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

  void write_part(const Part& part, const std::string& name) {
    std::uint32_t id = 0;
    const bool second = mesh_.second_order();
    if (part.origin == Part::Origin::kRegion) {
      text_.line("    <Elements type=\"{}\" name=\"{}\">", second ? "tet10" : "tet4", name);
      std::array<VertexIndex, 10> room;
      for (const TetIndex t : part.members) nodes("elem", t + 1, mesh_.tet_nodes(t, room));
      text_ << "    </Elements>\n";
    } else if (part.kind == Kind::kFaces) {
      text_.line("    <Surface name=\"{}\">", name);
      std::array<VertexIndex, 6> room;
      for (const std::uint32_t f : part.members) nodes(second ? "tri6" : "tri3", ++id, mesh_.face_nodes(f, room));
      text_ << "    </Surface>\n";
    } else if (part.kind == Kind::kEdges) {
      text_.line("    <Edge name=\"{}\">", name);
      std::array<VertexIndex, 3> room;
      for (const std::uint32_t e : part.members) nodes(second ? "line3" : "line2", ++id, mesh_.edge_nodes(e, room));
      text_ << "    </Edge>\n";
    } else {
      ids(part.kind == Kind::kNodes ? "NodeSet" : "ElementSet", name, part.members);
    }
  }

  TextWriter text_;
  const MeshParts& mesh_;
  std::vector<std::string> names_;  ///< of the parts, escaped
};

}  // namespace

void write_febio(MeshOutput& out, const MeshParts& mesh) {
  FebioWriter(out, mesh).write();
}

}  // namespace octafront::io
