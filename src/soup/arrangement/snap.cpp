#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "soup/arrangement/arranging.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace octafront::arrangement {
namespace {

using Vertices = std::vector<VertexIndex>;

class Snapper {
 public:
  Snapper(Soup& soup, double reach) : soup_(soup), reach_(reach) {}

  double result(std::span<const std::array<std::uint32_t, 2>> pairs) {
    for (const auto& pair : pairs) concerned_.insert(concerned_.end(), pair.begin(), pair.end());
    std::sort(concerned_.begin(), concerned_.end());
    concerned_.erase(std::unique(concerned_.begin(), concerned_.end()), concerned_.end());
    for (const std::uint32_t t : concerned_)
      vertices_.insert(vertices_.end(), soup_.triangles[t].begin(), soup_.triangles[t].end());
    sort_vertices();
    merge_vertices();
    find_vertices_on_edges();
    find_vertices_in_faces();
    divide();
    return most_;
  }

 private:
  Vec3 at(VertexIndex v) const { return soup_.points[v]; }

  void sort_vertices() {
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }

  void merge_vertices() {
    std::map<std::array<double, 3>, Vertices> kept;
    Vertices becomes(soup_.points.size());
    for (VertexIndex v = 0; v < becomes.size(); ++v) becomes[v] = v;
    for (const VertexIndex v : vertices_) {
      becomes[v] = near(kept, v);
      most_ = std::max(most_, distance(at(v), at(becomes[v])));
      if (becomes[v] == v) kept[cell_of(at(v))].push_back(v);
    }
    for (Triangle& t : soup_.triangles)
      for (VertexIndex& v : t) v = becomes[v];
    for (VertexIndex& v : vertices_) v = becomes[v];
    sort_vertices();
  }

  std::array<double, 3> cell_of(Vec3 p) const {
    return {std::floor(p.x / reach_), std::floor(p.y / reach_), std::floor(p.z / reach_)};
  }

  /// The first vertex kept within reach, or the vertex itself.
  VertexIndex near(const std::map<std::array<double, 3>, Vertices>& kept, VertexIndex v) const {
    const auto [x, y, z] = cell_of(at(v));
    VertexIndex first = v;
    for (const double dx : {-1, 0, 1})
      for (const double dy : {-1, 0, 1})
        for (const double dz : {-1, 0, 1}) {
          const auto cell = kept.find({x + dx, y + dy, z + dz});
          if (cell == kept.end()) continue;
          for (const VertexIndex w : cell->second)
            if (w < first && distance(at(v), at(w)) <= reach_) first = w;
        }
    return first;
  }

