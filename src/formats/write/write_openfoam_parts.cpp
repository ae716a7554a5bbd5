// OpenFOAM's decomposed case, as decomposePar writes it: processor0/constant/polyMesh and so on, each with the cells of
// its part. All patches are in all of them, in one order; behind them a patch procBoundary0to1 for each neighbour,
// whose faces stand in the order of the whole mesh, on either side the other way round. cellProcAddressing and the like
// name the numbers in the polyMesh of the whole.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "base/mesh/adjacency.h"
#include "formats/write/foam_files.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/core.h>

namespace octafront::io {
namespace {

namespace fs = std::filesystem;

/// The case that a mesh belongs to: of CASE/constant/polyMesh and of CASE/polyMesh.
fs::path case_of(const fs::path& target) {
  const fs::path folder = target.parent_path();
  return folder.filename() == "constant" ? folder.parent_path() : folder;
}

/// The numbers that faces have in the polyMesh of the whole.
class FaceLabels {
 public:
  explicit FaceLabels(const Pieces& pieces) : cells_(pieces.cells()) {
    const MeshParts& mesh = pieces.whole();
    if (!mesh.wide_cells().empty()) {
      mixed_ = faces_between(cells_);
      inner_ = mixed_->size();
    } else {
      across_ = half_face_neighbors(mesh.mesh().tets, mesh.mesh().points.size());
      first_.resize(mesh.tets());
      parallel_for(mesh.tets(), [&](std::size_t t) {
        for (HalfFace h = 4 * static_cast<HalfFace>(t); h < 4 * t + 4; ++h)
          first_[t] += across_[h] != kNone && across_[h] / 4 > t;
      });
      for (std::uint64_t& first : first_) {
        const std::uint64_t count = first;
        first = inner_;
        inner_ += count;
      }
    }
    of_boundary_.assign(cells_.faces(), 0);
    for (const Part& patch : mesh.parts(Part::Origin::kPatch)) {
      std::uint64_t& of_patch = sizes_[patch.number];
      for (const std::uint32_t f : cells_.members(patch))
        if (cells_.first_face(f) < mesh.mesh().boundary.size()) of_boundary_[f] = inner_ + outer_ + of_patch++;
      outer_ += of_patch;
    }
  }

  /// Of the face between two cells, the lower one first.
  std::uint64_t between(std::uint64_t owner, std::uint64_t neighbour) const {
    if (mixed_)
      return static_cast<std::uint64_t>(
          std::lower_bound(mixed_->begin(), mixed_->end(), std::pair(owner, neighbour),
                           [](const FoamFace& f, const std::pair<std::uint64_t, std::uint64_t>& cells) {
                             return std::pair<std::uint64_t, std::uint64_t>(f.owner, f.neighbour) < cells;
                           }) -
          mixed_->begin());
    std::uint64_t label = first_[owner];
    for (HalfFace h = 4 * static_cast<HalfFace>(owner); h < 4 * owner + 4; ++h)
      label += across_[h] != kNone && across_[h] / 4 > owner && across_[h] / 4 < neighbour;
    return label;
  }
  /// Of a face of the boundary, by MixedCells.
  std::uint64_t of_boundary(std::uint64_t face) const { return of_boundary_[face]; }
  /// Faces of the boundary in a patch.
  std::uint64_t size_of(const Part& patch) const { return sizes_.at(patch.number); }

 private:
  const MixedCells& cells_;
  std::optional<std::vector<FoamFace>> mixed_;
  std::vector<HalfFace> across_;
  std::vector<std::uint64_t> first_, of_boundary_;
  std::map<std::uint32_t, std::uint64_t> sizes_;
  std::uint64_t inner_ = 0, outer_ = 0;
};

/// What all pieces share.
struct FoamWhole {
  const Pieces& pieces;
  FaceLabels labels;
  std::vector<std::string> names;  ///< of MeshParts::parts()

