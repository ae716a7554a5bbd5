#include "soup/cells/close_gaps.h"

#include <octafront/surface_mesh.h>

#include "base/geometry/measures.h"
#include "base/geometry/plane_mesh.h"
#include "base/geometry/predicates.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

namespace octafront::cells {
namespace {

using arrangement::PlaneMesh;

Box3 grown(Box3 box, double by) {
  box.lo -= Vec3{by, by, by};
  box.hi += Vec3{by, by, by};
  return box;
}

/// Where two segments come nearest to each other, on the first one; nullopt if that is at an end of either, or they run
/// side by side.
struct GapMeeting {
  Vec3 at;
  double distance;
};
std::optional<GapMeeting> inner_meeting(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double det = uu * vv - uv * uv;
  // Sine below a millionth: vertices beside the other segment tell all that there is to tell.
  constexpr double kParallel = 1e-12;
  if (!(det > kParallel * uu * vv)) return std::nullopt;
  const double s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return std::nullopt;
  const Vec3 p = a + s * u, q = c + t * v;
  return GapMeeting{p, distance(p, q)};
}

/// Brings bodies together step by step.
class Closing {
 public:
  Closing(const BodySoup& soup, double tolerance, const RunContext& context)
      : triangles_(soup.triangles), body_(soup.body), tolerance_(tolerance), context_(context) {
    closed_.points = soup.points;
  }

  ClosedGaps result() {
    move_vertices();
    merge_equal_points();
    const TriangleTree tree(closed_.points, triangles_);
    find_contacts(tree);
    divide_edges();
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (t % 1024 == 0) context_.check();
      divide(t);
    }
    return std::move(closed_);
  }

 private:
  const std::vector<Vec3>& points() const { return closed_.points; }
  TriangleCorners corners(std::uint32_t t) const {
    const auto [a, b, c] = triangles_[t];
    return {points()[a], points()[b], points()[c]};
  }

  /// Vertices of each body but the first go onto what earlier ones have within the tolerance.
  void move_vertices() {
    const std::uint32_t bodies = body_.empty() ? 0 : 1 + *std::max_element(body_.begin(), body_.end());
    for (std::uint32_t b = 1; b < bodies; ++b) {
      context_.check();
      std::vector<Triangle> earlier;
      std::set<VertexIndex> vertices;
      for (std::size_t t = 0; t < triangles_.size(); ++t) {
        if (body_[t] < b) earlier.push_back(triangles_[t]);
        if (body_[t] == b) vertices.insert(triangles_[t].begin(), triangles_[t].end());
      }
      const TriangleTree tree(closed_.points, earlier);
      for (const VertexIndex v : vertices) move_vertex(v, tree, earlier);
    }
  }

  /// To a vertex rather than an edge, to an edge rather than a face.
  void move_vertex(VertexIndex v, const TriangleTree& tree, const std::vector<Triangle>& earlier) {
    const Vec3 p = closed_.points[v];
    std::array<double, 3> least{tolerance_, tolerance_, tolerance_};
    std::array<std::optional<Vec3>, 3> target;
    const auto offer = [&](std::size_t kind, Vec3 q) {
      const double d = distance(p, q);
      if (d > least[kind]) return;
      least[kind] = d;
      target[kind] = q;
    };
    Box3 here;
    here.add(p);
    tree.for_each_box_near(grown(here, tolerance_), [&](std::uint32_t t, const TriangleCorners& c) {
      for (int i = 0; i < 3; ++i) {
        offer(0, c[i]);
        // The same point from both sides of an edge.
        const Edge e = sorted_edge(earlier[t][i], earlier[t][(i + 1) % 3]);
        offer(1, closest_point_on_segment(p, points()[e[0]], points()[e[1]]));
      }
      offer(2, closest_point_on_triangle(p, c[0], c[1], c[2]));
      return true;
    });
    for (const auto& to : target) {
      if (!to) continue;
      if (*to == p) return;
      ++closed_.moved;
      closed_.largest_move = std::max(closed_.largest_move, distance(p, *to));
      closed_.points[v] = *to;
      return;
    }
  }

  void merge_equal_points() {
    std::map<std::array<double, 3>, VertexIndex> first;
    std::vector<VertexIndex> number(points().size());
    for (VertexIndex v = 0; v < number.size(); ++v) {
      const Vec3 p = points()[v];
      number[v] = first.try_emplace({p.x + 0.0, p.y + 0.0, p.z + 0.0}, v).first->second;
    }
    for (Triangle& t : triangles_)
      for (VertexIndex& v : t) v = number[v];
  }

