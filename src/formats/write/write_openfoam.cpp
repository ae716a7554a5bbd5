// OpenFOAM polyMesh folder, text: points, faces, owner, neighbour, boundary, and zones. Faces between two cells come
// first, in the order of the lower cell and then of the upper one, then those of each patch. Regions are cellZones,
// interfaces faceZones.
//
// In parts a decomposed case, as decomposePar writes it: processor0/constant/polyMesh and so on, each with the cells of
// its part. All patches and zones are in all of them, in one order; behind them a patch procBoundary0to1 for each
// neighbour, whose faces stand in the order of the whole mesh, on either side the other way round. cellProcAddressing
// and the like name the numbers in the polyMesh of the whole.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "base/mesh/adjacency.h"
#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/foam_files.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/core.h>

namespace octafront::io {
namespace {

namespace fs = std::filesystem;

/// The faces of the polyMesh of the whole, in its order. They are gone over again rather than kept.
class WholeFaces {
 public:
  WholeFaces(const MeshParts& mesh, const MixedCells& cells) : mesh_(mesh), cells_(cells) {
    const std::vector<Tet>& tets = mesh.mesh().tets;
    if (!mesh.wide_cells().empty())
      mixed_ = faces_between(cells);
    else
      across_ = half_face_neighbors(tets, mesh.mesh().points.size());
    inner_ = mixed_ ? mixed_->size() : (4 * mesh.tets() - mesh.mesh().boundary.size()) / 2;
  }

  /// How many lie between two cells.
  std::size_t inner() const { return inner_; }
  /// Those of a patch that belong to the boundary.
  std::vector<std::uint32_t> outside(const Part& patch) const {
    std::vector<std::uint32_t> faces = cells_.members(patch);
    std::erase_if(faces, [&](std::uint32_t f) { return cells_.first_face(f) >= mesh_.mesh().boundary.size(); });
    return faces;
  }

  template <class Visit>
  void for_each(const Visit& visit) const {
    if (mixed_) std::ranges::for_each(*mixed_, visit);
    for (TetIndex t = 0; t < mesh_.tets() && !mixed_; ++t) {
      std::array<std::pair<HalfFace, HalfFace>, 4> faces;
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) faces[h % 4] = {across_[h], h};
      std::sort(faces.begin(), faces.end());
      for (const auto& [other, own] : faces)
        if (other != kNone && other / 4 > t) visit(of_tet(own, other / 4));
    }
    FaceRoom room;
    for (const Part& patch : mesh_.parts(Part::Origin::kPatch))
      for (const std::uint32_t f : outside(patch)) {
        const Side& side = mesh_.sides()[cells_.first_face(f)];
        visit(mixed_ ? face_of_boundary(cells_, f, static_cast<std::uint32_t>(cells_.cell_of(side.tet)), room)
                     : of_tet(4 * side.tet + static_cast<HalfFace>(side.face), kNone));
      }
  }

  /// A face of the boundary of some mesh.
  static FoamFace face_of_boundary(const MixedCells& cells, std::uint32_t f, std::uint32_t owner, FaceRoom& room) {
    const auto nodes = cells.face_nodes(f, room);
    return {{nodes[0], nodes[1], nodes[2], nodes[f < cells.triangles() ? 2 : 3]}, owner, kNone};
  }

