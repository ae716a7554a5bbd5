#include "base/core/flat_map.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/mesh/face_table.h"
#include "layers/through.h"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

namespace octafront::layers {

namespace {

/// Faces whose unit normals have a product below this look away from each other: as ThinWalls of the sizes has it.
constexpr double kMostCosine = -0.7;

/// A face of the boundary of a region, outward from it, at one of its corners.
struct WallCorner {
  std::uint32_t region;
  std::uint32_t face;  ///< among all of them
};

/// The faces that bound regions, by their corners.
class FacingWalls {
 public:
  explicit FacingWalls(const TetMesh& mesh) : mesh_(mesh) {
    std::vector<Triangle> keys;
    for (const auto* list : {&mesh.boundary, &mesh.interfaces})
      for (const Triangle& t : *list) keys.push_back(face_key(t));
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint8_t> is_on_wall(mesh.points.size(), 0);
    for (const Triangle& key : keys)
      for (const VertexIndex v : key) is_on_wall[v] = 1;
    at_.resize(mesh.points.size());
    for (TetIndex t = 0; t < mesh.tets.size(); ++t)
      for (int i = 0; i < 4; ++i) {
        const Triangle face = face_of(mesh.tets[t], i);
        if (!is_on_wall[face[0]] || !is_on_wall[face[1]] || !is_on_wall[face[2]]) continue;
        if (std::binary_search(keys.begin(), keys.end(), face_key(face))) add(face, region_of(t));
      }
  }

  std::uint32_t region_of(TetIndex t) const { return mesh_.region.empty() ? 0 : mesh_.region[t]; }
  bool has(VertexIndex v) const { return !at_[v].empty(); }

  /// Whether an edge that runs through the region joins two sides of it.
  bool are_joined(VertexIndex u, VertexIndex v, std::uint32_t region) const {
    for (const WallCorner& here : at_[u]) {
      if (here.region != region || !is_behind(v, here.face)) continue;
      for (const WallCorner& there : at_[v])
        if (there.region == region && dot(normal_[here.face], normal_[there.face]) < kMostCosine &&
            is_behind(u, there.face))
          return true;
    }
    return false;
  }

 private:
  void add(const Triangle& face, std::uint32_t region) {
    const auto number = static_cast<std::uint32_t>(faces_.size());
    faces_.push_back(face);
    normal_.push_back(unit_normal(mesh_.points[face[0]], mesh_.points[face[1]], mesh_.points[face[2]]));
    for (const VertexIndex v : face) at_[v].push_back({region, number});
  }

  bool is_behind(VertexIndex v, std::uint32_t face) const {
    const auto& [a, b, c] = faces_[face];
    return orient3d(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[v]) < 0;
  }

  const TetMesh& mesh_;
  std::vector<Triangle> faces_;
  std::vector<Vec3> normal_;
  std::vector<std::vector<WallCorner>> at_;  ///< by vertex
};

/// The edges between vertices on walls, with the regions of their elements; each pair once.
std::vector<std::pair<Edge, std::uint32_t>> edges_between_walls(const TetMesh& mesh, const FacingWalls& walls) {
  std::vector<std::pair<Edge, std::uint32_t>> edges;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (const auto& [i, j] : kTetEdges) {
      const VertexIndex u = mesh.tets[t][static_cast<std::size_t>(i)], v = mesh.tets[t][static_cast<std::size_t>(j)];
      if (walls.has(u) && walls.has(v)) edges.emplace_back(sorted_edge(u, v), walls.region_of(t));
    }
  parallel_sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Which side each vertex is of: neighbours by spans are of two sides where that is possible. The lowest vertex of what
/// hangs together is of side 0.
std::vector<std::uint8_t> sides_of(std::size_t vertices, const std::vector<Edge>& spans) {
  constexpr std::uint8_t kUnknown = 2;
  std::vector<std::vector<VertexIndex>> beside(vertices);
  for (const auto& [u, v] : spans) beside[u].push_back(v), beside[v].push_back(u);
  std::vector<std::uint8_t> side(vertices, kUnknown);
  std::vector<VertexIndex> stack;
  for (VertexIndex first = 0; first < vertices; ++first) {
    if (side[first] != kUnknown || beside[first].empty()) continue;
    side[first] = 0;
    stack.push_back(first);
    while (!stack.empty()) {
      const VertexIndex v = stack.back();
      stack.pop_back();
      for (const VertexIndex u : beside[v]) {
        if (side[u] != kUnknown) continue;
        side[u] = static_cast<std::uint8_t>(1 - side[v]);
        stack.push_back(u);
      }
    }
  }
  return side;
}

}  // namespace

std::vector<Span> spans_through_walls(const TetMesh& mesh, const RunContext& context) {
  const FacingWalls walls(mesh);
  context.check();
  const auto edges = edges_between_walls(mesh, walls);
  std::vector<std::uint8_t> is_span(edges.size(), 0);
  parallel_for(edges.size(), [&](std::size_t e) {
    const auto& [edge, region] = edges[e];
    is_span[e] = walls.are_joined(edge[0], edge[1], region);
  });
  std::vector<Edge> found;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (is_span[e] && (found.empty() || found.back() != edges[e].first)) found.push_back(edges[e].first);
  const std::vector<std::uint8_t> side = sides_of(mesh.points.size(), found);
  std::vector<Span> spans;
  for (const auto& [u, v] : found) spans.push_back(side[u] <= side[v] ? Span{u, v} : Span{v, u});
  return spans;
}

}  // namespace octafront::layers
