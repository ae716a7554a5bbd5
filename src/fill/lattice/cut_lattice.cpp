#include "fill/lattice/cut_lattice.h"

#include "base/core/groups.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/mesh/adjacency.h"
#include "fill/lattice/lattice_graph.h"
#include "fill/lattice/stencil.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// Cut points stay this far from the ends of their edge. Only where warping was refused can they come nearer, and such
/// an end would leave a tetrahedron without volume.
constexpr double kLeastPart = 0.05;

/// Warping leaves no tetrahedron of a uniform lattice below this beta. Where leaves of two sizes meet, other cut points
/// are tried until one does as well, and warping is refused where all fall below the lesser bound.
constexpr double kFairShape = 0.1, kLeastShape = 0.03;

/// Moves lattice points onto the boundary where it comes too near to them.
class Warp {
 public:
  explicit Warp(LatticeGraph& graph)
      : graph_(graph),
        cuts_of_(graph.sites.size(),
                 [&](const auto& add) {
                   for (std::uint32_t c = 0; c < graph.cuts.size(); ++c) {
                     add(graph.cuts[c].inside, c);
                     add(graph.cuts[c].outside, c);
                   }
                 }),
        tets_of_(graph.sites.size(), [&](const auto& add) {
          for (std::uint32_t t = 0; t < graph.tets.size(); ++t)
            for (const std::uint32_t site : graph.tets[t])
              if (!cuts_of_[site].empty()) add(site, t);
        }) {}

  std::size_t warped = 0, refused = 0;

  void run() {
    for (std::uint32_t site = 0; site < graph_.sites.size(); ++site)
      if (!cuts_of_[site].empty()) visit(site);
  }

 private:
  /// How near the boundary comes to a site along a cut edge, over what is allowed: below 1 it is too near.
  double nearness(std::uint32_t site, const LatticeGraph::CutEdge& cut) const {
    const auto a = unpack_site(graph_.sites[cut.inside]), b = unpack_site(graph_.sites[cut.outside]);
    const bool along_axis = (a[0] == b[0]) + (a[1] == b[1]) + (a[2] == b[2]) == 2;
    const double part = cut.inside == site ? cut.part : 1 - cut.part;
    return part / (along_axis ? kWarpLong : kWarpShort);
  }

  void visit(std::uint32_t site) {
    std::vector<std::pair<double, std::uint32_t>> too_near;
    for (const std::uint32_t c : cuts_of_[site]) {
      const auto& cut = graph_.cuts[c];
      // An edge with a warped end is no longer cut.
      if (graph_.side[cut.inside] == 0 || graph_.side[cut.outside] == 0) continue;
      if (const double n = nearness(site, cut); n < 1) too_near.emplace_back(n, c);
    }
    if (too_near.empty()) return;
    std::sort(too_near.begin(), too_near.end());
    const Vec3 old = graph_.at[site];
    // The best shape of those tried, the first one that will do.
    double best = 0;
    Vec3 best_at = old;
    for (const auto& [n, c] : too_near) {
      const auto& cut = graph_.cuts[c];
      const Vec3 from = graph_.at[cut.inside];
      graph_.at[site] = from + (graph_.at[cut.outside] - from) * cut.part;
      if (const double shape = worst_shape_around(site); shape > best) best = shape, best_at = graph_.at[site];
      if (best >= kFairShape) break;
    }
    graph_.at[site] = best_at;
    if (best >= kLeastShape) {
      graph_.side[site] = 0;
      ++warped;
    } else {
      graph_.at[site] = old;
      ++refused;
    }
  }

  /// Least beta of the tetrahedra around a site; 0 if one of them is not positive, by exact sign.
  double worst_shape_around(std::uint32_t site) const {
    double least = 1;
    for (const std::uint32_t i : tets_of_[site]) {
      const auto& t = graph_.tets[i];
      const Vec3 a = graph_.at[t[0]], b = graph_.at[t[1]], c = graph_.at[t[2]], d = graph_.at[t[3]];
      if (orient3d(a, b, c, d) <= 0) return 0;
      least = std::min(least, tet_radius_ratio(a, b, c, d));
    }
    return least;
  }