  /// Makes the numbers that pieces ask for.
  void number() {
    of_boundary_.assign(cells_.faces(), 0);
    std::uint64_t last = inner_;
    for (const Part& patch : mesh_.parts(Part::Origin::kPatch))
      for (const std::uint32_t f : outside(patch)) of_boundary_[f] = last++;
    if (mixed_) return;
    first_.resize(mesh_.tets());
    parallel_for(mesh_.tets(), [&](std::size_t t) {
      for (HalfFace h = 4 * static_cast<HalfFace>(t); h < 4 * t + 4; ++h)
        first_[t] += across_[h] != kNone && across_[h] / 4 > t;
    });
    std::uint64_t before = 0;
    for (std::uint64_t& first : first_) before += std::exchange(first, before);
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

 private:
  FoamFace of_tet(HalfFace h, std::uint32_t neighbour) const {
    const auto& [a, b, c] = corners_of(mesh_.mesh().tets, h);
    return {{a, b, c, c}, h / 4, neighbour};
  }

  const MeshParts& mesh_;
  const MixedCells& cells_;
  std::optional<std::vector<FoamFace>> mixed_;  ///< of a mesh with wedges and pyramids
  std::vector<HalfFace> across_;
  std::size_t inner_;
  std::vector<std::uint64_t> first_, of_boundary_;
};

/// What all pieces share.
struct FoamWhole {
  FoamWhole(MeshOutput& out, const MeshParts& of, const MixedCells& mixed)
      : mesh(of),
        cells(mixed),
        faces(of, mixed),
        names(legal_names(out, of, kFoamNames, std::array{Part::Origin::kRegion, Part::Origin::kPatch})) {
    for (const Part& patch : of.parts(Part::Origin::kPatch))
      if (const std::size_t size = faces.outside(patch).size(); size > 0) patches.push_back({&patch, size});
  }
  const std::string& name(const Part& part) const {
    return names[static_cast<std::size_t>(&part - mesh.parts().data())];
  }

  struct PatchSize {
    const Part* patch;
    std::size_t size;
  };

  const MeshParts& mesh;
  const MixedCells& cells;
  WholeFaces faces;
  std::vector<std::string> names;    ///< of MeshParts::parts()
  std::vector<PatchSize> patches{};  ///< of the boundary
};

/// One polyMesh: of the whole, or of a piece.
class FoamMesh {
 public:
  explicit FoamMesh(const FoamWhole& whole)
      : whole_(whole),
        piece_(nullptr),
        mesh_(whole.mesh),
        cells_(whole.cells),
        patches_(whole.patches),
        inner_(whole.faces.inner()) {}
  FoamMesh(const FoamWhole& whole, const Piece& piece)
      : whole_(whole),
        piece_(&piece),
        own_mesh_(std::in_place, piece.mesh),
        own_cells_(*own_mesh_),
        mesh_(*own_mesh_),
        cells_(*own_cells_) {
    number_cells();
    number_points();
    for (const FoamFace& face : mesh_.wide_cells().empty() ? faces_of_tets() : faces_between(cells_, global_))
      add_between(face);
    inner_ = faces_.size();
    add_patches();
    for (const auto& [part, faces] : of_neighbours_) faces_.insert(faces_.end(), faces.begin(), faces.end());
  }

  void write(const FoamFiles& files) const {
    files.points(piece_ == nullptr ? mesh_.points() : points_.size(),
                 [&](std::size_t v) { return mesh_.mesh().points[piece_ == nullptr ? v : points_[v]]; });
    files.faces(all_faces(), inner_, [&](const auto& visit) {
      std::array<VertexIndex, 4> own{};
      for_each_face([&](const Face& face) {
        const auto nodes = face.corners();
        for (std::size_t i = 0; i < nodes.size(); ++i) own[i] = piece_ == nullptr ? nodes[i] : own_point_[nodes[i]];
        visit(std::span(own).first(nodes.size()), face.owner, face.neighbour);
      });
    });
    write_boundary(files);
    write_cell_zones(files);
    write_face_zones(files);
    if (piece_ != nullptr) write_addressing(files);
  }

 private:
  struct Face : FoamFace {
    std::uint64_t label;  ///< in the whole
    bool is_turned;
  };

  std::size_t all_faces() const {
    std::size_t count = inner_;
    for (const auto& [patch, size] : patches_) count += size;
    for (const auto& [part, faces] : of_neighbours_) count += faces.size();
    return count;
  }

