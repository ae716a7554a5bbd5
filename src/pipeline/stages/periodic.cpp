#include "pipeline/stages/periodic.h"

#include <octafront/error.h>
#include <octafront/tet_mesh.h>

#include "base/core/wording.h"
#include "base/mesh/face_nodes.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/paired_nodes.h"
#include "pipeline/stages/stages.h"
#include "soup/periods/periods.h"
#include "soup/tidy/examine.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// The triangles that opposite faces have, their bounds and what else goes by triangle.
Domain with_surface(const Domain& domain, SurfaceMesh surface, const std::vector<std::uint32_t>& origin) {
  Domain made = domain;
  made.surface = std::move(surface);
  made.found_clean = 0;
  if (domain.bound.empty()) return made;
  made.bound.clear();
  for (const std::uint32_t t : origin) made.bound.push_back(domain.bound[t]);
  return made;
}

/// The domain with this surface, whose sources are triangles of the domain's.
Domain tidied(const Domain& domain, SurfaceMesh surface) {
  std::vector<std::uint32_t> origin;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) origin.push_back(surface.source_of(t));
  surface.source.clear();
  for (const std::uint32_t t : origin) surface.source.push_back(domain.surface.source_of(t));
  return with_surface(domain, std::move(surface), origin);
}

void tell(const MadePeriodic& made, const Stage& stage) {
  stage.count("triangles imprinted", static_cast<double>(made.imprinted));
  stage.count("vertices moved", static_cast<double>(made.moved));
  stage.count("largest move", made.largest_move);
  if (made.imprinted > 0)
    stage.note(
        made.cell.is_box()
            ? fmt::format("opposite faces carried different triangles: both got {} new ones, by the lines of both",
                          made.imprinted / 2)
            : fmt::format("faces got {} triangles of those that they are copies of", made.imprinted));
  if (made.moved > 0)
    stage.note(fmt::format("{} moved onto periodic faces, or to their copies, by {:.3g} at most",
                           counted(made.moved, "vertex", "vertices"), made.largest_move));
}

/// Which node is the copy of which, per period: {copy, original}, ascending.
using NodeLinks = std::vector<std::vector<std::array<VertexIndex, 2>>>;

class LinkFinder {
 public:
  LinkFinder(const TetMesh& mesh, const PeriodicCell& cell) : mesh_(mesh), cell_(cell) {
    if (mesh.order() > 1) nodes_.emplace(mesh);
  }

  NodeLinks run() const {
    NodeLinks links(static_cast<std::size_t>(cell_.periods()));
    for (int k = 0; k < cell_.periods(); ++k)
      if (cell_.has(k)) links[static_cast<std::size_t>(k)] = links_of(k);
    return links;
  }

  /// Throws MeshingError unless copies lie where their originals lead, bit for bit.
  void check(const NodeLinks& links) const {
    for (int k = 0; k < cell_.periods(); ++k)
      for (const auto& [copy, original] : links[static_cast<std::size_t>(k)])
        if (copied(original, k) != mesh_.points[copy]) refuse(copy, k);
  }

 private:
  Vec3 copied(VertexIndex v, int k) const {
    return cell_.is_box() ? low(mesh_.points[v], k) : cell_.to_high(mesh_.points[v], k);
  }
  Vec3 low(Vec3 p, int axis) const {
    p[axis] += cell_.period(axis);
    return p;
  }

  std::vector<Triangle> triangles_on(CellFace face) const {
    std::vector<Triangle> all;
    for (std::size_t f = 0; f < mesh_.boundary.size(); ++f) {
      const auto& [a, b, c] = mesh_.boundary[f];
      const std::uint32_t patch = mesh_.patch.empty() ? 0 : mesh_.patch[f];
      if (face_of_cell(cell_, patch, mesh_.points[a], mesh_.points[b], mesh_.points[c]) == face)
        all.push_back(mesh_.boundary[f]);
    }
    return all;
  }

