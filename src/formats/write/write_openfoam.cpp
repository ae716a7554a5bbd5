// OpenFOAM polyMesh folder, text: points, faces, owner, neighbour, boundary, and zones. Faces between two cells come
// first, in the order of the lower cell and then of the upper one, then those of each patch. Regions are cellZones,
// interfaces faceZones.

#include <octafront/error.h>

#include "base/mesh/adjacency.h"
#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
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

/// The inner faces of a mesh with wedges and pyramids.
class MixedFaces {
 public:
  struct Face {
    std::array<VertexIndex, 4> nodes;  ///< outward of the owner; of a triangle the last one is repeated
    std::uint32_t owner, neighbour;
  };

  explicit MixedFaces(const MixedCells& cells) {
    struct Side {
      std::array<VertexIndex, 4> key;
      std::uint32_t cell;
      std::array<VertexIndex, 4> nodes;
    };
    std::vector<Side> sides;
    const auto add = [&](std::uint32_t cell, const std::array<VertexIndex, 4>& nodes) {
      sides.push_back({nodes, cell, nodes});
      std::sort(sides.back().key.begin(), sides.back().key.end());
      if (nodes[2] == nodes[3]) {  // equal keys for equal triangles, whichever corner is repeated
        auto& key = sides.back().key;
        std::unique(key.begin(), key.end());
        key[3] = kNone;
      }
    };
    std::array<VertexIndex, 15> room;
    for (std::uint32_t c = 0; c < cells.cells(); ++c) {
      const auto nodes = cells.nodes(c, room);
      if (cells.kind(c) == MixedCells::kTet)
        for (const auto& [i, j, k] : kTetFaces)
          add(c, {nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)],
                  nodes[static_cast<std::size_t>(k)], nodes[static_cast<std::size_t>(k)]});
      else
        for (const auto& [i, j, k, l] : cells.kind(c) == MixedCells::kWedge ? kWedgeFaces : kPyramidFaces)
          add(c, {nodes[i], nodes[j], nodes[k], nodes[l]});
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return std::tie(a.key, a.cell) < std::tie(b.key, b.cell); });
    for (std::size_t i = 0; i + 1 < sides.size(); ++i)
      if (sides[i].key == sides[i + 1].key) faces_.push_back({sides[i].nodes, sides[i].cell, sides[i + 1].cell});
    std::sort(faces_.begin(), faces_.end(), [](const Face& a, const Face& b) {
      return std::tie(a.owner, a.neighbour) < std::tie(b.owner, b.neighbour);
    });
  }

  const std::vector<Face>& inner() const { return faces_; }

 private:
  std::vector<Face> faces_;
};

class OpenFoamWriter {
 public:
  OpenFoamWriter(MeshOutput& out, const MeshParts& mesh)
      : folder_(out.folder()),
        context_(out.context()),
        mesh_(mesh),
        cells_(mesh),
        across_(half_face_neighbors(mesh.mesh().tets, mesh.mesh().points.size())),
        names_(legal_names(out, mesh, {.also = "_-."}, std::array{Part::Origin::kRegion, Part::Origin::kPatch})) {
    for (std::size_t f = 0; f < mesh.faces(); ++f)
      if (f >= mesh.mesh().boundary.size()) interface_at_[half_face(f)] = f;
    if (!mesh.wide_cells().empty()) mixed_.emplace(cells_);
  }

