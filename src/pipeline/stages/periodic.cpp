#include "pipeline/stages/periodic.h"

#include <octafront/error.h>
#include <octafront/tet_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/quadratic_tet.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/face_nodes.h"
#include "pipeline/stages/methods.h"
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
      curved::visit_nodes_behind_corners(mesh_.order(), [&](const curved::FaceNodes::Weights& weights) {
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
  std::optional<curved::FaceNodes> nodes_;  ///< of curved meshes
};

/// Nodes of faces behind corners, where their originals lead.
class NodesBehindCorners {
 public:
  NodesBehindCorners(TetMesh& mesh, const PeriodicCell& cell)
      : mesh_(mesh), cell_(cell), set_(mesh.points.size()), place_(mesh.points.size()) {
    find_places();
    const NodeLinks links = LinkFinder(mesh, cell).run();
    std::vector<std::uint8_t> is_copy(mesh.points.size(), 0);
    for (std::size_t k = 0; k < links.size(); ++k)
      for (const auto& [copy, original] : links[k]) {
        if (place_[copy].count == 0) continue;
        set_.join(copy, original);
        links_.push_back({static_cast<int>(k), copy, original});
        is_copy[copy] = 1;
      }
    for (const Link& link : links_)
      if (!is_copy[link.original]) first_[set_.find(link.original)] = link.original;
  }

  void run(const Stage& stage) {
    for (const auto& [set, node] : first_) mesh_.points[node] = settled(mesh_.points[node], node);
    follow();
    std::uint64_t straightened = 0;
    for (;;) {
      const std::uint64_t now = straighten_bad();
      if (now == 0) break;
      straightened += now;
      follow();
    }
    stage.count("nodes of periodic faces straightened", static_cast<double>(straightened));
  }

 private:
  struct Link {
    int period;
    VertexIndex copy, original;
  };

  /// The corners that a node lies between, and how it counts them.
  struct Place {
    std::array<VertexIndex, 3> corners{};
    std::array<int, 3> weights{};
    std::size_t count = 0;
  };

  void find_places() {
    const curved::FaceNodes nodes(mesh_);
    for (const Triangle& face : mesh_.boundary)
      curved::visit_nodes_behind_corners(mesh_.order(), [&](const curved::FaceNodes::Weights& weights) {
        Place place;
        for (std::size_t i = 0; i < 3; ++i)
          if (weights[i] > 0) place.corners[place.count] = face[i], place.weights[place.count++] = weights[i];
        place_[nodes.node(face, weights)] = place;
      });
  }

  /// Where an original near p lies: in the low faces that all corners of its edge or face are in.
  Vec3 settled(Vec3 p, VertexIndex node) const {
    if (!cell_.is_box()) return cell_.on_grid(p);
    const Place& place = place_[node];
    for (int k = 0; k < cell_.periods(); ++k)
      if (std::all_of(place.corners.begin(), place.corners.begin() + static_cast<std::ptrdiff_t>(place.count),
                      [&](VertexIndex v) { return cell_.is_low(mesh_.points[v], k); }))
        p = cell_.to_low(p, k);
    return p;
  }

  Vec3 straight(VertexIndex node) const {
    const Place& place = place_[node];
    Vec3 sum;
    for (std::size_t i = 0; i < place.count; ++i) sum += place.weights[i] * mesh_.points[place.corners[i]];
    return sum / mesh_.order();
  }

  std::span<const VertexIndex> behind_corners(TetIndex t) const {
    if (mesh_.is_second_order()) return mesh_.mid_nodes[t];
    return std::span(mesh_.high_nodes).subspan(t * mesh_.high_nodes_per_tet(), mesh_.high_nodes_per_tet());
  }
  bool is_valid(TetIndex t) const {
    std::array<Vec3, 35> room;
    if (mesh_.is_second_order()) return has_positive_jacobian(quadratic_nodes(mesh_, t));
    return validity_of(mesh_.order(), nodes_of_tet(mesh_, t, room)) == Validity::kValid;
  }

  /// Copies come to where their originals lead: after as many rounds as there are periods all are there.
  void follow() {
    for (int k = 0; k < cell_.periods(); ++k)
      for (const Link& link : links_) mesh_.points[link.copy] = cell_.to_high(mesh_.points[link.original], link.period);
  }

  std::uint64_t straighten_bad() {
    std::vector<std::uint8_t> is_on_face(mesh_.points.size(), 0), is_bad(mesh_.points.size(), 0);
    for (const Link& link : links_) is_on_face[link.copy] = is_on_face[link.original] = 1;
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      const auto behind = behind_corners(t);
      if (std::none_of(behind.begin(), behind.end(), [&](VertexIndex v) { return is_on_face[v] != 0; })) continue;
      if (is_valid(t)) continue;
      for (const VertexIndex v : behind)
        if (is_on_face[v]) is_bad[set_.find(v)] = 1;
    }
    std::uint64_t changed = 0;
    for (const auto& [set, node] : first_) {
      if (!is_bad[set]) continue;
      const Vec3 to = settled(straight(node), node);
      changed += mesh_.points[node] != to;
      mesh_.points[node] = to;
    }
    return changed;
  }

  TetMesh& mesh_;
  const PeriodicCell& cell_;
  DisjointSets set_;                            ///< of nodes that are copies
  std::vector<Place> place_;                    ///< per node; of corners, and what is inside, none
  std::vector<Link> links_;                     ///< of nodes behind corners
  std::map<std::uint32_t, VertexIndex> first_;  ///< per set the node that is no copy
};

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
  if (cell.is_periodic() && mesh.order() > 1) NodesBehindCorners(mesh, cell).run(stage);
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