  std::vector<std::array<VertexIndex, 2>> links_of(int k) const {
    const CellFace face = 2 * static_cast<CellFace>(k);
    const std::vector<Triangle> originals = triangles_on(face), copies = triangles_on(face + 1);
    VerticesByPlace at;
    std::vector<Triangle> known;
    for (const Triangle& t : copies) {
      for (const VertexIndex v : t) at.add(mesh_.points[v], v);
      known.push_back(face_key(t));
    }
    std::sort(known.begin(), known.end());
    std::map<VertexIndex, VertexIndex> original_of;
    for (const Triangle& t : originals) {
      Triangle copy{};
      for (int i = 0; i < 3; ++i) copy[i] = at.find(copied(t[i], k));
      for (int i = 0; i < 3; ++i) {
        if (copy[i] == kNone) refuse(t[i], k);
        original_of[copy[i]] = t[i];
      }
      if (!std::binary_search(known.begin(), known.end(), face_key(copy))) refuse(t[0], k);
      if (!nodes_) continue;
      visit_nodes_behind_corners(mesh_.order(), [&](const FaceNodes::Weights& weights) {
        original_of[nodes_->node(copy, weights)] = nodes_->node(t, weights);
      });
    }
    if (originals.size() != copies.size()) refuse(originals.empty() ? copies[0][0] : originals[0][0], k);
    std::vector<std::array<VertexIndex, 2>> links;
    for (const auto& [copy, original] : original_of)
      if (copy != original) links.push_back({copy, original});  // on the axis of a rotation they are the same
    return links;
  }

  [[noreturn]] void refuse(VertexIndex v, int k) const {
    throw FacesDiffer(fmt::format("opposite faces along {} did not become the same around {}: a smaller size may help",
                                  cell_.name_of_period(k), at_point(mesh_.points[v])));
  }

  const TetMesh& mesh_;
  const PeriodicCell& cell_;
  std::optional<FaceNodes> nodes_;  ///< of curved meshes
};

/// Where an original near p lies: in the low faces that all corners of its edge or face are in.
Vec3 settled(const TetMesh& mesh, const PeriodicCell& cell, Vec3 p, std::span<const VertexIndex> corners) {
  if (!cell.is_box()) return cell.on_grid(p);
  for (int k = 0; k < cell.periods(); ++k)
    if (std::ranges::all_of(corners, [&](VertexIndex v) { return cell.is_low(mesh.points[v], k); }))
      p = cell.to_low(p, k);
  return p;
}

std::vector<NodeLink> links_behind_corners(const TetMesh& mesh, const PeriodicCell& cell) {
  std::vector<char> is_corner(mesh.points.size());
  for (const Tet& tet : mesh.tets)
    for (const VertexIndex v : tet) is_corner[v] = 1;
  std::vector<NodeLink> behind;
  const NodeLinks links = LinkFinder(mesh, cell).run();
  for (std::uint32_t k = 0; k < links.size(); ++k)
    for (const auto& [copy, original] : links[k])
      if (!is_corner[copy]) behind.push_back({k, copy, original});
  return behind;
}

/// The names that make_periodic() gives to one face: "x_min", "x_min_2", ...
bool is_own_name(const std::string& name, const PeriodicCell& cell, CellFace face) {
  const std::string own = name_of_face(cell, face);
  return name == own ||
         (name.starts_with(own + "_") && name.find_first_not_of("0123456789", own.size() + 1) == std::string::npos);
}

/// Leaves periods and pairs in the mesh.
void take_links(const NodeLinks& links, const PeriodicCell& cell, TetMesh& mesh) {
  bool turns = false;
  for (const MappedFaces& faces : cell.mapped) turns = turns || faces.map.turns();
  for (std::size_t k = 0; k < links.size(); ++k) {
    if (!cell.has(static_cast<int>(k))) continue;
    const auto number = static_cast<std::uint32_t>(mesh.periods.size());
    Vec3 period;
    if (cell.is_box())
      period[static_cast<int>(k)] = cell.period(static_cast<int>(k));
    else
      period = cell.mapped[k].map.shift();
    mesh.periods.push_back(period);
    if (turns) mesh.period_rotations.push_back(cell.mapped[k].map.matrix());
    for (const auto& [copy, original] : links[k]) mesh.periodic_nodes.push_back({number, copy, original});
  }
}