  const std::string& name(const Part& part) const {
    return names[static_cast<std::size_t>(&part - pieces.whole().parts().data())];
  }
};

class FoamPiece {
 public:
  FoamPiece(const FoamWhole& whole, const Piece& piece, FoamFiles files)
      : whole_(whole), piece_(piece), files_(std::move(files)), mesh_(piece.mesh), cells_(mesh_), interfaces_(mesh_) {
    number_cells();
    number_points();
    for (const FoamFace& face : mesh_.wide_cells().empty() ? faces_of_tets() : faces_between(cells_, global_))
      add_between(face);
    inner_ = faces_.size();
    add_patches();
    for (const auto& [part, faces] : of_neighbours_) faces_.insert(faces_.end(), faces.begin(), faces.end());
  }

  void write() const {
    write_points();
    files_.file("faces", "faceList", [&](TextWriter& out) {
      for_each(out, faces_.size(), [&](std::size_t f) {
        const auto nodes = faces_[f].corners();
        out << std::uint64_t{nodes.size()};
        for (std::size_t i = 0; i < nodes.size(); ++i) out << (i == 0 ? '(' : ' ') << own_point_[nodes[i]];
        out << ")\n";
      });
    });
    labels("owner", "labelList", faces_.size(), [&](std::size_t f) { return faces_[f].owner; });
    labels("neighbour", "labelList", inner_, [&](std::size_t f) { return faces_[f].neighbour; });
    write_boundary();
    write_zones();
    labels("pointProcAddressing", "labelList", points_.size(),
           [&](std::size_t v) { return piece_.point_ids[points_[v]]; });
    labels("cellProcAddressing", "labelList", own_.size(), [&](std::size_t c) { return global_[own_[c]]; });
    // Counted from 1, negative where the face is turned.
    labels("faceProcAddressing", "labelList", faces_.size(), [&](std::size_t f) {
      const auto label = static_cast<std::int64_t>(faces_[f].label) + 1;
      return faces_[f].is_turned ? -label : label;
    });
    const std::size_t patches = patches_.size();
    labels("boundaryProcAddressing", "labelList", patches + of_neighbours_.size(),
           [&](std::size_t p) { return p < patches ? static_cast<std::int64_t>(p) : -1; });
  }

 private:
  struct Face : FoamFace {
    std::uint64_t label;
    bool is_turned;
  };

  void number_cells() {
    global_.resize(cells_.cells());
    number_.assign(cells_.cells(), kNone);
    for (std::uint32_t c = 0; c < cells_.cells(); ++c) {
      const TetIndex t = cells_.first_tet(c);
      global_[c] = piece_.cell_ids[t];
      if (t >= piece_.own_tets) continue;
      number_[c] = static_cast<std::uint32_t>(own_.size());
      own_.push_back(c);
    }
  }

  /// Ghosts have points that no own cell has.
  void number_points() {
    own_point_.assign(mesh_.points(), kNone);
    for (std::size_t t = 0; t < piece_.own_tets; ++t)
      for (const VertexIndex v : mesh_.mesh().tets[t]) own_point_[v] = 0;
    for (VertexIndex v = 0; v < own_point_.size(); ++v) {
      if (own_point_[v] == kNone) continue;
      own_point_[v] = static_cast<VertexIndex>(points_.size());
      points_.push_back(v);
    }
  }

  /// As faces_between(), of own tetrahedra with others.
  std::vector<FoamFace> faces_of_tets() const {
    const std::vector<Tet>& tets = mesh_.mesh().tets;
    const std::vector<HalfFace> across = half_face_neighbors(tets, mesh_.points());
    std::vector<FoamFace> faces;
    for (HalfFace h = 0; h < 4 * piece_.own_tets; ++h) {
      if (across[h] == kNone) continue;
      const TetIndex here = h / 4, there = across[h] / 4;
      const bool is_owner = global_[here] < global_[there];
      if (!is_owner && there < piece_.own_tets) continue;
      const auto& [a, b, c] = corners_of(tets, is_owner ? h : across[h]);
      faces.push_back({{a, b, c, c}, is_owner ? here : there, is_owner ? there : here});
    }
    parallel_sort(faces, [&](const FoamFace& a, const FoamFace& b) {
      return std::tuple(global_[a.owner], global_[a.neighbour], a.nodes) <
             std::tuple(global_[b.owner], global_[b.neighbour], b.nodes);
    });
    return faces;
  }

