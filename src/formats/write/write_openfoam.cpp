// OpenFOAM polyMesh folder, text: points, faces, owner, neighbour, boundary, and zones. Faces between two cells come
// first, in the order of the lower cell and then of the upper one, then those of each patch. Regions are cellZones,
// interfaces faceZones.

#include <octafront/error.h>

#include "base/mesh/adjacency.h"
#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/foam_files.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace octafront::io {
namespace {

class OpenFoamWriter {
 public:
  OpenFoamWriter(MeshOutput& out, const MeshParts& mesh)
      : files_{out.folder(), "constant/polyMesh", out.context()},
        mesh_(mesh),
        cells_(mesh),
        across_(half_face_neighbors(mesh.mesh().tets, mesh.mesh().points.size())),
        names_(legal_names(out, mesh, {.also = "_-."}, std::array{Part::Origin::kRegion, Part::Origin::kPatch})) {
    if (!mesh.wide_cells().empty()) mixed_ = faces_between(cells_);
  }

  void write() {
    files_.file("points", "vectorField", [&](TextWriter& out) {
      out << std::uint64_t{mesh_.points()} << "\n(\n";
      for (std::size_t v = 0; v < mesh_.points(); ++v) {
        const Vec3 p = mesh_.mesh().points[v];
        out << '(' << p.x << ' ' << p.y << ' ' << p.z << ")\n";
      }
      out << ")\n";
    });
    // Each list goes over the faces again rather than keeping them.
    list("faces", "faceList", all_faces(), [](TextWriter& out, std::span<const VertexIndex> nodes, auto, auto) {
      out << std::uint64_t{nodes.size()};
      for (std::size_t i = 0; i < nodes.size(); ++i) out << (i == 0 ? '(' : ' ') << nodes[i];
      out << ")\n";
    });
    list("owner", "labelList", all_faces(),
         [](TextWriter& out, auto, std::uint32_t owner, auto) { out << owner << '\n'; });
    list("neighbour", "labelList", inner_faces(), [](TextWriter& out, auto, auto, std::uint32_t neighbour) {
      if (neighbour != kNone) out << neighbour << '\n';
    });
    write_boundary();
    write_cell_zones();
    write_face_zones();
  }

 private:
  using Put = std::function<void(TextWriter&, std::span<const VertexIndex> nodes, std::uint32_t owner,
                                 std::uint32_t neighbour)>;

  HalfFace half_face(std::size_t f) const {
    return 4 * mesh_.sides()[f].tet + static_cast<HalfFace>(mesh_.sides()[f].face);
  }
  std::size_t inner_faces() const {
    return mixed_ ? mixed_->size() : (4 * mesh_.tets() - mesh_.mesh().boundary.size()) / 2;
  }
  std::size_t all_faces() const { return inner_faces() + mesh_.mesh().boundary.size() - cells_.quads(); }

  void list(const std::string& name, std::string_view type, std::size_t count, const Put& put) {
    files_.file(name, type, [&](TextWriter& out) {
      out << std::uint64_t{count} << "\n(\n";
      if (mixed_)
        put_mixed(out, put);
      else
        for_each_face([&](HalfFace h, HalfFace other) {
          const Triangle nodes = face_of(mesh_.mesh().tets[h / 4], static_cast<int>(h % 4));
          put(out, nodes, h / 4, other == kNone ? kNone : other / 4);
        });
      out << ")\n";
    });
  }

  void put_mixed(TextWriter& out, const Put& put) const {
    for (const FoamFace& face : *mixed_) put(out, face.corners(), face.owner, face.neighbour);
    std::array<VertexIndex, 8> room;
    for (const Part& patch : mesh_.parts(Part::Origin::kPatch))
      for (const std::uint32_t f : outside(patch)) {
        const TetIndex tet = mesh_.sides()[cells_.first_face(f)].tet;
        put(out, cells_.face_nodes(f, room), static_cast<std::uint32_t>(cells_.cell_of(tet)), kNone);
      }
  }

