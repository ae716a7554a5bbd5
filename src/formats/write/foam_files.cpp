#include "formats/write/foam_files.h"

#include "base/core/parallel.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <tuple>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Boundary layers stand on walls: wall functions and distances need to know.
bool is_wall(const MeshParts& mesh, const Part& patch) {
  const std::vector<std::uint32_t>& layers = mesh.mesh().face_layers;
  return !layers.empty() && std::ranges::any_of(patch.members, [&](std::uint32_t f) { return layers[f] != kNone; });
}

/// One face of one cell.
struct CellSide {
  std::array<VertexIndex, 4> key;
  std::uint64_t number;  ///< of the cell
  std::uint32_t cell;
  std::array<VertexIndex, 4> nodes;

  CellSide(std::uint64_t of_number, std::uint32_t of, const std::array<VertexIndex, 4>& corners)
      : key(corners), number(of_number), cell(of), nodes(corners) {
    std::sort(key.begin(), key.end());
    if (nodes[2] != nodes[3]) return;
    // Equal keys for equal triangles, whichever corner is repeated.
    std::unique(key.begin(), key.end());
    key[3] = kNone;
  }
};

}  // namespace

void FoamFiles::file(const std::string& name, std::string_view type,
                     const std::function<void(TextWriter&)>& write) const {
  AtomicFile target(folder / name, context);
  TextWriter out(target);
  out.line(
      "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {};\n    location    "
      "\"{}\";\n    object      {};\n}}\n",
      type, location, name);
  write(out);
  target.commit();
}

void FoamFiles::list(const std::string& name, std::string_view type, std::size_t count,
                     const std::function<void(TextWriter&)>& write) const {
  file(name, type, [&](TextWriter& out) {
    out << std::uint64_t{count} << "\n(\n";
    write(out);
    out << ")\n";
  });
}

void FoamFiles::points(std::size_t count, const std::function<Vec3(std::size_t)>& place_of) const {
  list("points", "vectorField", count, [&](TextWriter& out) {
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = place_of(i) * metres;
      out << '(' << p.x << ' ' << p.y << ' ' << p.z << ")\n";
    }
  });
}

void put_cell_zone(TextWriter& out, const std::string& name, std::span<const std::uint32_t> cells) {
  out.line("{}\n{{\n    type cellZone;\n    cellLabels List<label> {}\n(", name, cells.size());
  for (const std::uint32_t c : cells) out << c << '\n';
  out << ")\n;\n}\n";
}

void put_face_zone(TextWriter& out, const std::string& name, std::span<const FoamZoneFace> faces) {
  out.line("{}\n{{\n    type faceZone;\n    faceLabels List<label> {}\n(", name, faces.size());
  for (const FoamZoneFace& f : faces) out << std::uint64_t{f.label} << '\n';
  out.line(")\n;\n    flipMap List<bool> {}\n(", faces.size());
  for (const FoamZoneFace& f : faces) out << (f.is_flipped ? "1\n" : "0\n");
  out << ")\n;\n}\n";
}

/// A cell may be in one zone only: sets are none.
void put_cell_zones(const FoamFiles& files, const MeshParts& mesh, std::span<const std::string> names,
                    std::map<std::uint32_t, std::vector<std::uint32_t>>& cells_of_region) {
  const auto regions = mesh.parts(Part::Origin::kRegion);
  files.file("cellZones", "regIOobject", [&](TextWriter& out) {
    out.line("{}\n(", regions.size());
    for (const Part& region : regions)
      put_cell_zone(out, names[static_cast<std::size_t>(&region - mesh.parts().data())],
                    cells_of_region[region.number]);
    out << ")\n";
  });
}