  LatticeGraph& graph_;
  Groups<> cuts_of_, tets_of_;
};

/// Cuts the tetrahedra and numbers what is used.
class Cutter {
 public:
  explicit Cutter(const LatticeGraph& graph)
      : graph_(graph), vertex_of_site_(graph.sites.size(), kNone), vertex_of_cut_(graph.cuts.size(), kNone) {}

  TetMesh run(const RunContext& context) {
    mesh_.tets.reserve(graph_.tets.size());
    for (std::size_t i = 0; i < graph_.tets.size(); ++i) {
      if (i % 65536 == 0) context.check();
      add(graph_.tets[i]);
    }
    mesh_.boundary = boundary_triangles(mesh_.tets, half_face_neighbors(mesh_.tets, mesh_.points.size()));
    return std::move(mesh_);
  }

 private:
  void add(const std::array<std::uint32_t, 4>& tet) {
    std::array<StencilCorner, 4> corners;
    std::array<LatticeSite, 4> sites;
    bool any_inside = false;
    for (int k = 0; k < 4; ++k) any_inside = any_inside || graph_.side[tet[k]] > 0;
    if (!any_inside) return;
    for (int k = 0; k < 4; ++k) {
      sites[k] = graph_.sites[tet[k]];
      corners[k] = {graph_.side[tet[k]] >= 0 ? site_vertex(tet[k]) : kNone, graph_.side[tet[k]]};
    }
    Stencil(corners, sites)
        .apply([&](int in, int out) { return cut_vertex(graph_.cut_between(tet[in], tet[out])); },
               [&](const auto& one, const auto& two) { return worst(one) >= worst(two); },
               [&](const Stencil::Corners& made) { emit(made); });
  }

  std::uint32_t new_vertex(Vec3 p) {
    mesh_.points.push_back(p);
    return static_cast<std::uint32_t>(mesh_.points.size() - 1);
  }
  std::uint32_t site_vertex(std::uint32_t site) {
    if (vertex_of_site_[site] == kNone) vertex_of_site_[site] = new_vertex(graph_.at[site]);
    return vertex_of_site_[site];
  }
  std::uint32_t cut_vertex(std::uint32_t c) {
    if (vertex_of_cut_[c] == kNone) {
      const auto& cut = graph_.cuts[c];
      const Vec3 from = graph_.at[cut.inside], to = graph_.at[cut.outside];
      vertex_of_cut_[c] = new_vertex(from + (to - from) * std::clamp(cut.part, kLeastPart, 1 - kLeastPart));
    }
    return vertex_of_cut_[c];
  }

  /// The least beta, whatever the orientation: ranks alternatives.
  double worst(const std::array<Stencil::Corners, 3>& tets) const {
    double least = 1;
    for (const auto& [a, b, c, d] : tets)
      least = std::min(least,
                       std::abs(tet_radius_ratio(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d])));
    return least;
  }

  void emit(Stencil::Corners t) {
    if (orient3d(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]], mesh_.points[t[3]]) < 0)
      std::swap(t[0], t[1]);
    mesh_.tets.push_back({t[0], t[1], t[2], t[3]});
  }

  const LatticeGraph& graph_;
  std::vector<std::uint32_t> vertex_of_site_, vertex_of_cut_;
  TetMesh mesh_;
};

}  // namespace

TetMesh cut_lattice(const RootCube& root, const Octree& tree, const ImplicitDomain& domain, const Stage& stage) {
  LatticeGraph graph = build_lattice_graph(root, tree, domain, stage.context());
  Warp warp(graph);
  warp.run();
  stage.count("lattice points", static_cast<double>(graph.sites.size()));
  stage.count("cut edges", static_cast<double>(graph.cuts.size()));
  stage.count("warped points", static_cast<double>(warp.warped));
  stage.count("warps refused", static_cast<double>(warp.refused));
  return Cutter(graph).run(stage.context());
}

}  // namespace octafront