  void add_between(const FoamFace& between) {
    const std::uint32_t owner = number_[between.owner], neighbour = number_[between.neighbour];
    if (owner == kNone && neighbour == kNone) return;
    Face face{between, whole_.labels.between(global_[between.owner], global_[between.neighbour]), owner == kNone};
    face.owner = owner == kNone ? neighbour : owner;
    face.neighbour = owner == kNone ? kNone : neighbour;
    const std::uint32_t patch = interfaces_.of(between.corners());
    if (owner != kNone && neighbour != kNone) {
      if (patch != kNone) zones_[patch].emplace_back(kNone, faces_.size());
      return faces_.push_back(face);
    }
    // The first corner stays the first one: so OpenFOAM finds the same points on both sides.
    if (face.is_turned) std::reverse(face.nodes.begin() + 1, face.nodes.begin() + (between.is_triangle() ? 3 : 4));
    if (between.is_triangle()) face.nodes[3] = face.nodes[2];
    const std::uint32_t ghost = cells_.first_tet(owner == kNone ? between.owner : between.neighbour);
    const std::uint32_t part = piece_.tet_part[ghost];
    if (patch != kNone) zones_[patch].emplace_back(part, of_neighbours_[part].size());
    of_neighbours_[part].push_back(face);
  }

  void add_patches() {
    const MeshParts& all = whole_.pieces.whole();
    std::map<std::uint32_t, std::vector<std::uint32_t>> faces_of;
    for (std::uint32_t f = 0; f < cells_.faces(); ++f) {
      const std::size_t first = cells_.first_face(f);
      if (first < mesh_.mesh().boundary.size() && mesh_.sides()[first].tet < piece_.own_tets)
        faces_of[mesh_.patch_of(first)].push_back(f);
    }
    std::array<VertexIndex, 8> room;
    for (const Part& patch : all.parts(Part::Origin::kPatch)) {
      if (whole_.labels.size_of(patch) == 0) continue;
      patches_.push_back({&patch, faces_of[patch.number].size()});
      for (const std::uint32_t f : faces_of[patch.number]) {
        const std::size_t first = cells_.first_face(f);
        const auto nodes = cells_.face_nodes(f, room);
        const bool is_triangle = f < cells_.triangles();
        const auto cell = static_cast<std::uint32_t>(cells_.cell_of(mesh_.sides()[first].tet));
        faces_.push_back({{{nodes[0], nodes[1], nodes[2], nodes[is_triangle ? 2 : 3]}, number_[cell], kNone},
                          whole_.labels.of_boundary(piece_.face_ids[first]),
                          false});
      }
    }
  }

  template <class Put>
  static void for_each(TextWriter& out, std::size_t count, const Put& put) {
    out << std::uint64_t{count} << "\n(\n";
    for (std::size_t i = 0; i < count; ++i) put(i);
    out << ")\n";
  }
  template <class ValueAt>
  void labels(const std::string& name, std::string_view type, std::size_t count, const ValueAt& value_at) const {
    files_.file(name, type,
                [&](TextWriter& out) { for_each(out, count, [&](std::size_t i) { out << value_at(i) << '\n'; }); });
  }

  void write_points() const {
    files_.file("points", "vectorField", [&](TextWriter& out) {
      for_each(out, points_.size(), [&](std::size_t v) {
        const Vec3 p = mesh_.mesh().points[points_[v]];
        out << '(' << p.x << ' ' << p.y << ' ' << p.z << ")\n";
      });
    });
  }

  void write_boundary() const {
    files_.file("boundary", "polyBoundaryMesh", [&](TextWriter& out) {
      out.line("{}\n(", patches_.size() + of_neighbours_.size());
      std::size_t first = inner_;
      for (const auto& [patch, size] : patches_) {
        put_patch(out, whole_.name(*patch), whole_.pieces.whole(), *patch, size, first);
        first += size;
      }
      for (const auto& [part, faces] : of_neighbours_) {
        out.line(
            "    procBoundary{0}to{1}\n    {{\n        type processor;\n        inGroups 1(processor);\n"
            "        nFaces {2};\n        startFace {3};\n        matchTolerance 0.0001;\n        transform unknown;\n"
            "        myProcNo {0};\n        neighbProcNo {1};\n    }}",
            piece_.number, part, faces.size(), first);
        first += faces.size();
      }
      out << ")\n";
    });
  }

