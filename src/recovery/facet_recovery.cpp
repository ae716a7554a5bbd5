#include <octafront/error.h>

#include "recovery/boundary_recovery.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace octafront::recovery {

namespace {

constexpr int kPasses = 8;
// A facet that was divided this often is finished without flips that could bring new edges into its way.
constexpr int kDivisionsBeforeStrict = 8;

Edge ordered(VertexIndex a, VertexIndex b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

HalfFace BoundaryRecovery::find_face(const Triangle& f) {
  const TetIndex start = tet_with_edge(points_, mesh_, f[0], f[1]);
  if (start == kNone || !mesh_.ring(f[0], f[1], start, kNone, tets_, link_)) return kNone;
  for (std::size_t i = 0; i < tets_.size(); ++i) {
    if (link_[i] != f[2]) continue;
    const VertexIndex other = link_[(i + 1) % link_.size()];
    return 4 * tets_[i] + static_cast<HalfFace>(mesh_.corner_of(tets_[i], other));
  }
  return kNone;
}

void BoundaryRecovery::crossing_edges(const Triangle& f, std::vector<Edge>& edges, std::vector<TetIndex>& tets) {
  edges.clear();
  tets.clear();
  const TetIndex start = tet_with_edge(points_, mesh_, f[0], f[1]);
  if (start == kNone) throw std::logic_error("a facet is searched before its edges are there");
  mesh_.ring(f[0], f[1], start, kNone, tets_, link_);
  for (std::size_t i = 0; i < tets_.size() && edges.empty(); ++i) {
    const VertexIndex p = link_[i], q = link_[(i + 1) % link_.size()];
    if (p == f[2] || q == f[2]) continue;
    const int before = points_.orient(f[0], f[1], p, f[2]), after = points_.orient(f[0], f[1], f[2], q);
    if (before == 0 && after > 0) {
      const Vec3 v = points_.at(p);
      throw MeshingError(
          fmt::format("the surface touches itself at vertex {} ({}, {}, {}); repair it there", p, v.x, v.y, v.z));
    }
    if (before <= 0 || after <= 0) continue;
    edges.push_back(ordered(p, q));
    tets.push_back(tets_[i]);
  }
  const FacetHindrance hindrance(points_, f);
  std::set<Edge> known(edges.begin(), edges.end());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (!mesh_.ring(edges[k][0], edges[k][1], tets[k], kNone, tets_, link_)) continue;
    for (const TetIndex t : tets_) {
      for (const auto& [i, j] : kTetEdges) {
        const Edge e = ordered(mesh_.corner[t][i], mesh_.corner[t][j]);
        if (known.contains(e) || hindrance.of_edge(e[0], e[1]) == 0) continue;
        known.insert(e);
        edges.push_back(e);
        tets.push_back(t);
      }
    }
  }
}

bool BoundaryRecovery::facet_by_flips(const Triangle& f) {
  const FacetHindrance hindrance(points_, f);
  std::vector<Edge> edges;
  std::vector<TetIndex> tets;
  for (int idle = 0; idle < kPasses;) {
    crossing_edges(f, edges, tets);
    if (edges.empty()) return true;
    const bool random_pass = idle > 0;
    const std::size_t n = edges.size(), first = random_pass ? random() % n : 0;
    bool better = false;
    for (std::size_t k = 0; k < n && !better; ++k) {
      const auto [p, q] = edges[(first + k) % n];
      const TetIndex t = tets[(first + k) % n];
      const bool deep = random_pass && !strict_;
      better = flipper_.remove_edge_deep(t, p, q, hindrance, -0.5, deep ? 2 : 0);
      if (deep) break;  // the mesh may have changed
    }
    if (!better) ++idle;
  }
  crossing_edges(f, edges, tets);
  return edges.empty();
}

void BoundaryRecovery::divide_facet(std::uint32_t f) {
  const SubdividedSurface::Facet facet = surface_.facets()[f];
  const Triangle plane = surface_.facets()[facet.parent].corners;
  std::vector<Edge> edges;
  std::vector<TetIndex> tets;
  crossing_edges(facet.corners, edges, tets);
  // The most central of the crossings.
  const Vec3 a = points_.at(plane[0]), n = cross(points_.at(plane[1]) - a, points_.at(plane[2]) - a);
  const Vec3 center = (points_.at(facet.corners[0]) + points_.at(facet.corners[1]) + points_.at(facet.corners[2])) / 3;
  std::size_t best = 0;
  double best_distance = -1;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vec3 p = points_.at(edges[i][0]), q = points_.at(edges[i][1]);
    const double t = dot(a - p, n) / dot(q - p, n), d = squared_length(p + t * (q - p) - center);
    if (best_distance >= 0 && !(d < best_distance)) continue;
    best = i;
    best_distance = d;
  }
  const auto [p, q] = edges[best];
  const VertexIndex s = points_.add_crossing(p, q, plane[0], plane[1], plane[2]);
  carrier_.push_back({});
  ++counts_.facet_points;
  mesh_.ring(p, q, tets[best], kNone, tets_, link_);
  insert(s, tets_);
  std::vector<Edge> new_edges;
  surface_.split_facet(f, s, new_edges);
  recover_edges(new_edges);
}

void BoundaryRecovery::recover_facet(std::uint32_t f, std::vector<std::uint32_t>& stack) {
  const Triangle corners = surface_.facets()[f].corners;
  HalfFace h = find_face(corners);
  if (h == kNone) {
    ++counts_.missing_facets;
    if (facet_by_flips(corners)) {
      ++counts_.facets_by_flips;
      h = find_face(corners);
    }
  }
  if (h != kNone) {
    mesh_.set_label(h, f);
    return;
  }
  const std::size_t known = surface_.facets().size();
  divide_facet(f);
  for (std::size_t g = surface_.facets().size(); g-- > known;) stack.push_back(static_cast<std::uint32_t>(g));
}

void BoundaryRecovery::recover_facets() {
  const auto n = static_cast<std::uint32_t>(surface_.facets().size());
  std::vector<std::uint32_t> stack;
  std::vector<std::uint32_t> absent;
  for (std::uint32_t f = 0; f < n; ++f) {
    if (!surface_.facets()[f].alive) continue;
    if (f % 256 == 0) context_.check();
    if (const HalfFace h = find_face(surface_.facets()[f].corners); h != kNone) {
      mesh_.set_label(h, f);
    } else {
      absent.push_back(f);
    }
  }
  for (const std::uint32_t root : absent) {
    stack.assign(1, root);
    for (int divisions = 0; !stack.empty(); ++divisions) {
      context_.check();
      strict_ = divisions > kDivisionsBeforeStrict;
      const std::uint32_t f = stack.back();
      stack.pop_back();
      if (surface_.facets()[f].alive) recover_facet(f, stack);
    }
    strict_ = false;
  }
}

}  // namespace octafront::recovery
