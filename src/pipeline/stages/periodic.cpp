#include "pipeline/stages/periodic.h"

#include <octafront/error.h>
#include <octafront/tet_mesh.h>

#include "base/core/wording.h"
#include "base/geometry/quadratic_tet.h"
#include "base/mesh/edge_nodes.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/stages.h"
#include "soup/defects/examine.h"
#include "soup/periods/periods.h"

#include <algorithm>
#include <map>
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
    stage.note(fmt::format("opposite faces carried different triangles: both got {} new ones, by the lines of both",
                           made.imprinted / 2));
  if (made.moved > 0)
    stage.note(fmt::format("{} moved onto periodic faces, or to their copies, by {:.3g} at most",
                           counted(made.moved, "vertex", "vertices"), made.largest_move));
}

/// The edges of periodic faces by the places of their ends, as those that they are copies of.
struct PairedEdge {
  VertexIndex node = kNone;      ///< on the lowest faces
  std::vector<VertexIndex> all;  ///< of all copies, `node` too
};

using EdgePlace = std::array<std::array<double, 3>, 2>;

EdgePlace place_of_edge(const std::array<Vec3, 2>& ends) {
  EdgePlace place{{{ends[0].x, ends[0].y, ends[0].z}, {ends[1].x, ends[1].y, ends[1].z}}};
  std::sort(place.begin(), place.end());
  return place;
}

class MidNodes {
 public:
  MidNodes(TetMesh& mesh, const PeriodicCell& cell) : mesh_(mesh), cell_(cell) { find_edges(); }

  void run(const Stage& stage) {
    for (auto& [place, edge] : edges_) unite(edge);
    std::uint64_t straightened = 0;
    for (;;) {
      const std::vector<std::uint8_t> bad = corners_of_bad();
      std::uint64_t now = 0;
      for (auto& [place, edge] : edges_)
        if (std::any_of(edge.all.begin(), edge.all.end(), [&](VertexIndex v) { return bad[v] != 0; }))
          now += straighten(place, edge);
      if (now == 0) break;
      straightened += now;
    }
    stage.count("edges of periodic faces straightened", static_cast<double>(straightened));
  }

 private:
  void find_edges() {
    const EdgeNodes node_of(mesh_);
    for (const Triangle& t : mesh_.boundary) {
      if (face_of_cell(cell_, mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]) == kNone) continue;
      for (int i = 0; i < 3; ++i) {
        const VertexIndex a = t[i], b = t[(i + 1) % 3];
        const std::array ends{mesh_.points[a], mesh_.points[b]}, low = cell_.originals(ends);
        PairedEdge& edge = edges_[place_of_edge(low)];
        const VertexIndex node = node_of(a, b);
        if (std::find(edge.all.begin(), edge.all.end(), node) != edge.all.end()) continue;
        edge.all.push_back(node);
        if (ends == low) edge.node = node;
        ends_[node] = {a, b};
      }
    }
  }

  /// The coordinates of a copy: those of its face, and all others of the original.
  Vec3 copied(Vec3 p, VertexIndex node) const {
    const auto [a, b] = ends_.at(node);
    for (int axis = 0; axis < 3; ++axis)
      for (const double end : {cell_.box.lo[axis], cell_.box.hi[axis]})
        if (cell_.along[axis] && mesh_.points[a][axis] == end && mesh_.points[b][axis] == end) p[axis] = end;
    return p;
  }

  void unite(PairedEdge& edge) {
    if (edge.node == kNone) edge.node = edge.all.front();
    const Vec3 p = mesh_.points[edge.node];
    for (const VertexIndex node : edge.all) mesh_.points[node] = copied(p, node);
  }

  bool straighten(const EdgePlace& place, const PairedEdge& edge) {
    const Vec3 middle{(place[0][0] + place[1][0]) * 0.5, (place[0][1] + place[1][1]) * 0.5,
                      (place[0][2] + place[1][2]) * 0.5};
    bool changed = false;
    for (const VertexIndex node : edge.all) {
      const Vec3 to = copied(middle, node);
      changed = changed || mesh_.points[node] != to;
      mesh_.points[node] = to;
    }
    return changed;
  }

  /// Per node whether an element that is not valid has it.
  std::vector<std::uint8_t> corners_of_bad() const {
    std::vector<std::uint8_t> on_face(mesh_.points.size(), 0), bad(mesh_.points.size(), 0);
    for (const auto& [place, edge] : edges_)
      for (const VertexIndex node : edge.all) on_face[node] = 1;
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      const auto& mid = mesh_.mid_nodes[t];
      if (std::none_of(mid.begin(), mid.end(), [&](VertexIndex v) { return on_face[v] != 0; })) continue;
      QuadraticTet nodes;
      for (int i = 0; i < 4; ++i) nodes[i] = mesh_.points[mesh_.tets[t][i]];
      for (int i = 0; i < 6; ++i) nodes[4 + i] = mesh_.points[mid[i]];
      if (has_positive_jacobian(nodes)) continue;
      for (const VertexIndex v : mid) bad[v] = 1;
    }
    return bad;
  }

  TetMesh& mesh_;
  const PeriodicCell& cell_;
  std::map<EdgePlace, PairedEdge> edges_;
  std::map<VertexIndex, Edge> ends_;  ///< of nodes
};

/// The names that make_periodic() gives to one face: "x_min", "x_min_2", ...
bool is_own_name(const std::string& name, CellFace face) {
  const std::string own = name_of_face(face);
  return name == own ||
         (name.starts_with(own + "_") && name.find_first_not_of("0123456789", own.size() + 1) == std::string::npos);
}