  /// Inner ones, those of patches, those of neighbours.
  template <class Visit>
  void for_each_face(const Visit& visit) const {
    if (piece_ != nullptr) return static_cast<void>(std::ranges::for_each(faces_, visit));
    std::uint64_t label = 0;
    whole_.faces.for_each([&](const FoamFace& face) { visit(Face{face, label++, false}); });
  }

  void number_cells() {
    global_.resize(cells_.cells());
    number_.assign(cells_.cells(), kNone);
    for (std::uint32_t c = 0; c < cells_.cells(); ++c) {
      const TetIndex t = cells_.first_tet(c);
      global_[c] = piece_->cell_ids[t];
      if (t >= piece_->own_tets) continue;
      number_[c] = static_cast<std::uint32_t>(own_.size());
      own_.push_back(c);
    }
  }

  /// Ghosts have points that no own cell has.
  void number_points() {
    own_point_.assign(mesh_.points(), kNone);
    for (std::size_t t = 0; t < piece_->own_tets; ++t)
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
    for (HalfFace h = 0; h < 4 * piece_->own_tets; ++h) {
      if (across[h] == kNone) continue;
      const TetIndex here = h / 4, there = across[h] / 4;
      const bool is_owner = global_[here] < global_[there];
      if (!is_owner && there < piece_->own_tets) continue;
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
    Face face{between, whole_.faces.between(global_[between.owner], global_[between.neighbour]), owner == kNone};
    face.owner = owner == kNone ? neighbour : owner;
    face.neighbour = owner == kNone ? kNone : neighbour;
    if (owner != kNone && neighbour != kNone) return faces_.push_back(face);
    // The first corner stays the first one: so OpenFOAM finds the same points on both sides.
    if (face.is_turned) std::reverse(face.nodes.begin() + 1, face.nodes.begin() + (between.is_triangle() ? 3 : 4));
    if (between.is_triangle()) face.nodes[3] = face.nodes[2];
    const std::uint32_t ghost = cells_.first_tet(owner == kNone ? between.owner : between.neighbour);
    of_neighbours_[piece_->tet_part[ghost]].push_back(face);
  }

  void add_patches() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> faces_of;
    for (std::uint32_t f = 0; f < cells_.faces(); ++f) {
      const std::size_t first = cells_.first_face(f);
      if (first < mesh_.mesh().boundary.size() && mesh_.sides()[first].tet < piece_->own_tets)
        faces_of[mesh_.patch_of(first)].push_back(f);
    }
    FaceRoom room;
    for (const auto& [patch, size] : whole_.patches) {
      patches_.push_back({patch, faces_of[patch->number].size()});
      for (const std::uint32_t f : faces_of[patch->number]) {
        const std::size_t first = cells_.first_face(f);
        const std::uint32_t owner = number_[cells_.cell_of(mesh_.sides()[first].tet)];
        faces_.push_back({WholeFaces::face_of_boundary(cells_, f, owner, room),
                          whole_.faces.of_boundary(piece_->face_ids[first]), false});
      }
    }
  }

  void write_boundary(const FoamFiles& files) const {
    files.file("boundary", "polyBoundaryMesh", [&](TextWriter& out) {
      out.line("{}\n(", patches_.size() + of_neighbours_.size());
      std::size_t first = inner_;
      for (const auto& [patch, size] : patches_) {
        put_patch(out, whole_.name(*patch), whole_.mesh, *patch, size, first, files.is_case);
        first += size;
      }
      for (const auto& [part, faces] : of_neighbours_) {
        out.line(
            "    procBoundary{0}to{1}\n    {{\n        type processor;\n        inGroups 1(processor);\n"
            "        nFaces {2};\n        startFace {3};\n        matchTolerance 0.0001;\n        transform unknown;\n"
            "        myProcNo {0};\n        neighbProcNo {1};\n    }}",
            piece_->number, part, faces.size(), first);
        first += faces.size();
      }
      out << ")\n";
    });
  }

