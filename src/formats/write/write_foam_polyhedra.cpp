// The polyMesh folder of write_openfoam.cpp, of polyhedra.

#include "formats/write/foam_files.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace octafront::io {
namespace {

void write_boundary(const FoamFiles& files, const MeshParts& parts, std::span<const std::string> names,
                    const PolyMesh& mesh) {
  struct Stretch {
    const Part* patch;
    std::size_t first, faces;
  };
  std::vector<Stretch> stretches;
  for (const Part& patch : parts.parts(Part::Origin::kPatch)) {
    const auto [begin, end] = std::equal_range(mesh.patch.begin() + static_cast<std::ptrdiff_t>(mesh.inner_faces()),
                                               mesh.patch.end(), patch.number);
    if (begin != end)
      stretches.push_back(
          {&patch, static_cast<std::size_t>(begin - mesh.patch.begin()), static_cast<std::size_t>(end - begin)});
  }
  files.file("boundary", "polyBoundaryMesh", [&](TextWriter& out) {
    out.line("{}\n(", stretches.size());
    for (const Stretch& s : stretches)
      put_patch(out, names[static_cast<std::size_t>(s.patch - parts.parts().data())], parts, *s.patch, s.faces, s.first,
                files.is_case);
    out << ")\n";
  });
}

}  // namespace

void write_openfoam_polyhedra(MeshOutput& out, const MeshParts& parts, const PolyMesh& mesh) {
  const FoamFiles files{out.folder(), kFoamLocation, out.context(), out.options().deck, metres_of_case(out.options())};
  const std::vector<std::string> names =
      legal_names(out, parts, kFoamNames, std::array{Part::Origin::kRegion, Part::Origin::kPatch});
  files.points(mesh.points.size(), [&](std::size_t p) { return mesh.points[p]; });
  files.faces(mesh.faces(), mesh.inner_faces(), [&](const auto& visit) {
    for (std::size_t f = 0; f < mesh.faces(); ++f)
      visit(mesh.face(f), mesh.owner[f], f < mesh.inner_faces() ? mesh.neighbour[f] : kNone);
  });
  write_boundary(files, parts, names, mesh);
  write_foam_case(out, parts, names);
  std::map<std::uint32_t, std::vector<std::uint32_t>> cells;
  for (std::uint32_t c = 0; c < mesh.cells(); ++c) cells[mesh.region[c]].push_back(c);
  put_cell_zones(files, parts, names, cells);
  if (parts.mesh().interfaces.empty()) return;
  std::map<std::uint32_t, std::vector<FoamZoneFace>> zones;
  for (std::size_t f = 0; f < mesh.inner_faces(); ++f)
    if (mesh.patch[f] != kNone) zones[mesh.patch[f]].push_back({f, false, f});
  put_face_zones(files, parts, names, zones);
}

}  // namespace octafront::io