  bool is_corner(std::uint32_t t, VertexIndex v) const {
    return std::find(triangles_[t].begin(), triangles_[t].end(), v) != triangles_[t].end();
  }

  bool is_degenerate(std::uint32_t t) const {
    const auto [a, b, c] = triangles_[t];
    return a == b || b == c || c == a || collinear(points()[a], points()[b], points()[c]);
  }

  /// Vertices near edges and faces of other bodies, and edges near edges.
  void find_contacts(const TriangleTree& tree) {
    std::set<std::array<Edge, 2>> compared;
    inside_.resize(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (t % 1024 == 0) context_.check();
      if (is_degenerate(t)) continue;
      Box3 box;
      for (const Vec3 p : corners(t)) box.add(p);
      tree.for_each_box_near(grown(box, tolerance_), [&](std::uint32_t s, const TriangleCorners&) {
        if (body_[s] == body_[t] || is_degenerate(s)) return true;
        for (const VertexIndex v : triangles_[s]) note_vertex(v, t);
        for (int i = 0; i < 3 && body_[s] > body_[t]; ++i)
          for (int j = 0; j < 3; ++j) {
            const Edge e = sorted_edge(triangles_[t][i], triangles_[t][(i + 1) % 3]);
            const Edge f = sorted_edge(triangles_[s][j], triangles_[s][(j + 1) % 3]);
            if (compared.insert({e, f}).second) note_edges(e, f);
          }
        return true;
      });
    }
    for (auto& inside : inside_) {
      std::sort(inside.begin(), inside.end());
      inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
    }
  }

  void note_vertex(VertexIndex v, std::uint32_t t) {
    if (is_corner(t, v)) return;
    const Vec3 p = points()[v];
    const TriangleCorners c = corners(t);
    if (distance(p, closest_point_on_triangle(p, c[0], c[1], c[2])) > tolerance_) return;
    bool on_edge = false;
    for (int i = 0; i < 3; ++i) {
      const Edge e = sorted_edge(triangles_[t][i], triangles_[t][(i + 1) % 3]);
      if (distance(p, closest_point_on_segment(p, points()[e[0]], points()[e[1]])) > tolerance_) continue;
      on_edge_[e].insert(v);
      on_edge = true;
    }
    if (!on_edge) inside_[t].push_back(v);
  }

  /// Edges that pass each other within the tolerance get a vertex there, on the earlier one's.
  void note_edges(const Edge& e, const Edge& f) {
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return;
    const auto meeting = inner_meeting(points()[e[0]], points()[e[1]], points()[f[0]], points()[f[1]]);
    if (!meeting || meeting->distance > tolerance_) return;
    // Not where an end of one lies on the other.
    for (const VertexIndex v : {e[0], e[1], f[0], f[1]})
      if (distance(points()[v], meeting->at) <= tolerance_) return;
    std::set<VertexIndex>& on_e = on_edge_[e];
    std::set<VertexIndex>& on_f = on_edge_[f];
    for (const std::set<VertexIndex>* known : {&on_e, &on_f})
      for (const VertexIndex v : *known)
        if (distance(points()[v], meeting->at) <= tolerance_) {
          on_e.insert(v);
          on_f.insert(v);
          return;
        }
    const auto v = static_cast<VertexIndex>(points().size());
    closed_.points.push_back(meeting->at);
    on_e.insert(v);
    on_f.insert(v);
  }

  /// The vertices along an edge, its ends too, from the smaller one on.
  std::vector<VertexIndex> along(const Edge& e) const {
    std::vector<VertexIndex> line{e[0]};
    if (const auto found = on_edge_.find(e); found != on_edge_.end())
      for (const VertexIndex v : found->second)
        if (v != e[0] && v != e[1]) line.push_back(v);
    const Vec3 from = points()[e[0]], to = points()[e[1]];
    std::sort(line.begin() + 1, line.end(), [&](VertexIndex a, VertexIndex b) {
      return std::pair(dot(points()[a] - from, to - from), a) < std::pair(dot(points()[b] - from, to - from), b);
    });
    line.push_back(e[1]);
    return line;
  }