/// Patches that make_periodic() made of one face become one again.
void unite_patches(TetMesh& mesh, const PeriodicCell& cell) {
  std::vector<std::uint32_t> becomes(mesh.patch_names.size());
  for (std::uint32_t p = 0; p < becomes.size(); ++p) becomes[p] = p;
  for (CellFace face = 0; face < 2 * static_cast<CellFace>(cell.periods()); ++face) {
    if (!cell.has(static_cast<int>(face / 2))) continue;
    std::uint32_t first = kNone;
    for (std::uint32_t p = 0; p < becomes.size(); ++p)
      if (is_own_name(mesh.patch_names[p], cell, face)) becomes[p] = first = std::min(first, p);
    if (first != kNone) mesh.patch_names[first] = name_of_face(cell, face);
  }
  std::vector<std::uint32_t> number(becomes.size());
  std::vector<std::string> names;
  for (std::uint32_t p = 0; p < becomes.size(); ++p) {
    number[p] = becomes[p] == p ? static_cast<std::uint32_t>(names.size()) : number[becomes[p]];
    if (becomes[p] == p) names.push_back(std::move(mesh.patch_names[p]));
  }
  for (std::uint32_t& p : mesh.patch) p = number[p];
  for (std::uint32_t& p : mesh.interface_patch) p = number[p];
  mesh.patch_names = std::move(names);
  mesh.patch_labels.clear();
}

}  // namespace

void check_periodic_options(const Options& options) {
  if (options.periodic.empty()) return;
  periods_asked("periodic", options.periodic);
  if (!traits_of(options.method).fills_complexes)
    throw OptionError("`periodic` goes with the methods octree-aft and recover only");
  if (options.layers.count > 0) throw OptionError("`periodic` and `layers` do not go together yet: leave out one");
}

std::optional<PeriodicDomain> made_periodic(const Domain& domain, Run& run) {
  if (run.options.periodic.empty()) return std::nullopt;
  return run.stage("periods", [&](const Stage& stage) -> std::optional<PeriodicDomain> {
    SurfaceMesh numbered = domain.surface;
    numbered.source.clear();
    Examined examined = examine_surface(numbered, false, stage.context());
    if (!examined.defects.clean()) return std::nullopt;
    const Domain clean = tidied(domain, std::move(examined.repaired.surface));
    SurfaceMesh surface = clean.surface;
    const AskedPeriods asked = periods_asked("periodic", run.options.periodic);
    const MadePeriodic made = asked.maps.empty() ? make_periodic(surface, asked.along, stage.context())
                                                 : make_periodic(surface, asked.maps, stage.context());
    tell(made, stage);
    Domain periodic = with_surface(clean, std::move(surface), made.origin);
    if (periodic.geometry)
      stage.note(
          "faces of a periodic cell are copies of each other, so the mesh follows the triangles of the CAD file, "
          "not its geometry");
    periodic.geometry.reset();
    return PeriodicDomain{std::move(periodic), made.cell};
  });
}

std::vector<VertexIndex> vertices_on_faces(const SurfaceMesh& surface, const PeriodicCell& cell) {
  std::vector<VertexIndex> found;
  if (!cell.is_periodic()) return found;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Vec3 p = surface.points[a], q = surface.points[b], r = surface.points[c];
    if (face_of_cell(cell, surface.patch_of(t), p, q, r) != kNone) found.insert(found.end(), {a, b, c});
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void pair_mid_nodes(TetMesh& mesh, const PeriodicCell& cell, const Stage& stage) {
  if (!cell.is_periodic() || mesh.order() == 1) return;
  const Repeats repeats{static_cast<std::uint32_t>(cell.periods()),
                        [&](std::uint32_t period, Vec3 p) { return cell.to_high(p, static_cast<int>(period)); },
                        [&](Vec3 p, std::span<const VertexIndex> corners) { return settled(mesh, cell, p, corners); }};
  const std::uint64_t straightened = pair_nodes_behind_corners(mesh, links_behind_corners(mesh, cell), repeats);
  stage.count("nodes of periodic faces straightened", static_cast<double>(straightened));
}

void pair_nodes(const Prepared& input, TetMesh& mesh, Run& run) {
  const PeriodicCell& cell = input.cell;
  if (!cell.is_periodic()) return;
  run.stage("pairs", [&](const Stage& stage) {
    const LinkFinder finder(mesh, cell);
    const NodeLinks links = finder.run();
    finder.check(links);
    take_links(links, cell, mesh);
    for (int k = 0; k < cell.periods(); ++k)
      if (cell.has(k))
        stage.count(fmt::format("pairs of nodes along {}", cell.name_of_period(k)),
                    static_cast<double>(links[static_cast<std::size_t>(k)].size()));
    unite_patches(mesh, cell);
  });
}

}  // namespace octafront
