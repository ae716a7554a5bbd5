#include "geometry/predicates.h"
#include "surface/defects_steps.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace octafront::defects {
namespace {

/// Sets that grow together pair by pair; the least member stands for its set.
class Partition {
 public:
  explicit Partition(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::uint32_t corner_at(const std::vector<Triangle>& triangles, std::uint32_t face, VertexIndex v) {
  const Triangle& t = triangles[face];
  return 3 * face + (t[0] == v ? 0 : t[1] == v ? 1 : 2);
}

/// Corners of faces that hang together around their vertex over edges of two faces.
Partition find_fans(const std::vector<Triangle>& triangles, const EdgeTable& table) {
  Partition fans(3 * triangles.size());
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto uses = table.uses(e);
    if (uses.size() != 2) continue;
    for (const VertexIndex v : table.edges[e])
      fans.join(corner_at(triangles, uses[0] / 3, v), corner_at(triangles, uses[1] / 3, v));
  }
  return fans;
}

/// Walks along open edges and counts a hole whenever the walk comes back to one of its vertices, and a walk that ends
/// at another kind of edge as one.
class HoleWalk {
 public:
  HoleWalk(std::size_t vertices, const std::vector<Edge>& open)
      : open_(open), walked_(open.size(), 0), on_path_(vertices, 0), first_(vertices + 1, 0), at_(2 * open.size()) {
    for (const Edge& e : open)
      for (const VertexIndex v : e) ++first_[v + 1];
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
    next_.assign(first_.begin(), first_.end() - 1);
    for (std::uint32_t k = 0; k < open.size(); ++k)
      for (const VertexIndex v : open[k]) at_[next_[v]++] = k;
    next_.assign(first_.begin(), first_.end() - 1);
  }

  std::uint64_t count() {
    std::uint64_t holes = 0;
    for (std::uint32_t k = 0; k < open_.size(); ++k)
      if (!walked_[k]) holes += walk_from(open_[k][0]);
    return holes;
  }

 private:
  std::uint64_t walk_from(VertexIndex start) {
    std::uint64_t holes = 0;
    path_.assign(1, start);
    on_path_[start] = 1;
    for (std::uint32_t k = take_edge(start); k != kNone; k = take_edge(path_.back())) {
      const VertexIndex v = open_[k][0] == path_.back() ? open_[k][1] : open_[k][0];
      if (on_path_[v]) {
        ++holes;
        for (; path_.back() != v; path_.pop_back()) on_path_[path_.back()] = 0;
      } else {
        on_path_[v] = 1;
        path_.push_back(v);
      }
    }
    if (path_.size() > 1) ++holes;
    for (const VertexIndex v : path_) on_path_[v] = 0;
    return holes;
  }

  std::uint32_t take_edge(VertexIndex v) {
    for (std::uint32_t& n = next_[v]; n < first_[v + 1]; ++n) {
      if (walked_[at_[n]]) continue;
      walked_[at_[n]] = 1;
      return at_[n];
    }
    return kNone;
  }

  const std::vector<Edge>& open_;
  std::vector<char> walked_, on_path_;            // per open edge; per vertex
  std::vector<std::uint32_t> first_, next_, at_;  // open edges at each vertex
  std::vector<VertexIndex> path_;
};

std::uint64_t count_holes(std::size_t vertices, const EdgeTable& table) {
  std::vector<Edge> open;
  for (std::size_t e = 0; e < table.size(); ++e)
    if (table.uses(e).size() == 1) open.push_back(table.edges[e]);
  return open.empty() ? 0 : HoleWalk(vertices, open).count();
}

void find_pinched_vertices(const RepairedSurface& repaired, const EdgeTable& table, Partition& fans,
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
    std::vector<std::uint32_t> faces{repaired.face_of_triangle[first_fan[v] / 3]};
    for (; i < further.size() && further[i].first == v; ++i)
      faces.push_back(repaired.face_of_triangle[further[i].second / 3]);
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
    for (const std::uint32_t h : uses) faces.push_back(repaired.face_of_triangle[h / 3]);
    const auto [a, b] = table.edges[e];
    FirstPlaces& kind = uses.size() == 1 ? open : uses.size() == 2 ? misoriented : non_manifold;
    kind.add(std::move(faces), (mesh.points[a] + mesh.points[b]) * 0.5);
  }
}

void find_bad_vertices(const RepairedSurface& repaired, const EdgeTable& table, SurfaceDefects& defects) {
  Partition fans = find_fans(repaired.surface.triangles, table);
  defects.open_loops = count_holes(repaired.surface.points.size(), table);
  find_pinched_vertices(repaired, table, fans, defects);
}

void find_degenerate_faces(const RepairedSurface& repaired, SurfaceDefects& defects) {
  const SurfaceMesh& mesh = repaired.surface;
  FirstPlaces places(defects.degenerate_faces);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    const Vec3 a = mesh.points[i], b = mesh.points[j], c = mesh.points[k];
    if (collinear(a, b, c)) places.add({repaired.face_of_triangle[t]}, (a + b + c) / 3);
  }
}

}  // namespace octafront::defects
