#include "base/core/disjoint_sets.h"
#include "base/geometry/predicates.h"
#include "soup/tidy/defect_steps.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

namespace octafront::tidy {
namespace {

std::uint32_t corner_at(const std::vector<Triangle>& triangles, std::uint32_t face, VertexIndex v) {
  const Triangle& t = triangles[face];
  return 3 * face + (t[0] == v ? 0 : t[1] == v ? 1 : 2);
}

/// Corners of faces that hang together around their vertex over edges of two faces.
DisjointSets find_fans(const std::vector<Triangle>& triangles, const EdgeTable& table) {
  DisjointSets fans(3 * triangles.size());
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto uses = table.uses(e);
    if (uses.size() != 2) continue;
    for (const VertexIndex v : table.edges[e])
      fans.join(corner_at(triangles, uses[0] / 3, v), corner_at(triangles, uses[1] / 3, v));
  }
  return fans;
}

/// An open edge at one of its vertices.
struct OpenEnd {
  VertexIndex vertex;
  std::uint32_t fan;   // that the edge is the border of
  bool starts;         // its face runs from the vertex
  std::uint32_t edge;  // among the open ones
  Vec3 direction;      // from the vertex, of length 1

  auto key() const { return std::tuple{vertex, fan, starts, edge}; }
};

std::vector<OpenEnd> open_ends(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& open, DisjointSets& fans) {
  std::vector<OpenEnd> ends;
  for (std::uint32_t k = 0; k < open.size(); ++k) {
    const VertexIndex a = start_of(mesh.triangles, open[k]), b = end_of(mesh.triangles, open[k]);
    const Vec3 along = normalized(mesh.points[b] - mesh.points[a]);
    ends.push_back({a, fans.find(corner_at(mesh.triangles, open[k] / 3, a)), true, k, along});
    ends.push_back({b, fans.find(corner_at(mesh.triangles, open[k] / 3, b)), false, k, -along});
  }
  std::sort(ends.begin(), ends.end(), [](const OpenEnd& a, const OpenEnd& b) { return a.key() < b.key(); });
  return ends;
}

/// Joins the edges at one vertex that follow each other along the rim of a hole: the one that arrives is the border of
/// one fan, the one that leaves that of the next fan; of several the one at the smallest angle. Edges of which a rim
/// cannot be made, beside non-manifold ones, are joined as they come.
void join_rims(std::span<const OpenEnd> ends, DisjointSets& rims) {
  std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t in = 0; in < ends.size(); ++in)
    for (std::uint32_t out = 0; out < ends.size(); ++out)
      if (!ends[in].starts && ends[out].starts)
        pairs.push_back(
            {(ends[in].fan == ends[out].fan ? 2 : 0) - dot(ends[in].direction, ends[out].direction), in, out});
  std::sort(pairs.begin(), pairs.end());
  std::vector<char> joined(ends.size(), 0);
  for (const auto& [rank, in, out] : pairs) {
    if (joined[in] || joined[out]) continue;
    joined[in] = joined[out] = 1;
    rims.join(ends[in].edge, ends[out].edge);
  }
  std::uint32_t left = kNone;
  for (std::uint32_t k = 0; k < ends.size(); ++k) {
    if (joined[k]) continue;
    if (left == kNone) {
      left = k;
    } else {
      rims.join(ends[left].edge, ends[k].edge);
      left = kNone;
    }
  }
}

std::uint64_t count_holes(const SurfaceMesh& mesh, const EdgeTable& table, DisjointSets& fans) {
  std::vector<std::uint32_t> open;
  for (std::size_t e = 0; e < table.size(); ++e)
    if (table.uses(e).size() == 1) open.push_back(table.uses(e)[0]);
  const std::vector<OpenEnd> ends = open_ends(mesh, open, fans);
  DisjointSets rims(open.size());
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t end = i;
    while (end < ends.size() && ends[end].vertex == ends[i].vertex) ++end;
    // So many fans about one vertex have no order; each has its own rim then.
    constexpr std::size_t kMostEnds = 200;
    const std::size_t at_once = end - i <= kMostEnds ? end - i : 2;
    for (; i < end; i += at_once) join_rims({ends.data() + i, std::min(at_once, end - i)}, rims);
    i = end;
  }
  std::uint64_t holes = 0;
  for (std::uint32_t k = 0; k < open.size(); ++k) holes += rims.find(k) == k;
  return holes;
}