  /// Zones are in all processors, empty or not.
  void write_zones() const {
    const MeshParts& all = whole_.pieces.whole();
    const auto regions = all.parts(Part::Origin::kRegion);
    files_.file("cellZones", "regIOobject", [&](TextWriter& out) {
      out.line("{}\n(", regions.size());
      for (const Part& region : regions) {
        std::vector<std::uint32_t> cells;
        for (std::uint32_t c = 0; c < own_.size(); ++c)
          if (mesh_.region_of(cells_.first_tet(own_[c])) == region.number) cells.push_back(c);
        put_cell_zone(out, whole_.name(region), cells);
      }
      out << ")\n";
    });
    if (all.mesh().interfaces.empty() || all.faces() == 0) return;
    std::vector<const Part*> inside;
    for (const Part& patch : all.parts(Part::Origin::kPatch))
      if (patch.members.back() >= all.mesh().boundary.size()) inside.push_back(&patch);
    files_.file("faceZones", "regIOobject", [&](TextWriter& out) {
      out.line("{}\n(", inside.size());
      for (const Part* patch : inside) put_face_zone(out, whole_.name(*patch), zone_faces(*patch));
      out << ")\n";
    });
  }

  std::vector<FoamZoneFace> zone_faces(const Part& patch) const {
    std::map<std::uint32_t, std::size_t> first_of;
    std::size_t first = faces_.size();
    for (auto at = of_neighbours_.rbegin(); at != of_neighbours_.rend(); ++at)
      first_of[at->first] = first -= at->second.size();
    std::vector<FoamZoneFace> zone;
    const auto at = zones_.find(patch.number);
    if (at == zones_.end()) return zone;
    for (const auto& [part, place] : at->second) {
      const std::size_t label = part == kNone ? place : first_of[part] + place;
      zone.push_back({label, faces_[label].is_turned});
    }
    return zone;
  }

  const FoamWhole& whole_;
  const Piece& piece_;
  FoamFiles files_;
  MeshParts mesh_;
  MixedCells cells_;
  InterfacePatches interfaces_;
  std::vector<std::uint64_t> global_;            ///< per cell of the piece, ghosts too
  std::vector<std::uint32_t> own_, number_;      ///< cells that are its own; per cell its place among them
  std::vector<VertexIndex> points_, own_point_;  ///< the same of points
  std::vector<Face> faces_;                      ///< inner ones, those of patches, those of neighbours
  std::map<std::uint32_t, std::vector<Face>> of_neighbours_;
  std::size_t inner_ = 0;
  struct PatchSize {
    const Part* patch;
    std::size_t size;
  };
  std::vector<PatchSize> patches_;
  /// Per patch inside: {neighbour or kNone, place among its faces or the inner ones}.
  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::size_t>>> zones_;
};

}  // namespace

void write_openfoam_parts(MeshOutput& out, Pieces& pieces) {
  const FoamWhole whole{
      pieces, FaceLabels(pieces),
      legal_names(out, pieces.whole(), {.also = "_-."}, std::array{Part::Origin::kRegion, Part::Origin::kPatch})};
  for (std::uint32_t k = 0; k < pieces.count(); ++k) {
    const fs::path folder = case_of(out.target()) / fmt::format("processor{}", k) / "constant" / "polyMesh";
    const Piece piece = pieces.piece(k);
    FoamPiece(whole, piece, {out.folder(folder), "constant/polyMesh", out.context()}).write();
  }
}

void check_openfoam_parts(const fs::path& target, std::uint32_t parts) {
  const fs::path of_case = case_of(target);
  check_writable(of_case / "processor0-");
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(of_case.empty() ? fs::path(".") : of_case, error)) {
    constexpr std::string_view kName = "processor";
    const std::string name = entry.path().filename().string();
    std::uint32_t number = 0;
    const char* const end = name.data() + name.size();
    if (!name.starts_with(kName) || std::from_chars(name.data() + kName.size(), end, number).ptr != end ||
        name.size() == kName.size())
      continue;
    if (number >= parts)
      throw OutputError(fmt::format("{}: is of an earlier division into more than {} parts; remove it first",
                                    entry.path().string(), parts));
    if (fs::exists(entry.path() / "constant" / "polyMesh", error))
      check_folder_writable(entry.path() / "constant" / "polyMesh");
  }
}

}  // namespace octafront::io