void put_face_zones(const FoamFiles& files, const MeshParts& mesh, std::span<const std::string> names,
                    std::map<std::uint32_t, std::vector<FoamZoneFace>>& faces_of_patch) {
  std::vector<const Part*> inside;
  for (const Part& patch : mesh.parts(Part::Origin::kPatch))
    if (patch.members.back() >= mesh.mesh().boundary.size()) inside.push_back(&patch);
  files.file("faceZones", "regIOobject", [&](TextWriter& out) {
    out.line("{}\n(", inside.size());
    for (const Part* patch : inside) {
      std::ranges::stable_sort(faces_of_patch[patch->number], {}, &FoamZoneFace::label_in_whole);
      put_face_zone(out, names[static_cast<std::size_t>(patch - mesh.parts().data())], faces_of_patch[patch->number]);
    }
    out << ")\n";
  });
}

void put_patch(TextWriter& out, const std::string& name, const MeshParts& mesh, const Part& patch, std::size_t faces,
               std::size_t first, bool is_case) {
  const std::string original = name == patch.name ? "" : fmt::format(" // \"{}\"", one_line(patch.name));
  out.line("    {}\n    {{\n        type {};{}\n        nFaces {};\n        startFace {};\n    }}", name,
           is_case                ? foam_type_of(name)
           : is_wall(mesh, patch) ? "wall"
                                  : "patch",
           original, faces, first);
}

InterfacePatches::InterfacePatches(const MeshParts& mesh) : is_listed_(mesh.mesh().points.size(), false) {
  for (std::size_t f = mesh.mesh().boundary.size(); f < mesh.faces(); ++f) {
    patch_at_[face_key(mesh.face(f))] = mesh.patch_of(f);
    for (const VertexIndex v : mesh.face(f)) is_listed_[v] = true;
  }
}

std::uint32_t InterfacePatches::of(std::span<const VertexIndex> corners) const {
  if (!std::ranges::all_of(corners, [&](VertexIndex v) { return is_listed_[v]; })) return kNone;
  // Of a quadrilateral one of the two diagonals is that of its triangles.
  for (std::size_t skipped = corners.size() - 3 + 1; skipped-- > 0;) {
    const Triangle t{corners[skipped], corners[(skipped + 1) % corners.size()],
                     corners[(skipped + 2) % corners.size()]};
    if (const auto at = patch_at_.find(face_key(t)); at != patch_at_.end()) return at->second;
  }
  return kNone;
}

std::vector<FoamFace> faces_between(const MixedCells& cells, std::span<const std::uint64_t> number) {
  std::vector<CellSide> sides;
  CellRoom room;
  for (std::uint32_t c = 0; c < cells.cells(); ++c) {
    const auto nodes = cells.nodes(c, room);
    const std::uint64_t of_number = number.empty() ? c : number[c];
    if (cells.kind(c) == MixedCells::kTet)
      for (const auto& [i, j, k] : kTetFaces)
        sides.emplace_back(of_number, c,
                           std::array{nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)],
                                      nodes[static_cast<std::size_t>(k)], nodes[static_cast<std::size_t>(k)]});
    else
      for (const auto& [i, j, k, l] : cells.kind(c) == MixedCells::kWedge ? kWedgeFaces : kPyramidFaces)
        sides.emplace_back(of_number, c, std::array{nodes[i], nodes[j], nodes[k], nodes[l]});
  }
  parallel_sort(sides, [](const CellSide& a, const CellSide& b) {
    return std::tie(a.key, a.number) < std::tie(b.key, b.number);
  });
  struct Numbered {
    std::uint64_t owner, neighbour;
    FoamFace face;
  };
  std::vector<Numbered> between;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i)
    if (sides[i].key == sides[i + 1].key)
      between.push_back({sides[i].number, sides[i + 1].number, {sides[i].nodes, sides[i].cell, sides[i + 1].cell}});
  std::vector<CellSide>().swap(sides);
  // Two cells may touch in two faces: then their corners tell.
  parallel_sort(between, [](const Numbered& a, const Numbered& b) {
    return std::tie(a.owner, a.neighbour, a.face.nodes) < std::tie(b.owner, b.neighbour, b.face.nodes);
  });
  std::vector<FoamFace> faces;
  faces.reserve(between.size());
  for (const Numbered& n : between) faces.push_back(n.face);
  return faces;
}

}  // namespace octafront::io
