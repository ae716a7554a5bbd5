// MSH 2.2 as SimNIBS reads and writes it: nodes from 1 on, triangles before tetrahedra, numbered through, no names; a
// tetrahedron has the label of its region (1 white matter, 2 grey matter, ... as SimNIBS counts tissues) as both of its
// tags, a triangle 1000 and the label of the tissue that it bounds, facing out of it.

#include <octafront/error.h>

#include "formats/containers/input.h"
#include "formats/write/msh_writing.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront::io {
namespace {

constexpr std::int32_t kSurfaces = 1000;
/// Of two tissues a face between them bounds the one that comes first here; others behind, the lower one first.
constexpr std::array kInside{1, 2, 9, 3, 4, 8, 7, 6, 10, 5};

std::size_t rank_of_tissue(std::int32_t tag) {
  const auto found = std::find(kInside.begin(), kInside.end(), tag);
  return found != kInside.end() ? static_cast<std::size_t>(found - kInside.begin())
                                : kInside.size() + static_cast<std::size_t>(tag);
}

/// The label of the region of an element, or its number.
std::int32_t tissue_of(const MeshParts& mesh, std::size_t tet) {
  return static_cast<std::int32_t>(mesh.number_of(Part::Origin::kRegion, mesh.region_of(tet)));
}

/// The faces of the boundary and of interfaces, each out of the tissue that it bounds.
struct TissueFaces {
  std::vector<Triangle> corners;
  std::vector<std::int32_t> tag;
};

TissueFaces tissue_faces(const MeshParts& mesh) {
  std::vector<std::pair<Triangle, std::uint32_t>> wanted(mesh.faces());
  for (std::uint32_t f = 0; f < wanted.size(); ++f) wanted[f] = {face_key(mesh.face(f)), f};
  std::sort(wanted.begin(), wanted.end());
  TissueFaces faces{std::vector<Triangle>(wanted.size()), std::vector<std::int32_t>(wanted.size(), 0)};
  for (std::size_t t = 0; t < mesh.tets(); ++t) {
    const std::int32_t tag = tissue_of(mesh, t);
    for (const auto& [a, b, c] : kTetFaces) {
      const Tet& tet = mesh.mesh().tets[t];
      const auto at = [&](int corner) { return tet[static_cast<std::size_t>(corner)]; };
      const Triangle face{at(a), at(b), at(c)};
      const auto found = std::lower_bound(wanted.begin(), wanted.end(), std::pair{face_key(face), 0u});
      if (found == wanted.end() || found->first != face_key(face)) continue;
      std::int32_t& known = faces.tag[found->second];
      if (known != 0 && rank_of_tissue(known - kSurfaces) <= rank_of_tissue(tag)) continue;
      known = kSurfaces + tag;
      faces.corners[found->second] = face;
    }
  }
  return faces;
}

class SimnibsWriter {
 public:
  SimnibsWriter(AtomicFile& file, const MeshParts& mesh, std::span<const MeshField> fields, bool as_text)
      : text_(file), out_(file, as_text), mesh_(mesh), fields_(fields) {}

  void write() {
    write_format(text_, out_, "2.2");
    text_.line("$Nodes\n{}", mesh_.points());
    for (std::size_t v = 0; v < mesh_.points(); ++v) {
      out_.put(static_cast<std::int32_t>(v) + 1);
      out_.put(mesh_.mesh().points[v]);
      out_.end_record();
    }
    out_.close("Nodes");
    const TissueFaces faces = tissue_faces(mesh_);
    text_.line("$Elements\n{}", faces.tag.size() + mesh_.tets());
    write_elements(
        2, faces.tag.size(), [&](std::size_t f) { return faces.tag[f]; },
        [&](std::size_t f) { return faces.corners[f]; });
    write_elements(
        4, mesh_.tets(), [&](std::size_t t) { return tissue_of(mesh_, t); },
        [&](std::size_t t) { return mesh_.mesh().tets[t]; });
    out_.close("Elements");
    const std::size_t before = faces.tag.size();
    const MixedCells cells(mesh_);
    write_fields(
        text_, out_, fields_,
        [&](const MeshField& field, std::size_t i) { return (field.of_elements ? before : 0) + i + 1; }, &cells);
  }

 private:
  template <class TagOf, class NodesOf>
  void write_elements(std::int32_t type, std::size_t count, const TagOf& tag_of, const NodesOf& nodes_of) {
    constexpr std::int32_t kTags = 2;
    if (count == 0) return;
    if (!out_.as_text()) out_.record(type, static_cast<std::int32_t>(count), kTags);
    for (std::size_t i = 0; i < count; ++i) {
      out_.put(++number_);
      if (out_.as_text()) out_.put(type), out_.put(kTags);
      for (int k = 0; k < kTags; ++k) out_.put(tag_of(i));
      for (const VertexIndex v : nodes_of(i)) out_.put(static_cast<std::int32_t>(v) + 1);
      out_.end_record();
    }
  }

  TextWriter text_;
  MshNumbers out_;
  const MeshParts& mesh_;
  std::span<const MeshField> fields_;
  std::int32_t number_ = 0;
};

}  // namespace

void write_simnibs(MeshOutput& out, const MeshParts& mesh) {
  out.require_32_bits(std::max(mesh.points(), mesh.faces() + mesh.tets()),
                      "MSH 2.2 counts with 32 bits, too few for this mesh");
  for (const Part& part : mesh.parts(Part::Origin::kRegion))
    if (const std::int64_t label = mesh.number_of(Part::Origin::kRegion, part.number); label < 1 || label >= kSurfaces)
      throw OutputError(fmt::format("{}: the region {} has the label {}; SimNIBS has labels from 1 to below {}",
                                    out.target().string(), in_quotes(part.name), label, kSurfaces));
  note_fields_left_out(out);
  SimnibsWriter(out.file(), mesh, out.fields(), out.as_text()).write();
}

}  // namespace octafront::io