class Pairs {
 public:
  Pairs(TetMesh& mesh, const PeriodicCell& cell) : mesh_(mesh), cell_(cell) {}

  std::array<std::uint64_t, 3> run() {
    const EdgeNodes node_of(mesh_);
    for (int axis = 0; axis < 3; ++axis)
      if (cell_.along[axis]) pair_axis(axis, node_of);
    return counts_;
  }

 private:
  /// The nodes of boundary faces in a face of the cell: corners, then mid-side nodes.
  std::vector<Triangle> triangles_on(CellFace face) const {
    std::vector<Triangle> all;
    for (const Triangle& t : mesh_.boundary)
      if (face_of_cell(cell_, mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]) == face) all.push_back(t);
    return all;
  }

  void pair_axis(int axis, const EdgeNodes& node_of) {
    const CellFace low = 2 * static_cast<CellFace>(axis);
    const std::vector<Triangle> originals = triangles_on(low), copies = triangles_on(low + 1);
    VerticesByPlace at;
    std::vector<std::array<VertexIndex, 3>> known;
    for (const Triangle& t : originals) {
      for (const VertexIndex v : nodes_of(t, node_of)) at.add(mesh_.points[v], v);
      known.push_back(sorted(t));
    }
    std::sort(known.begin(), known.end());
    std::map<VertexIndex, VertexIndex> original_of;
    for (const Triangle& t : copies) {
      for (const VertexIndex v : nodes_of(t, node_of)) original_of[v] = original_at(v, axis, at);
      const Triangle original{original_of.at(t[0]), original_of.at(t[1]), original_of.at(t[2])};
      if (!std::binary_search(known.begin(), known.end(), sorted(original))) refuse(t[0], axis);
    }
    if (originals.size() != copies.size()) refuse(originals.empty() ? copies[0][0] : originals[0][0], axis);
    const auto number = static_cast<std::uint32_t>(mesh_.periods.size());
    Vec3 period;
    period[axis] = cell_.period(axis);
    mesh_.periods.push_back(period);
    for (const auto& [copy, original] : original_of) mesh_.periodic_nodes.push_back({number, copy, original});
    counts_[axis] = original_of.size();
  }

  std::vector<VertexIndex> nodes_of(const Triangle& t, const EdgeNodes& node_of) const {
    std::vector<VertexIndex> nodes(t.begin(), t.end());
    if (!mesh_.is_second_order()) return nodes;
    for (const VertexIndex v : node_of.of(t)) nodes.push_back(v);
    return nodes;
  }

  static Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  }

  VertexIndex original_at(VertexIndex copy, int axis, const VerticesByPlace& at) const {
    Vec3 p = mesh_.points[copy];
    p[axis] = cell_.box.lo[axis];
    const VertexIndex original = at.find(p);
    if (original == kNone || p[axis] + cell_.period(axis) != mesh_.points[copy][axis]) refuse(copy, axis);
    return original;
  }

  [[noreturn]] void refuse(VertexIndex v, int axis) const {
    const Vec3 p = mesh_.points[v];
    throw MeshingError(fmt::format(
        "opposite faces along {} did not become the same around ({:.6g}, {:.6g}, {:.6g}): a smaller size may help",
        kAxisNames[axis], p.x, p.y, p.z));
  }

  TetMesh& mesh_;
  const PeriodicCell& cell_;
  std::array<std::uint64_t, 3> counts_{};
};

/// Patches that make_periodic() made of one face become one again.
void unite_patches(TetMesh& mesh, const PeriodicCell& cell) {
  std::vector<std::uint32_t> becomes(mesh.patch_names.size());
  for (std::uint32_t p = 0; p < becomes.size(); ++p) becomes[p] = p;
  for (CellFace face = 0; face < 6; ++face) {
    if (!cell.along[face / 2]) continue;
    std::uint32_t first = kNone;
    for (std::uint32_t p = 0; p < becomes.size(); ++p)
      if (is_own_name(mesh.patch_names[p], face)) becomes[p] = first = std::min(first, p);
    if (first != kNone) mesh.patch_names[first] = name_of_face(face);
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
}

}  // namespace

void check_periodic_options(const Options& options) {
  if (options.periodic.empty()) return;
  axes_named("periodic", options.periodic);
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
    const MadePeriodic made = make_periodic(surface, axes_named("periodic", run.options.periodic), stage.context());
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

std::vector<VertexIndex> vertices_on_faces(const std::vector<Vec3>& points, const PeriodicCell& cell) {
  std::vector<VertexIndex> found;
  for (VertexIndex v = 0; v < points.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      if (cell.is_low(points[v], axis) || cell.is_high(points[v], axis)) {
        found.push_back(v);
        break;
      }
  return found;
}

void pair_mid_nodes(TetMesh& mesh, const PeriodicCell& cell, const Stage& stage) {
  if (cell.is_periodic() && mesh.is_second_order()) MidNodes(mesh, cell).run(stage);
}

void pair_nodes(const Prepared& input, TetMesh& mesh, Run& run) {
  if (!input.cell.is_periodic()) return;
  run.stage("pairs", [&](const Stage& stage) {
    const std::array<std::uint64_t, 3> counts = Pairs(mesh, input.cell).run();
    for (int axis = 0; axis < 3; ++axis)
      if (input.cell.along[axis])
        stage.count(fmt::format("pairs of nodes along {}", kAxisNames[axis]), static_cast<double>(counts[axis]));
    unite_patches(mesh, input.cell);
  });
}

}  // namespace octafront
