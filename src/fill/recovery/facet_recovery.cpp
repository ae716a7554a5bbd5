#include <octafront/error.h>

#include "fill/recovery/boundary_recovery.h"

#include <algorithm>
#include <set>

#include <fmt/core.h>

namespace octafront::recovery {

namespace {

constexpr int kPasses = 8;
// A facet that was divided this often is finished without flips that could bring new edges into its way.
constexpr int kDivisionsBeforeStrict = 40;

}  // namespace

HalfFace BoundaryRecovery::find_face(const Triangle& f) {
  const TetIndex start = tet_with_edge(points_, mesh_, f[0], f[1]);
  if (start == kNone || !mesh_.closed_ring(start, f[0], f[1], ring_)) return kNone;
  for (std::size_t i = 0; i < ring_.tets.size(); ++i) {
    if (ring_.ring[i] != f[2]) continue;
    const VertexIndex other = ring_.ring[(i + 1) % ring_.ring.size()];
    return mesh_.opposite(ring_.tets[i], other);
  }
  return kNone;
}

// One edge that crosses the polygon, next to one of its sides; then all others, from ring to ring.
void BoundaryRecovery::crossing_edges(const Polygon& polygon, std::vector<Edge>& edges, std::vector<TetIndex>& tets) {
  edges.clear();
  tets.clear();
  const std::size_t n = polygon.corners.size();
  for (std::size_t i = 0; i < n && edges.empty(); ++i) crossing_edge_at_side(polygon, i, edges, tets);
  const FacetHindrance hindrance(points_, surface_.triangles()[polygon.parent]);
  std::set<Edge> known(edges.begin(), edges.end());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (!mesh_.closed_ring(tets[k], edges[k][0], edges[k][1], ring_)) continue;
    for (const TetIndex t : ring_.tets) {
      for (const auto& [i, j] : kTetEdges) {
        const Edge e = sorted_edge(mesh_.tets[t][i], mesh_.tets[t][j]);
        if (known.contains(e) || hindrance.of_edge(e[0], e[1]) == 0) continue;
        known.insert(e);
        edges.push_back(e);
        tets.push_back(t);
      }
    }
  }
}

void BoundaryRecovery::crossing_edge_at_side(const Polygon& polygon, std::size_t side, std::vector<Edge>& edges,
                                             std::vector<TetIndex>& tets) {
  const std::vector<VertexIndex>& c = polygon.corners;
  const std::size_t n = c.size();
  const VertexIndex u = c[side], v = c[(side + 1) % n];
  std::size_t k = 2;
  while (k < n && turn(polygon.parent, u, v, c[(side + k) % n]) <= 0) ++k;
  const VertexIndex w = c[(side + k) % n];
  const TetIndex start = tet_with_edge(points_, mesh_, u, v);
  if (start == kNone || k == n) throw std::logic_error("a facet is searched before its edges are there");
  mesh_.closed_ring(start, u, v, ring_);
  for (std::size_t i = 0; i < ring_.tets.size(); ++i) {
    const VertexIndex p = ring_.ring[i], q = ring_.ring[(i + 1) % ring_.ring.size()];
    if (p == w || q == w) continue;
    const int before = points_.orient(u, v, p, w), after = points_.orient(u, v, w, q);
    if (after <= 0 || before < 0) continue;
    if (before > 0) {
      edges.push_back(sorted_edge(p, q));
      tets.push_back(ring_.tets[i]);
      return;
    }
    if (std::ranges::count(c, p) > 0) continue;  // a face of the mesh lies in the polygon here
    const Vec3 at = points_.at(p);
    throw MeshingError(
        fmt::format("the surface touches itself at vertex {} ({}, {}, {}); repair it there", p, at.x, at.y, at.z));
  }
}

// Counts what crosses the whole input triangle: what one part of it gains may not be at the cost of another.
bool BoundaryRecovery::facet_by_flips(const Polygon& polygon) {
  const FacetHindrance hindrance(points_, surface_.triangles()[polygon.parent]);
  std::vector<Edge> edges;
  std::vector<TetIndex> tets;
  for (int idle = 0; idle < kPasses;) {
    crossing_edges(polygon, edges, tets);
    if (edges.empty()) return true;
    const bool random_pass = idle > 0;
    const std::size_t n = edges.size(), first = random_pass ? random() % n : 0;
    bool better = false;
    for (std::size_t k = 0; k < n && !better; ++k) {
      const auto [p, q] = edges[(first + k) % n];
      const TetIndex t = flipper_.find_tet(tets[(first + k) % n], p, q);
      if (t == kNone) continue;
      const bool deep = random_pass && !strict_;
      better = flipper_.remove_edge_deep({t, p, q}, hindrance, -0.5, deep ? 2 : 0);
    }
    if (!better) ++idle;
  }
  crossing_edges(polygon, edges, tets);
  return edges.empty();
}