  void write() {
    file("points", "vectorField", [&](TextWriter& out) {
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
    return mixed_ ? mixed_->inner().size() : (4 * mesh_.tets() - mesh_.mesh().boundary.size()) / 2;
  }
  std::size_t all_faces() const { return inner_faces() + mesh_.mesh().boundary.size() - cells_.quads(); }

  void file(const std::string& name, std::string_view type, const std::function<void(TextWriter&)>& write) {
    AtomicFile target(folder_ / name, context_);
    TextWriter out(target);
    out.line(
        "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {};\n    location    "
        "\"constant/polyMesh\";\n    object      {};\n}}\n",
        type, name);
    write(out);
    target.commit();
  }

  void list(const std::string& name, std::string_view type, std::size_t count, const Put& put) {
    file(name, type, [&](TextWriter& out) {
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
    for (const MixedFaces::Face& face : mixed_->inner())
      put(out, std::span(face.nodes).first(face.nodes[2] == face.nodes[3] ? 3 : 4), face.owner, face.neighbour);
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

  /// Boundary layers stand on walls: wall functions and distances need to know.
  bool is_wall(const Part& patch) const {
    const std::vector<std::uint32_t>& layers = mesh_.mesh().face_layers;
    return !layers.empty() && std::ranges::any_of(patch.members, [&](std::uint32_t f) { return layers[f] != kNone; });
  }

  void write_boundary() {
    file("boundary", "polyBoundaryMesh", [&](TextWriter& out) {
      const auto patches = mesh_.parts(Part::Origin::kPatch);
      out.line("{}\n(",
               std::count_if(patches.begin(), patches.end(), [&](const Part& p) { return !outside(p).empty(); }));
      std::size_t first = inner_faces();
      for (const Part& patch : patches) {
        const std::size_t faces = outside(patch).size();
        if (faces == 0) continue;
        out.line("    {}\n    {{\n        type {};{}\n        nFaces {};\n        startFace {};\n    }}", name(patch),
                 is_wall(patch) ? "wall" : "patch", original(patch), faces, first);
        first += faces;
      }
      out << ")\n";
    });
  }

  const std::string& name(const Part& part) const {
    return names_[static_cast<std::size_t>(&part - mesh_.parts().data())];
  }
  std::string original(const Part& part) const {
    return name(part) == part.name ? "" : fmt::format(" // \"{}\"", one_line(part.name));
  }

  template <class Labels>
  void zone(TextWriter& out, const std::string& title, std::string_view kind, const Labels& labels) {
    out.line("{}\n{{\n    type {}Zone;\n    {}Labels List<label> {}\n(", title, kind, kind, labels.size());
    for (const auto label : labels) out << static_cast<std::uint64_t>(label) << '\n';
    out << ")\n;\n";
    if (kind == "face") {
      out.line("    flipMap List<bool> {}\n(", labels.size());
      for (std::size_t i = 0; i < labels.size(); ++i) out << "0\n";
      out << ")\n;\n";
    }
    out << "}\n";
  }

  void write_cell_zones() {
    file("cellZones", "regIOobject", [&](TextWriter& out) {
      const auto is_of_cells = [](const Part& p) { return p.kind == NamedSet::Kind::kElements; };
      const auto& parts = mesh_.parts();
      // A cell may be in one zone only.
      const auto is_zone = [&](const Part& p) { return is_of_cells(p) && p.origin == Part::Origin::kRegion; };
      out.line("{}\n(", std::count_if(parts.begin(), parts.end(), is_zone));
      for (const Part& part : parts)
        if (is_zone(part)) zone(out, name(part), "cell", cells_.members(part));
      out << ")\n";
    });
  }

  void write_face_zones() {
    if (interface_at_.empty()) return;
    std::map<std::uint32_t, std::vector<std::size_t>> labels;
    std::size_t label = 0;
    for_each_face([&](HalfFace h, HalfFace other) {
      for (const HalfFace side : {h, other})
        if (const auto at = interface_at_.find(side); at != interface_at_.end())
          labels[mesh_.patch_of(at->second)].push_back(label);
      ++label;
    });
    file("faceZones", "regIOobject", [&](TextWriter& out) {
      out.line("{}\n(", labels.size());
      for (const Part& patch : mesh_.parts(Part::Origin::kPatch))
        if (labels.contains(patch.number)) zone(out, name(patch), "face", labels[patch.number]);
      out << ")\n";
    });
  }

  std::filesystem::path folder_;
  RunContext context_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::optional<MixedFaces> mixed_;  ///< of a mesh with wedges and pyramids
  std::vector<HalfFace> across_;
  std::vector<std::string> names_;
  std::map<HalfFace, std::size_t> interface_at_;
};

}  // namespace

void write_openfoam(MeshOutput& out, const MeshParts& mesh) {
  OpenFoamWriter(out, mesh).write();
}

}  // namespace octafront::io