  void write_cell_zones(const FoamFiles& files) const {
    std::map<std::uint32_t, std::vector<std::uint32_t>> cells;
    for (std::uint32_t c = 0, count = 0; c < cells_.cells(); ++c)
      if (piece_ == nullptr || number_[c] != kNone) cells[mesh_.region_of(cells_.first_tet(c))].push_back(count++);
    put_cell_zones(files, whole_.mesh, whole_.names, cells);
  }

  void write_face_zones(const FoamFiles& files) const {
    if (whole_.mesh.mesh().interfaces.empty()) return;
    const InterfacePatches interfaces(mesh_);
    std::map<std::uint32_t, std::vector<FoamZoneFace>> zones;
    std::size_t place = 0;
    for_each_face([&](const Face& face) {
      if (const std::uint32_t patch = interfaces.of(face.corners()); patch != kNone)
        zones[patch].push_back({place, face.is_turned, face.label});
      ++place;
    });
    put_face_zones(files, whole_.mesh, whole_.names, zones);
  }

  void write_addressing(const FoamFiles& files) const {
    const auto labels = [&](const char* name, std::size_t count, const auto& label_of) {
      files.list(name, "labelList", count, [&](TextWriter& out) {
        for (std::size_t i = 0; i < count; ++i) out << label_of(i) << '\n';
      });
    };
    labels("pointProcAddressing", points_.size(), [&](std::size_t v) { return piece_->point_ids[points_[v]]; });
    labels("cellProcAddressing", own_.size(), [&](std::size_t c) { return global_[own_[c]]; });
    // Counted from 1, negative where the face is turned.
    labels("faceProcAddressing", faces_.size(), [&](std::size_t f) {
      const auto label = static_cast<std::int64_t>(faces_[f].label) + 1;
      return faces_[f].is_turned ? -label : label;
    });
    const std::size_t patches = patches_.size();
    labels("boundaryProcAddressing", patches + of_neighbours_.size(),
           [&](std::size_t p) { return p < patches ? static_cast<std::int64_t>(p) : -1; });
  }

  const FoamWhole& whole_;
  const Piece* piece_;  ///< null: the whole mesh
  std::optional<MeshParts> own_mesh_;
  std::optional<MixedCells> own_cells_;
  const MeshParts& mesh_;
  const MixedCells& cells_;
  std::vector<FoamWhole::PatchSize> patches_;
  std::size_t inner_ = 0;
  // Of a piece.
  std::vector<std::uint64_t> global_;            ///< per cell of the piece, ghosts too
  std::vector<std::uint32_t> own_, number_;      ///< cells that are its own; per cell its place among them
  std::vector<VertexIndex> points_, own_point_;  ///< the same of points
  std::vector<Face> faces_;
  std::map<std::uint32_t, std::vector<Face>> of_neighbours_;
};

/// The case that a mesh belongs to: of CASE/constant/polyMesh and of CASE/polyMesh.
fs::path case_of(const fs::path& target) {
  const fs::path folder = target.parent_path();
  return folder.filename() == "constant" ? folder.parent_path() : folder;
}

}  // namespace

void write_openfoam(MeshOutput& out, const MeshParts& mesh) {
  const MixedCells cells(mesh);
  const FoamWhole whole(out, mesh, cells);
  FoamMesh(whole).write(
      {out.folder(), kFoamLocation, out.context(), out.options().deck, metres_of_case(out.options())});
  write_foam_case(out, mesh, whole.names);
}

void write_openfoam_parts(MeshOutput& out, Pieces& pieces) {
  FoamWhole whole(out, pieces.whole(), pieces.cells());
  whole.faces.number();
  for (std::uint32_t k = 0; k < pieces.count(); ++k) {
    const fs::path folder = case_of(out.target()) / fmt::format("processor{}", k) / kFoamLocation;
    const Piece piece = pieces.piece(k);
    FoamMesh(whole, piece).write({out.folder(folder), kFoamLocation, out.context()});
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