  /// Inner faces by owner and neighbour, then the boundary patch by patch; visit(half-face of the owner, the other
  /// one).
  template <class Visit>
  void for_each_face(const Visit& visit) const {
    for (TetIndex t = 0; t < mesh_.tets(); ++t) {
      std::array<std::pair<HalfFace, HalfFace>, 4> faces;
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) faces[h % 4] = {across_[h], h};
      std::sort(faces.begin(), faces.end());
      for (const auto& [other, own] : faces)
        if (other != kNone && other / 4 > t) visit(own, other);
    }
    for (const Part& patch : mesh_.parts(Part::Origin::kPatch))
      for (const std::uint32_t f : patch.members)
        if (f < mesh_.mesh().boundary.size()) visit(half_face(f), kNone);
  }

  /// The faces of a patch that belong to the boundary.
  std::vector<std::uint32_t> outside(const Part& patch) const {
    std::vector<std::uint32_t> faces = cells_.members(patch);
    std::erase_if(faces, [&](std::uint32_t f) { return cells_.first_face(f) >= mesh_.mesh().boundary.size(); });
    return faces;
  }

  void write_boundary() {
    files_.file("boundary", "polyBoundaryMesh", [&](TextWriter& out) {
      const auto patches = mesh_.parts(Part::Origin::kPatch);
      out.line("{}\n(",
               std::count_if(patches.begin(), patches.end(), [&](const Part& p) { return !outside(p).empty(); }));
      std::size_t first = inner_faces();
      for (const Part& patch : patches) {
        const std::size_t faces = outside(patch).size();
        if (faces == 0) continue;
        put_patch(out, name(patch), mesh_, patch, faces, first);
        first += faces;
      }
      out << ")\n";
    });
  }

  const std::string& name(const Part& part) const {
    return names_[static_cast<std::size_t>(&part - mesh_.parts().data())];
  }
  void write_cell_zones() {
    files_.file("cellZones", "regIOobject", [&](TextWriter& out) {
      const auto is_of_cells = [](const Part& p) { return p.kind == NamedSet::Kind::kElements; };
      const auto& parts = mesh_.parts();
      // A cell may be in one zone only.
      const auto is_zone = [&](const Part& p) { return is_of_cells(p) && p.origin == Part::Origin::kRegion; };
      out.line("{}\n(", std::count_if(parts.begin(), parts.end(), is_zone));
      for (const Part& part : parts)
        if (is_zone(part)) put_cell_zone(out, name(part), cells_.members(part));
      out << ")\n";
    });
  }

  void write_face_zones() {
    const InterfacePatches interfaces(mesh_);
    if (interfaces.empty()) return;
    std::map<std::uint32_t, std::vector<FoamZoneFace>> labels;
    std::size_t label = 0;
    const auto add = [&](std::span<const VertexIndex> corners) {
      if (const std::uint32_t patch = interfaces.of(corners); patch != kNone) labels[patch].push_back({label, false});
      ++label;
    };
    if (mixed_)
      for (const FoamFace& face : *mixed_) add(face.corners());
    else
      for_each_face([&](HalfFace h, HalfFace) { add(corners_of(mesh_.mesh().tets, h)); });
    files_.file("faceZones", "regIOobject", [&](TextWriter& out) {
      out.line("{}\n(", labels.size());
      for (const Part& patch : mesh_.parts(Part::Origin::kPatch))
        if (labels.contains(patch.number)) put_face_zone(out, name(patch), labels[patch.number]);
      out << ")\n";
    });
  }

  FoamFiles files_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::optional<std::vector<FoamFace>> mixed_;  ///< of a mesh with wedges and pyramids
  std::vector<HalfFace> across_;
  std::vector<std::string> names_;
};

}  // namespace

void write_openfoam(MeshOutput& out, const MeshParts& mesh) {
  OpenFoamWriter(out, mesh).write();
}

}  // namespace octafront::io