void find_pinched_vertices(const RepairedSurface& repaired, const EdgeTable& table, DisjointSets& fans,
                           SurfaceDefects& defects) {
  const SurfaceMesh& mesh = repaired.surface;
  const std::size_t vertices = mesh.points.size();
  std::vector<char> on_bad_edge(vertices, 0);
  for (std::size_t e = 0; e < table.size(); ++e)
    if (table.uses(e).size() > 2)
      for (const VertexIndex v : table.edges[e]) on_bad_edge[v] = 1;

  std::vector<std::uint32_t> first_fan(vertices, kNone);
  std::vector<std::pair<VertexIndex, std::uint32_t>> further;  // vertex, fan that is not its first
  for (std::uint32_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
    if (fans.find(c) != c) continue;
    const VertexIndex v = start_of(mesh.triangles, c);
    if (on_bad_edge[v]) continue;
    if (first_fan[v] == kNone)
      first_fan[v] = c;
    else
      further.push_back({v, c});
  }
  std::sort(further.begin(), further.end());
  FirstPlaces places(defects.non_manifold_vertices);
  for (std::size_t i = 0; i < further.size();) {
    const VertexIndex v = further[i].first;
    std::vector<std::uint32_t> faces{repaired.surface.source_of(first_fan[v] / 3)};
    for (; i < further.size() && further[i].first == v; ++i)
      faces.push_back(repaired.surface.source_of(further[i].second / 3));
    places.add(std::move(faces), mesh.points[v]);
  }
}

}  // namespace

void FirstPlaces::add(std::vector<std::uint32_t> faces, Vec3 at) {
  constexpr std::size_t kShown = 10;
  ++kind_.count;
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  auto& first = kind_.first;
  if (first.size() == kShown && first.back().faces <= faces) return;
  const auto after =
      std::upper_bound(first.begin(), first.end(), faces,
                       [](const auto& f, const SurfaceDefects::Place& place) { return f < place.faces; });
  first.insert(after, {at, std::move(faces)});
  if (first.size() > kShown) first.pop_back();
}

void find_bad_edges(const RepairedSurface& repaired, const EdgeTable& table, SurfaceDefects& defects) {
  const SurfaceMesh& mesh = repaired.surface;
  FirstPlaces open(defects.open_edges), non_manifold(defects.non_manifold_edges),
      misoriented(defects.misoriented_edges);
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto uses = table.uses(e);
    const bool agree = uses.size() == 2 && start_of(mesh.triangles, uses[0]) != start_of(mesh.triangles, uses[1]);
    if (agree) continue;
    std::vector<std::uint32_t> faces;
    for (const std::uint32_t h : uses) faces.push_back(repaired.surface.source_of(h / 3));
    const auto [a, b] = table.edges[e];
    FirstPlaces& kind = uses.size() == 1 ? open : uses.size() == 2 ? misoriented : non_manifold;
    kind.add(std::move(faces), (mesh.points[a] + mesh.points[b]) * 0.5);
  }
}

void find_bad_vertices(const RepairedSurface& repaired, const EdgeTable& table, SurfaceDefects& defects) {
  DisjointSets fans = find_fans(repaired.surface.triangles, table);
  defects.open_loops = count_holes(repaired.surface, table, fans);
  find_pinched_vertices(repaired, table, fans, defects);
}

void find_degenerate_faces(const RepairedSurface& repaired, SurfaceDefects& defects) {
  const SurfaceMesh& mesh = repaired.surface;
  FirstPlaces places(defects.degenerate_faces);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    const Vec3 a = mesh.points[i], b = mesh.points[j], c = mesh.points[k];
    if (collinear(a, b, c)) places.add({repaired.surface.source_of(t)}, (a + b + c) / 3);
  }
}

}  // namespace octafront::tidy