  /// All edges as they are once divided, at their vertices.
  void divide_edges() {
    neighbours_.resize(points().size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (is_degenerate(t)) continue;
      for (int i = 0; i < 3; ++i) {
        const auto line = along(sorted_edge(triangles_[t][i], triangles_[t][(i + 1) % 3]));
        for (std::size_t k = 0; k + 1 < line.size(); ++k) add_edge(line[k], line[k + 1]);
      }
    }
  }

  void add_edge(VertexIndex a, VertexIndex b) {
    neighbours_[a].insert(b);
    neighbours_[b].insert(a);
  }

  /// The triangle divided at what lies on it, along the edges of other bodies between.
  void divide(std::uint32_t t) {
    if (is_degenerate(t)) return;
    std::vector<std::array<VertexIndex, 2>> border;
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
      const auto line = along(sorted_edge(a, b));
      for (std::size_t k = 0; k + 1 < line.size(); ++k) border.push_back({line[k], line[k + 1]});
    }
    if (border.size() == 3 && inside_[t].empty()) {
      add(triangles_[t], t);
      return;
    }
    divide(t, border);
  }

  void divide(std::uint32_t t, const std::vector<std::array<VertexIndex, 2>>& border) {
    const TriangleCorners c = corners(t);
    const Vec3 n = double_area_normal(c[0], c[1], c[2]);
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    std::vector<VertexIndex> local = inside_[t];
    for (const auto& [a, b] : border) local.insert(local.end(), {a, b});
    std::sort(local.begin(), local.end());
    local.erase(std::unique(local.begin(), local.end()), local.end());
    Box3 box;
    for (const VertexIndex v : local) box.add(points()[v]);

    PlaneMesh mesh(arrangement::plane_through(c[0], c[1], c[2]), axis, box);
    std::map<VertexIndex, PlaneMesh::Node> node;
    std::map<PlaneMesh::Node, VertexIndex> vertex;
    for (const VertexIndex v : local) {
      node[v] = mesh.add_point({points()[v]});
      vertex.try_emplace(node[v], v);
    }
    const auto add_segment = [&](VertexIndex a, VertexIndex b, std::uint32_t face) {
      if (node[a] == node[b]) return;
      mesh.add_segment(node[a], node[b], arrangement::plane_along_axis(points()[a], points()[b], axis), face);
    };
    for (const auto& [a, b] : border) add_segment(a, b, 0);
    for (const VertexIndex a : local)
      for (const VertexIndex b : neighbours_[a])
        if (a < b && std::binary_search(local.begin(), local.end(), b)) add_segment(a, b, kNone);
    mesh.improve();
    for (std::size_t i = 0; i < mesh.crossings().size(); ++i) {
      vertex[mesh.first_crossing_node(i)] = static_cast<VertexIndex>(points().size());
      closed_.points.push_back(mesh.crossings()[i].at);
      neighbours_.emplace_back();
    }
    const bool turned = arrangement::orient_along(axis, {c[0]}, {c[1]}, {c[2]}) < 0;
    for (const PlaneMesh::Piece& piece : mesh.pieces()) {
      Triangle made{vertex[piece.corners[0]], vertex[piece.corners[1]], vertex[piece.corners[2]]};
      if (turned) std::swap(made[1], made[2]);
      // Later triangles at the same place are divided in the same way.
      for (int i = 0; i < 3; ++i) add_edge(made[i], made[(i + 1) % 3]);
      add(made, t);
    }
  }

  void add(const Triangle& triangle, std::uint32_t source) {
    closed_.triangles.push_back(triangle);
    closed_.source.push_back(source);
  }

  std::vector<Triangle> triangles_;
  const std::vector<std::uint32_t>& body_;
  double tolerance_;
  const RunContext& context_;
  ClosedGaps closed_;
  std::map<Edge, std::set<VertexIndex>> on_edge_;
  std::vector<std::vector<VertexIndex>> inside_;   ///< per triangle
  std::vector<std::set<VertexIndex>> neighbours_;  ///< per vertex, by divided edges
};

}  // namespace

ClosedGaps close_gaps(const BodySoup& soup, double tolerance, const RunContext& context) {
  if (tolerance > 0) return Closing(soup, tolerance, context).result();
  ClosedGaps same{soup.points, soup.triangles, {}, 0, 0};
  same.source.resize(soup.triangles.size());
  std::iota(same.source.begin(), same.source.end(), 0);
  return same;
}

}  // namespace octafront::cells