VertexIndex BoundaryRecovery::point_on_facet(const Polygon& polygon) {
  const Triangle& plane = surface_.triangles()[polygon.parent];
  std::vector<Edge> edges;
  std::vector<TetIndex> tets;
  crossing_edges(polygon, edges, tets);
  // The most central of the crossings.
  const Vec3 a = points_.at(plane[0]), n = cross(points_.at(plane[1]) - a, points_.at(plane[2]) - a);
  Vec3 center;
  for (const VertexIndex v : polygon.corners) center += points_.at(v) / static_cast<double>(polygon.corners.size());
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
  if (surface_.edges().contains(p, q)) refuse_intersection(points_.at(p));
  learn_planes();
  const VertexIndex s = points_.add_crossing(p, q, plane[0], plane[1], plane[2]);
  points_.add_plane(s, points_.plane_of(polygon.parent));
  carrier_.push_back({});
  ++counts_.facet_points;
  mesh_.closed_ring(tets[best], p, q, ring_);
  insert(s, ring_.tets);
  return s;
}

// The sense of rotation of three points of the parent's plane, seen from outside.
int BoundaryRecovery::turn(std::uint32_t parent, VertexIndex a, VertexIndex b, VertexIndex c) const {
  const Triangle& t = surface_.triangles()[parent];
  VertexIndex o = frame_;
  int up = 0;
  while ((up = points_.orient(t[0], t[1], t[2], o)) == 0) ++o;
  return points_.orient(a, b, c, o) * up;
}

bool BoundaryRecovery::label_face(const Triangle& corners, std::uint32_t parent) {
  const HalfFace h = find_face(corners);
  if (h == kNone) return false;
  mesh_.set_label(h, surface_.add_facet(corners, parent));
  return true;
}

// A face of the mesh that lies in the polygon along one of its sides becomes a facet.
bool BoundaryRecovery::adopt_face(const Polygon& polygon, std::vector<Polygon>& stack) {
  const std::vector<VertexIndex>& c = polygon.corners;
  const std::size_t n = c.size();
  for (std::size_t i = 0; i < n; ++i) {
    const VertexIndex u = c[i], v = c[(i + 1) % n];
    const TetIndex start = tet_with_edge(points_, mesh_, u, v);
    if (start == kNone || !mesh_.closed_ring(start, u, v, ring_)) continue;
    for (std::size_t k = 2; k < n; ++k) {
      const std::size_t at = (i + k) % n;
      const VertexIndex w = c[at];
      if (std::ranges::count(ring_.ring, w) == 0 || turn(polygon.parent, u, v, w) <= 0) continue;
      if (!label_face({u, v, w}, polygon.parent)) continue;
      if (n == 3) return true;
      surface_.add_edge(v, w);
      surface_.add_edge(w, u);
      Polygon left{{}, polygon.parent}, right{{}, polygon.parent};
      for (std::size_t j = 1; j <= k; ++j) left.corners.push_back(c[(i + j) % n]);
      for (std::size_t j = k; j <= n; ++j) right.corners.push_back(c[(i + j) % n]);
      for (Polygon* part : {&left, &right}) {
        if (part->corners.size() > 2) stack.push_back(std::move(*part));
      }
      return true;
    }
  }
  return false;
}

// A point where an edge crosses the polygon, joined with all corners.
void BoundaryRecovery::divide_polygon(const Polygon& polygon, std::vector<Polygon>& stack) {
  const VertexIndex s = point_on_facet(polygon);
  std::vector<Edge> spokes;
  for (const VertexIndex v : polygon.corners) {
    spokes.push_back({v, s});
    surface_.add_edge(v, s);
  }
  recover_edges(spokes);
  const std::size_t n = polygon.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const VertexIndex u = polygon.corners[i], v = polygon.corners[(i + 1) % n];
    Polygon part{{u}, polygon.parent};
    surface_.expand(v, s, part.corners);
    surface_.expand(s, u, part.corners);
    stack.push_back(std::move(part));
  }
}

void BoundaryRecovery::recover_polygon(const Polygon& polygon, std::vector<Polygon>& stack) {
  if (adopt_face(polygon, stack)) return;
  ++counts_.missing_facets;
  if (!facet_by_flips(polygon)) {
    divide_polygon(polygon, stack);
    return;
  }
  ++counts_.facets_by_flips;
  if (!adopt_face(polygon, stack)) throw std::logic_error("a facet that nothing crosses is not in the mesh");
}

void BoundaryRecovery::recover_facets() {
  const std::vector<Triangle>& triangles = surface_.triangles();
  std::vector<std::uint32_t> absent;
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    if (f % 256 == 0) context_.check();
    if (surface_.is_divided(triangles[f]) || !label_face(triangles[f], f)) absent.push_back(f);
  }
  std::vector<Polygon> stack;
  for (const std::uint32_t f : absent) {
    stack.assign(1, {{}, f});
    for (int i = 0; i < 3; ++i) surface_.expand(triangles[f][i], triangles[f][(i + 1) % 3], stack[0].corners);
    for (int divisions = 0; !stack.empty(); ++divisions) {
      context_.check();
      strict_ = divisions > kDivisionsBeforeStrict;
      const Polygon polygon = std::move(stack.back());
      stack.pop_back();
      recover_polygon(polygon, stack);
    }
    strict_ = false;
  }
}

}  // namespace octafront::recovery
