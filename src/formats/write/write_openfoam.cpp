// OpenFOAM polyMesh folder, text: points, faces, owner, neighbour, boundary, and zones. Faces between two cells come
// first, in the order of the lower cell and then of the upper one, then those of each patch. Regions are cellZones,
// interfaces faceZones.

#include <octafront/error.h>

#include "base/mesh/adjacency.h"
#include "formats/containers/text_writer.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace octafront::io {
namespace {

class OpenFoamWriter {
 public:
  OpenFoamWriter(MeshOutput& out, const MeshParts& mesh)
      : folder_(out.folder()),
        context_(out.context()),
        mesh_(mesh),
        across_(half_face_neighbors(mesh.mesh().tets, mesh.mesh().points.size())),
        names_(legal_names(out, mesh, {.also = "_-."}, std::array{Part::Origin::kRegion, Part::Origin::kPatch})) {
    for (std::size_t f = 0; f < mesh.faces(); ++f)
      if (f >= mesh.mesh().boundary.size()) interface_at_[half_face(f)] = f;
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
    list("faces", "faceList", all_faces(), [&](TextWriter& out, HalfFace h, HalfFace) {
      const auto& [a, b, c] = face_of(mesh_.mesh().tets[h / 4], static_cast<int>(h % 4));
      out << "3(" << a << ' ' << b << ' ' << c << ")\n";
    });
    list("owner", "labelList", all_faces(), [](TextWriter& out, HalfFace h, HalfFace) { out << h / 4 << '\n'; });
    list("neighbour", "labelList", inner_faces(), [](TextWriter& out, HalfFace, HalfFace other) {
      if (other != kNone) out << other / 4 << '\n';
    });
    write_boundary();
    write_cell_zones();
    write_face_zones();
  }

 private:
  using Put = std::function<void(TextWriter&, HalfFace, HalfFace)>;

  HalfFace half_face(std::size_t f) const {
    return 4 * mesh_.sides()[f].tet + static_cast<HalfFace>(mesh_.sides()[f].face);
  }
  std::size_t inner_faces() const { return (4 * mesh_.tets() - mesh_.mesh().boundary.size()) / 2; }
  std::size_t all_faces() const { return inner_faces() + mesh_.mesh().boundary.size(); }

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
      for_each_face([&](HalfFace h, HalfFace other) { put(out, h, other); });
      out << ")\n";
    });
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

  std::size_t outside(const Part& patch) const {
    return static_cast<std::size_t>(
        std::lower_bound(patch.members.begin(), patch.members.end(), mesh_.mesh().boundary.size()) -
        patch.members.begin());
  }

  void write_boundary() {
    file("boundary", "polyBoundaryMesh", [&](TextWriter& out) {
      const auto patches = mesh_.parts(Part::Origin::kPatch);
      out.line("{}\n(", std::count_if(patches.begin(), patches.end(), [&](const Part& p) { return outside(p) > 0; }));
      std::size_t first = inner_faces();
      for (const Part& patch : patches) {
        if (outside(patch) == 0) continue;
        out.line("    {}\n    {{\n        type patch;{}\n        nFaces {};\n        startFace {};\n    }}",
                 name(patch), original(patch), outside(patch), first);
        first += outside(patch);
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
        if (is_zone(part)) zone(out, name(part), "cell", part.members);
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
  std::vector<HalfFace> across_;
  std::vector<std::string> names_;
  std::map<HalfFace, std::size_t> interface_at_;
};

}  // namespace

void write_openfoam(MeshOutput& out, const MeshParts& mesh) {
  OpenFoamWriter(out, mesh).write();
}

}  // namespace octafront::io