  static bool has_area(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }
  static Edge edge_of(const Triangle& t, std::size_t i) {
    return {std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])};
  }

  void find_vertices_on_edges() {
    std::vector<Edge> edges;
    for (const std::uint32_t t : concerned_)
      for (std::size_t i = 0; i < 3; ++i)
        if (has_area(soup_.triangles[t])) edges.push_back(edge_of(soup_.triangles[t], i));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const TriangleTree tree = tree_of_segments(soup_.points, edges);
    for (const VertexIndex v : vertices_)
      tree.for_each_box_near(Box3{at(v), at(v)}.grown(reach_), [&](std::uint32_t e, const TriangleCorners&) {
        const auto [a, b] = edges[e];
        if (a == v || b == v) return true;
        const Vec3 q = closest_point_on_segment(at(v), at(a), at(b));
        if (q != at(a) && q != at(b) && distance(q, at(v)) <= reach_) on_edge_[edges[e]].push_back(v);
        return true;
      });
    for (auto& [edge, vertices] : on_edge_) {
      const Vec3 from = at(edge[0]), along = at(edge[1]) - from;
      std::sort(vertices.begin(), vertices.end(), [&](VertexIndex v, VertexIndex w) {
        return std::pair(dot(at(v) - from, along), v) < std::pair(dot(at(w) - from, along), w);
      });
    }
  }

  void find_vertices_in_faces() {
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> number;
    for (const std::uint32_t t : concerned_) {
      if (!has_area(soup_.triangles[t])) continue;
      faces.push_back(soup_.triangles[t]);
      number.push_back(t);
    }
    const TriangleTree tree(soup_.points, faces);
    for (const VertexIndex v : vertices_)
      tree.for_each_box_near(Box3{at(v), at(v)}.grown(reach_), [&](std::uint32_t f, const TriangleCorners& c) {
        if (std::find(faces[f].begin(), faces[f].end(), v) != faces[f].end()) return true;
        if (distance(at(v), closest_point_on_triangle(at(v), c[0], c[1], c[2])) > reach_) return true;
        for (std::size_t i = 0; i < 3; ++i)
          if (distance(at(v), closest_point_on_segment(at(v), c[i], c[(i + 1) % 3])) <= reach_) return true;
        in_face_[number[f]].push_back(v);
        return true;
      });
  }

  void divide() {
    const std::size_t n = soup_.triangles.size();
    for (std::uint32_t t = 0; t < n; ++t) {
      if (!has_area(soup_.triangles[t])) continue;
      if (is_flat(soup_.triangles[t])) {
        soup_.triangles[t] = {};
        continue;
      }
      std::vector<Triangle> pieces;
      divide_at_edges(soup_.triangles[t], {true, true, true}, pieces);
      if (const auto inside = in_face_.find(t); inside != in_face_.end())
        for (const VertexIndex v : inside->second) divide_inside(v, pieces);
      soup_.triangles[t] = pieces.front();
      for (std::size_t i = 1; i < pieces.size(); ++i) {
        soup_.triangles.push_back(pieces[i]);
        soup_.origins.push_back(std::vector<Origin>(soup_.origins[t]));
      }
    }
  }

  /// Whether the opposite corner lies on an edge: what is beyond the edges fits without the triangle.
  bool is_flat(const Triangle& t) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto found = on_edge_.find(edge_of(t, i));
      if (found == on_edge_.end()) continue;
      if (std::find(found->second.begin(), found->second.end(), t[(i + 2) % 3]) != found->second.end()) return true;
    }
    return false;
  }

  /// Which sides of a piece are sides of the triangle that it comes from, whole.
  using WholeSides = std::array<bool, 3>;

  /// A fan from the corner opposite to a divided edge; its outer edges may be divided in turn.
  void divide_at_edges(const Triangle& t, const WholeSides& whole, std::vector<Triangle>& pieces) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexIndex a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      const auto found = on_edge_.find(edge_of(t, i));
      if (!whole[i] || found == on_edge_.end()) continue;
      Vertices between = found->second;
      if (a > b) std::reverse(between.begin(), between.end());
      VertexIndex last = a;
      between.push_back(b);
      for (const VertexIndex v : between) {
        const bool is_first = last == a, is_last = v == b;
        divide_at_edges({std::exchange(last, v), v, c},
                        {false, is_last && whole[(i + 1) % 3], is_first && whole[(i + 2) % 3]}, pieces);
      }
      return;
    }
    pieces.push_back(t);
  }

  /// In the piece that it lies deepest in.
  void divide_inside(VertexIndex v, std::vector<Triangle>& pieces) const {
    const auto depth = [&](const Triangle& t) {
      const Vec3 n = unit_normal(at(t[0]), at(t[1]), at(t[2]));
      double least = HUGE_VAL;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = at(t[(i + 1) % 3]) - at(t[i]);
        least = std::min(least, dot(cross(n, normalized(edge)), at(v) - at(t[i])));
      }
      return least;
    };
    std::size_t deepest = 0;
    for (std::size_t i = 1; i < pieces.size(); ++i)
      if (depth(pieces[i]) > depth(pieces[deepest])) deepest = i;
    const auto [a, b, c] = pieces[deepest];
    if (a == v || b == v || c == v) return;
    pieces[deepest] = {a, b, v};
    pieces.push_back({b, c, v});
    pieces.push_back({c, a, v});
  }

  Soup& soup_;
  double reach_, most_ = 0;
  std::vector<std::uint32_t> concerned_;  ///< triangles
  Vertices vertices_;                     ///< theirs
  std::map<Edge, Vertices> on_edge_;
  std::map<std::uint32_t, Vertices> in_face_;
};

}  // namespace

double snap(Soup& soup, std::span<const std::array<std::uint32_t, 2>> pairs, double reach) {
  return Snapper(soup, reach).result(pairs);
}

}  // namespace octafront::arrangement
