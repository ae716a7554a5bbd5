

#include "base/geometry/measures.h"
#include "base/geometry/plane_mesh.h"
#include "base/geometry/predicates.h"
#include "base/geometry/same_place.h"
#include "base/geometry/triangle_tree.h"
#include "soup/cells/cell_steps.h"

#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

namespace octafront::cells {
namespace {

using arrangement::PlaneMesh;

/// What goes along a wall rather than across it goes by no more than this part of the edges there: they stay edges.
constexpr double kOfEdge = 0.25;
/// Walls of later bodies are bent to what is that many times farther away than their own vertices were moved: where
/// these came nearer, the middle went away.
constexpr double kBend = 1.5;

/// Where two segments come nearest to each other; nullopt if that is at an end of either, or they run side by side.
struct GapMeeting {
  Vec3 at, other;
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
  return GapMeeting{a + s * u, c + t * v};
}

/// Shortest edges at vertices.
class Lengths {
 public:
  explicit Lengths(const std::vector<Vec3>& points) : points_(points) {}
  void add(const Triangle& t) {
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = t[i], b = t[(i + 1) % 3];
      const double d = distance(points_[a], points_[b]);
      if (d == 0) continue;
      for (const VertexIndex v : {a, b}) {
        if (v >= shortest_.size()) shortest_.resize(points_.size(), TriangleTree::kFar);
        shortest_[v] = std::min(shortest_[v], d);
      }
    }
  }
  double at(VertexIndex v) const { return v < shortest_.size() ? shortest_[v] : TriangleTree::kFar; }

 private:
  const std::vector<Vec3>& points_;
  std::vector<double> shortest_;
};

TriangleCorners wall_corners(const std::vector<Vec3>& points, const Triangle& t) {
  return {points[t[0]], points[t[1]], points[t[2]]};
}
bool has_no_area(const std::vector<Vec3>& points, const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || collinear(points[t[0]], points[t[1]], points[t[2]]);
}

/// One side of a meeting: faces, with what it takes to find them.
struct Party {
  std::vector<BodyFace> faces;
  std::vector<Triangle> triangles;
  std::vector<Vec3> normals;
  std::map<VertexIndex, std::vector<std::uint32_t>> around;
  std::set<Edge> ends;                               ///< where sheets end
  std::map<Edge, std::vector<std::uint32_t>> sharp;  ///< where walls turn, or end; and these
  std::set<VertexIndex> sharp_vertices;
  std::set<VertexIndex> end_vertices;

  Party(std::vector<BodyFace> given, const std::vector<Vec3>& points) : faces(std::move(given)) {
    for (const BodyFace& f : faces) {
      const auto [a, b, c] = f.corners;
      triangles.push_back(f.corners);
      normals.push_back(unit_normal(points[a], points[b], points[c]));
    }
    find_around();
    find_ends();
  }
  void find_ends() {
    ends.clear();
    end_vertices.clear();
    sharp.clear();
    sharp_vertices.clear();
    std::map<Edge, std::vector<std::uint32_t>> uses;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) uses[sorted_edge(triangles[t][i], triangles[t][(i + 1) % 3])].push_back(t);
    for (const auto& [e, of] : uses) {
      if (e[0] == e[1]) continue;
      if (of.size() != 2 || !is_curved(normals[of[0]], normals[of[1]])) {
        sharp.emplace(e, of);
        sharp_vertices.insert(e.begin(), e.end());
      }
      if (of.size() != 1) continue;
      ends.insert(e);
      end_vertices.insert(e.begin(), e.end());
    }
  }
  std::vector<Edge> edges() const {
    std::vector<Edge> all;
    for (const Triangle& t : triangles)
      for (int i = 0; i < 3; ++i) all.push_back(sorted_edge(t[i], t[(i + 1) % 3]));
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::erase_if(all, [](const Edge& e) { return e[0] == e[1]; });
    return all;
  }
  void find_around() {
    around.clear();
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (const VertexIndex v : triangles[t]) around[v].push_back(t);
  }
};

/// What lies on edges of walls.
class EdgeVertices {
 public:
  explicit EdgeVertices(const std::vector<Vec3>& points) : points_(points) {}

  std::set<VertexIndex>& operator[](const Edge& e) { return vertices_[e]; }

  /// The vertices along an edge, its ends too, from the smaller one on.
  std::vector<VertexIndex> along(const Edge& e) const {
    std::vector<VertexIndex> line{e[0]};
    if (const auto found = vertices_.find(e); found != vertices_.end())
      for (const VertexIndex v : found->second)
        if (v != e[0] && v != e[1]) line.push_back(v);
    const Vec3 from = points_[e[0]], to = points_[e[1]];
    std::sort(line.begin() + 1, line.end(), [&](VertexIndex a, VertexIndex b) {
      return std::pair(dot(points_[a] - from, to - from), a) < std::pair(dot(points_[b] - from, to - from), b);
    });
    line.push_back(e[1]);
    return line;
  }

  /// The edges that each vertex lies on.
  using Lines = std::unordered_map<VertexIndex, std::vector<Edge>>;
  Lines lines_of(const std::vector<Edge>& edges) const {
    Lines lines;
    for (const Edge& e : edges)
      for (const VertexIndex v : along(e)) lines[v].push_back(e);
    return lines;
  }
  static std::vector<Edge> common_edges(const Lines& lines, VertexIndex a, VertexIndex b) {
    std::vector<Edge> common;
    const auto of_a = lines.find(a), of_b = lines.find(b);
    if (of_a == lines.end() || of_b == lines.end()) return common;
    std::set_intersection(of_a->second.begin(), of_a->second.end(), of_b->second.begin(), of_b->second.end(),
                          std::back_inserter(common));
    return common;
  }

 private:
  const std::vector<Vec3>& points_;
  std::map<Edge, std::set<VertexIndex>> vertices_;
};

/// Walls divided at what lies on them, and along the edges between.
class WallDivider {
 public:
  WallDivider(std::vector<Vec3>& points, const EdgeVertices& on_edge, const RunContext& context)
      : points_(points), on_edge_(on_edge), context_(context) {}

  void add_edge(VertexIndex a, VertexIndex b) {
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }

  /// `inside`: what lies inside of triangles.
  void divide(const Party& party, std::map<std::uint32_t, std::vector<VertexIndex>>& inside,
              std::vector<BodyFace>& divided) {
    std::vector<Border> borders;
    for (const Triangle& t : party.triangles) {
      borders.push_back(has_no_area(points_, t) ? Border{} : border_of(t));
      for (const auto& [a, b] : borders.back()) add_edge(a, b);
    }
    for (std::uint32_t t = 0; t < party.triangles.size(); ++t) {
      if (t % 1024 == 0) context_.check();
      if (borders[t].empty()) continue;
      const auto within = inside.find(t);
      BodyFace face = party.faces[t];
      face.corners = party.triangles[t];
      if (borders[t].size() == 3 && within == inside.end())
        divided.push_back(face);
      else
        divide(face, borders[t], within == inside.end() ? std::vector<VertexIndex>{} : within->second, divided);
    }
  }

 private:
  using Border = std::vector<std::array<VertexIndex, 2>>;

  Border border_of(const Triangle& t) const {
    Border border;
    for (int i = 0; i < 3; ++i) {
      std::vector<VertexIndex> line = on_edge_.along(sorted_edge(t[i], t[(i + 1) % 3]));
      if (t[i] > t[(i + 1) % 3]) std::reverse(line.begin(), line.end());
      for (std::size_t k = 0; k + 1 < line.size(); ++k) border.push_back({line[k], line[k + 1]});
    }
    return border;
  }

  /// The triangle divided at what lies on it, along the edges of other bodies between.
  void divide(const BodyFace& face, const Border& border, std::vector<VertexIndex> local,
              std::vector<BodyFace>& divided) {
    const TriangleCorners c = wall_corners(points_, face.corners);
    const Vec3 n = double_area_normal(c[0], c[1], c[2]);
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    for (const auto& [a, b] : border) local.push_back(a);
    std::sort(local.begin(), local.end());
    local.erase(std::unique(local.begin(), local.end()), local.end());
    Box3 box;
    for (const VertexIndex v : local) box.add(points_[v]);

    PlaneMesh mesh(arrangement::plane_through(c[0], c[1], c[2]), axis, box);
    std::map<VertexIndex, PlaneMesh::Node> node;
    std::map<PlaneMesh::Node, VertexIndex> vertex;
    for (const VertexIndex v : local) {
      node[v] = mesh.add_point({points_[v]});
      vertex.try_emplace(node[v], v);
    }
    const auto add_segment = [&](VertexIndex a, VertexIndex b, std::uint32_t of) {
      if (node[a] == node[b]) return;
      mesh.add_segment(node[a], node[b], arrangement::plane_along_axis(points_[a], points_[b], axis), of);
    };
    const auto turn = [&](VertexIndex a, VertexIndex b, VertexIndex v) {
      return arrangement::orient_along(axis, {points_[a]}, {points_[b]}, {points_[v]});
    };
    const auto leaves = [&](VertexIndex a, VertexIndex b) {
      return std::any_of(border.begin(), border.end(), [&](const auto& e) {
        return turn(a, b, e[0]) * turn(a, b, e[1]) < 0 && turn(e[0], e[1], a) * turn(e[0], e[1], b) < 0;
      });
    };
    for (const auto& [a, b] : border) add_segment(std::min(a, b), std::max(a, b), 0);
    for (const VertexIndex a : local) {
      std::vector<VertexIndex>& others = neighbours_[a];
      std::sort(others.begin(), others.end());
      others.erase(std::unique(others.begin(), others.end()), others.end());
      for (const VertexIndex b : others)
        if (a < b && std::binary_search(local.begin(), local.end(), b) && !leaves(a, b)) add_segment(a, b, kNone);
    }
    mesh.improve();
    const auto first_new = static_cast<VertexIndex>(points_.size());
    for (std::size_t i = 0; i < mesh.crossings().size(); ++i) {
      vertex[mesh.first_crossing_node(i)] = static_cast<VertexIndex>(points_.size());
      points_.push_back(mesh.crossings()[i].at);
    }
    const bool turned = turn(face.corners[0], face.corners[1], face.corners[2]) < 0;
    std::vector<Triangle> made;
    for (const PlaneMesh::Piece& piece : mesh.pieces()) {
      made.push_back({vertex[piece.corners[0]], vertex[piece.corners[1]], vertex[piece.corners[2]]});
      if (turned) std::swap(made.back()[1], made.back()[2]);
    }
    if (!fills(made, border)) {
      points_.resize(first_new);
      made.clear();
      for (const auto& [a, b] : border)
        if (a != border.front()[0] && b != border.front()[0]) made.push_back({border.front()[0], a, b});
    }
    for (const Triangle& t : made) {
      // Later triangles at the same place are divided in the same way.
      for (int i = 0; i < 3; ++i) add_edge(t[i], t[(i + 1) % 3]);
      divided.push_back({t, face.body, face.source});
    }
  }

  /// Whether the pieces have that border: where it was bent so far that it crosses itself they have not.
  static bool fills(const std::vector<Triangle>& pieces, const Border& border) {
    std::map<Edge, int> ways;
    const auto add = [&](VertexIndex a, VertexIndex b, int times) {
      ways[sorted_edge(a, b)] += a < b ? times : -times;
    };
    for (const Triangle& t : pieces)
      for (int i = 0; i < 3; ++i) add(t[i], t[(i + 1) % 3], 1);
    for (const auto& [a, b] : border) add(a, b, -1);
    return std::all_of(ways.begin(), ways.end(), [](const auto& way) { return way.second == 0; });
  }

  std::vector<Vec3>& points_;
  const EdgeVertices& on_edge_;
  const RunContext& context_;
  std::unordered_map<VertexIndex, std::vector<VertexIndex>> neighbours_;  ///< by divided edges
};

/// A body that comes to those before it.
class BodyMeeting {
 public:
  BodyMeeting(std::vector<Vec3>& points, std::vector<BodyFace> earlier, std::vector<BodyFace> later,
              const Misfits& misfits, Rims rims, const Lengths& lengths, const RunContext& context)
      : points_(points),
        earlier_(std::move(earlier), points),
        later_(std::move(later), points),
        body_(later_.faces.front().body),
        misfits_(misfits),
        rims_(rims),
        lengths_(lengths),
        context_(context),
        on_edge_(points) {
    for (const BodyFace& f : earlier_.faces) most_ = std::max(most_, reach(f));
  }

  void run() {
    const TriangleTree earlier(points_, earlier_.triangles);
    move_vertices(earlier, TriangleTree(points_, later_.triangles));
    merge_equal_points();
    kept_edges_ = earlier_.edges();
    const TriangleTree later(points_, later_.triangles);
    put_vertices_on(later, earlier_, later_, inside_later_, true);
    put_vertices_on(earlier, later_, earlier_, inside_earlier_, false);
    find_settled();
    cross_edges(earlier, later);
    follow_edges();
    WallDivider divider(points_, on_edge_, context_);
    // Where the later body's walls turn, they may leave the earlier ones.
    for (const auto& [f, of] : later_.sharp) {
      const std::vector<VertexIndex> line = on_edge_.along(f);
      for (std::size_t k = 0; k + 1 < line.size(); ++k) divider.add_edge(line[k], line[k + 1]);
    }
    divider.divide(earlier_, inside_earlier_, divided_earlier);
    divider.divide(later_, inside_later_, divided_later);
    const bool was_apart = misfits_.largest() > misfits_.floor();
    if (was_apart && later_.ends.empty()) share_walls(points_, divided_earlier, divided_later, misfits_, context_);
  }

  std::vector<BodyFace> divided_earlier, divided_later;
  std::uint64_t moved = 0;
  double largest_move = 0;

 private:
  double reach(const BodyFace& f) const { return misfits_.reach(f.body, body_); }

  bool faces_wall(const Party& of, VertexIndex v, Vec3 normal, Vec3 way) const {
    if (&of == &later_ && of.end_vertices.contains(v)) return true;
    const std::vector<std::uint32_t>& around = of.around.at(v);
    return std::any_of(around.begin(), around.end(),
                       [&](std::uint32_t t) { return face_each_other(of.normals[t], normal, way); });
  }

  /// Whether a vertex that goes so to a wall with normal n goes along it by little, beside the edges at the vertex.
  bool is_across(VertexIndex v, Vec3 n, Vec3 way) const {
    const double along = length(way - dot(way, n) * n);
    return along <= std::max(misfits_.floor(), kOfEdge * lengths_.at(v));
  }

  /// Whether another wall of the later body lies between p, on it, and q: that one goes to q.
  bool is_behind(const TriangleTree& own, Vec3 p, Vec3 q) const {
    constexpr double kHalf = 0.5;
    const double within = kHalf * distance(p, q);
    if (within <= misfits_.floor()) return false;
    return !own.for_each_box_near(Box3{q, q}.grown(within), [&](std::uint32_t u, const TriangleCorners& c) {
      const Vec3 nearest = closest_point_on_triangle(q, c[0], c[1], c[2]);
      return distance(nearest, q) > within || dot(later_.normals[u], p - nearest) > -within;
    });
  }

  /// Whether a vertex of the later body lies on walls that turn as those at an edge of earlier ones do.
  bool is_same_corner(VertexIndex v, const Edge& e) const {
    const auto found = earlier_.sharp.find(e);
    if (found == earlier_.sharp.end()) return false;
    const std::vector<std::uint32_t>& around = later_.around.at(v);
    return std::all_of(found->second.begin(), found->second.end(), [&](std::uint32_t t) {
      return std::any_of(around.begin(), around.end(), [&](std::uint32_t s) {
        return face_each_other(later_.normals[s], earlier_.normals[t], earlier_.normals[t]);
      });
    });
  }

  void move_vertices(const TriangleTree& tree, const TriangleTree& own) {
    // The largest misfit first: where three bodies meet, corners are near each other only once they are on the same
    // wall.
    std::set<double, std::greater<>> reaches;
    for (const BodyFace& f : earlier_.faces) reaches.insert(reach(f));
    for (const double r : reaches)
      for (const auto& [v, around] : later_.around) move_vertex(v, tree, own, r);
  }

  /// Onto the nearest place of a wall that it belongs to: to a vertex rather than an edge, to an edge rather than a
  /// face, if these are near beside the edges there; from where walls turn to where they turn, before all.
  void move_vertex(VertexIndex v, const TriangleTree& tree, const TriangleTree& own, double of_reach) {
    const Vec3 p = points_[v];
    const double floor = misfits_.floor();
    double nearest = TriangleTree::kFar;
    Vec3 at;
    tree.for_each_box_near(Box3{p, p}.grown(of_reach), [&](std::uint32_t t, const TriangleCorners& c) {
      if (reach(earlier_.faces[t]) != of_reach) return true;
      const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
      const double d = distance(p, q);
      if (d > of_reach || d >= nearest) return true;
      if (d > floor && !faces_wall(later_, v, earlier_.normals[t], p - q)) return true;
      if (!is_across(v, earlier_.normals[t], p - q) || is_behind(own, p, q)) return true;
      nearest = d;
      at = q;
      return true;
    });
    if (nearest > of_reach) return;
    // Up to rounding what is nearest, whatever the edges.
    const double here = nearest * (1 + 1e-9);
    constexpr double kFar = TriangleTree::kFar;
    std::array<double, 4> least{kFar, kFar, kFar, kFar};
    std::array<Vec3, 4> target;
    const bool is_sharp = later_.sharp_vertices.contains(v);
    const auto offer = [&](std::size_t kind, Vec3 q, double edge) {
      const double d = distance(p, q);
      const double beside = is_sharp && kind > 1 && rims_ == Rims::kKeep ? 0 : kOfEdge * std::min(edge, lengths_.at(v));
      const double along = kind == 1 ? of_reach : std::min(of_reach, beside);
      if (d > std::max({here, floor, along})) return;
      if (d >= least[kind]) return;
      least[kind] = d;
      target[kind] = q;
    };
    tree.for_each_box_near(Box3{p, p}.grown(of_reach), [&](std::uint32_t t, const TriangleCorners&) {
      if (reach(earlier_.faces[t]) != of_reach) return true;
      for (int i = 0; i < 3; ++i) {
        const Triangle& corners = earlier_.triangles[t];
        const bool at_sharp = is_sharp && earlier_.sharp_vertices.contains(corners[i]);
        offer(at_sharp ? 0 : 2, points_[corners[i]], lengths_.at(corners[i]));
        // The same point from both sides of an edge.
        const Edge e = sorted_edge(corners[i], corners[(i + 1) % 3]);
        offer(is_sharp && is_same_corner(v, e) ? 1 : 3, closest_point_on_segment(p, points_[e[0]], points_[e[1]]),
              distance(points_[e[0]], points_[e[1]]));
      }
      return true;
    });
    const auto best = std::find_if(least.begin(), least.end(), [](double d) { return d < kFar; });
    if (best != least.end()) at = target[static_cast<std::size_t>(best - least.begin())];
    if (at == p) return;
    ++moved;
    largest_move = std::max(largest_move, distance(p, at));
    points_[v] = at;
  }

  void merge_equal_points() {
    VerticesByPlace first;
    const auto number = [&](VertexIndex v) { return first.add(points_[v], v); };
    for (const auto& [v, around] : earlier_.around) number(v);
    for (Triangle& t : later_.triangles)
      for (VertexIndex& v : t) v = number(v);
    later_.find_around();
    later_.find_ends();
  }

  /// Whether the edge of the later body is where a sheet ends: that goes on to walls any way.
  bool is_end(const Edge& e) const { return later_.ends.contains(e); }
  bool is_near_end(Vec3 p, const Triangle& t, double within) const {
    for (int i = 0; i < 3; ++i) {
      const Edge e = sorted_edge(t[i], t[(i + 1) % 3]);
      if (is_end(e) && distance(p, closest_point_on_segment(p, points_[e[0]], points_[e[1]])) <= within) return true;
    }
    return false;
  }

  bool is_kept(const Edge& e) const { return std::binary_search(kept_edges_.begin(), kept_edges_.end(), e); }

  /// Vertices that belong to walls of the other party, on its edges or faces; earlier walls take what lies on them.
  void put_vertices_on(const TriangleTree& tree, const Party& of, const Party& on,
                       std::map<std::uint32_t, std::vector<VertexIndex>>& inside, bool bends) {
    for (const auto& [v, around] : of.around) {
      if (on.around.contains(v)) continue;
      double most = misfits_.floor();
      if (bends)
        for (const std::uint32_t t : around) most = std::max(most, kBend * reach(of.faces[t]));
      put_vertex_on(v, most, tree, of, on, inside, bends);
    }
  }

  void put_vertex_on(VertexIndex v, double most, const TriangleTree& tree, const Party& of, const Party& on,
                     std::map<std::uint32_t, std::vector<VertexIndex>>& inside, bool bends) {
    const Vec3 p = points_[v];
    const double floor = misfits_.floor();
    double nearest = TriangleTree::kFar;
    std::uint32_t face = kNone;
    const auto each_near = [&](double within, auto&& visit) {
      tree.for_each_box_near(Box3{p, p}.grown(within), [&](std::uint32_t t, const TriangleCorners& c) {
        if (has_no_area(points_, on.triangles[t])) return true;
        visit(t, c);
        return true;
      });
    };
    each_near(most, [&](std::uint32_t t, const TriangleCorners& c) {
      const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
      const double d = distance(p, q);
      if (d > most || d > nearest || (d == nearest && t > face)) return;
      if (d > floor && !faces_wall(of, v, on.normals[t], p - q) &&
          !(bends && is_near_end(p, on.triangles[t], d * (1 + 1e-9))))
        return;
      nearest = d;
      face = t;
    });
    if (face == kNone) return;
    double least = TriangleTree::kFar;
    std::vector<std::pair<double, Edge>> edges;
    each_near(std::max(nearest, floor) * (1 + 1e-9), [&](std::uint32_t t, const TriangleCorners&) {
      for (int i = 0; i < 3; ++i) {
        const Edge e = sorted_edge(on.triangles[t][i], on.triangles[t][(i + 1) % 3]);
        if (bends && is_kept(e)) continue;
        const double d = distance(p, closest_point_on_segment(p, points_[e[0]], points_[e[1]]));
        const double along = bends ? std::min(most, kOfEdge * distance(points_[e[0]], points_[e[1]])) : 0;
        if (d > std::max({floor, nearest * (1 + 1e-9), along})) continue;
        edges.emplace_back(d, e);
        least = std::min(least, d);
      }
    });
    if (edges.empty()) {
      inside[face].push_back(v);
      return;
    }
    const auto is_sharp = [&](const auto& edge) { return on.sharp.contains(edge.second); };
    if (of.sharp_vertices.contains(v) && std::any_of(edges.begin(), edges.end(), is_sharp)) {
      std::erase_if(edges, [&](const auto& edge) { return !is_sharp(edge); });
      least = std::min_element(edges.begin(), edges.end())->first;
    }
    for (const auto& [d, e] : edges)
      if (d <= std::max(floor, least)) on_edge_[e].insert(v);
  }

  /// Edges that pass each other on one wall get a vertex there, on the earlier one's.
  void cross_edges(const TriangleTree& tree, const TriangleTree& own) {
    std::set<std::array<Edge, 2>> crossed;
    for (std::uint32_t s = 0; s < later_.triangles.size(); ++s) {
      if (s % 1024 == 0) context_.check();
      if (has_no_area(points_, later_.triangles[s])) continue;
      tree.for_each_box_near(box_of(wall_corners(points_, later_.triangles[s])).grown(kBend * most_),
                             [&](std::uint32_t t, const TriangleCorners&) {
                               cross_edges_of(t, s, own, crossed);
                               return true;
                             });
    }
  }

  void cross_edges_of(std::uint32_t t, std::uint32_t s, const TriangleTree& own,
                      std::set<std::array<Edge, 2>>& crossed) {
    const double most = std::max(misfits_.floor(), kBend * reach(earlier_.faces[t]));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const Edge e = sorted_edge(earlier_.triangles[t][i], earlier_.triangles[t][(i + 1) % 3]);
        const Edge f = sorted_edge(later_.triangles[s][j], later_.triangles[s][(j + 1) % 3]);
        if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1] || is_kept(f)) continue;
        if (settled_.contains(e) || settled_.contains(f)) continue;
        const auto meeting = inner_meeting(points_[e[0]], points_[e[1]], points_[f[0]], points_[f[1]]);
        if (!meeting) continue;
        const Vec3 way = meeting->at - meeting->other;
        if (length(way) > most) continue;
        if (length(way) > misfits_.floor() && !is_end(f) &&
            !face_each_other(later_.normals[s], earlier_.normals[t], way))
          continue;
        if (is_behind(own, meeting->other, meeting->at)) continue;
        if (crossed.insert({e, f}).second) cross(e, f, *meeting, most);
      }
  }

  void cross(const Edge& e, const Edge& f, const GapMeeting& meeting, double most) {
    std::set<VertexIndex>& on_e = on_edge_[e];
    std::set<VertexIndex>& on_f = on_edge_[f];
    const double shorter = std::min(distance(points_[e[0]], points_[e[1]]), distance(points_[f[0]], points_[f[1]]));
    const bool bends = rims_ == Rims::kBend || !later_.sharp.contains(f) || earlier_.sharp.contains(e);
    const double near = std::max(misfits_.floor(), bends ? std::min(most, kOfEdge * shorter) : 0);
    // What lies on the earlier edge there is where the later one goes through.
    std::optional<VertexIndex> known;
    double least = near;
    const auto offer = [&](VertexIndex v) {
      const double d = distance(points_[v], meeting.at);
      if (d > least) return;
      least = d;
      known = v;
    };
    for (const VertexIndex v : e) offer(v);
    for (const VertexIndex v : on_e) offer(v);
    if (known) {
      if (*known != f[0] && *known != f[1]) on_f.insert(*known);
      return;
    }
    for (const VertexIndex v : f)
      if (distance(points_[v], meeting.at) <= misfits_.floor()) return;
    const auto v = static_cast<VertexIndex>(points_.size());
    points_.push_back(meeting.at);
    on_e.insert(v);
    on_f.insert(v);
  }

  /// Edges that go along edges of the other party from end to end cross none.
  void find_settled() {
    const std::vector<Edge> of_later = later_.edges();
    const auto settle = [&](const std::vector<Edge>& edges, const EdgeVertices::Lines& others) {
      for (const Edge& e : edges) {
        const std::vector<VertexIndex> line = on_edge_.along(e);
        bool is_settled = true;
        for (std::size_t k = 0; k + 1 < line.size() && is_settled; ++k)
          is_settled = !EdgeVertices::common_edges(others, line[k], line[k + 1]).empty();
        if (is_settled) settled_.insert(e);
      }
    };
    settle(of_later, on_edge_.lines_of(kept_edges_));
    settle(kept_edges_, on_edge_.lines_of(of_later));
  }

  /// Between two vertices of one edge of earlier walls an edge goes along it, through all that lie on it.
  void follow_edges() {
    const EdgeVertices::Lines lines = on_edge_.lines_of(kept_edges_);
    for (const Edge& f : later_.edges()) {
      if (is_kept(f)) continue;
      const std::vector<VertexIndex> line = on_edge_.along(f);
      for (std::size_t k = 0; k + 1 < line.size(); ++k)
        for (const Edge& e : EdgeVertices::common_edges(lines, line[k], line[k + 1]))
          follow(f, line[k], line[k + 1], on_edge_.along(e));
    }
  }
  void follow(const Edge& f, VertexIndex from, VertexIndex to, const std::vector<VertexIndex>& along_e) {
    auto a = std::find(along_e.begin(), along_e.end(), from), b = std::find(along_e.begin(), along_e.end(), to);
    if (a > b) std::swap(a, b);
    for (const VertexIndex v : std::vector<VertexIndex>(a + 1, b))
      if (v != f[0] && v != f[1]) on_edge_[f].insert(v);
  }

  std::vector<Vec3>& points_;
  Party earlier_, later_;
  std::uint32_t body_;
  const Misfits& misfits_;
  Rims rims_;
  const Lengths& lengths_;
  const RunContext& context_;
  double most_ = 0;
  std::vector<Edge> kept_edges_;  ///< of earlier bodies, sorted
  std::set<Edge> settled_;
  EdgeVertices on_edge_;
  std::map<std::uint32_t, std::vector<VertexIndex>> inside_earlier_, inside_later_;  ///< per triangle
};

/// One body after the other comes to those that are together already.
class Closing {
 public:
  Closing(const BodySoup& soup, const Misfits& misfits, Rims rims, const RunContext& context)
      : soup_(soup), misfits_(misfits), rims_(rims), context_(context), lengths_(closed_.points) {
    closed_.points = soup.points;
  }

  ClosedGaps result() {
    std::vector<std::vector<BodyFace>> bodies(misfits_.bodies());
    for (std::uint32_t t = 0; t < soup_.triangles.size(); ++t)
      bodies[soup_.body[t]].push_back({soup_.triangles[t], soup_.body[t], t});
    boxes_.resize(bodies.size());
    together_.resize(bodies.size());
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
      context_.check();
      for (const BodyFace& f : bodies[b]) lengths_.add(f.corners);
      for (const BodyFace& f : bodies[b]) boxes_[b].add(box_here(f));
      if (!bodies[b].empty()) join(b, std::move(bodies[b]));
    }
    std::vector<BodyFace> all;
    for (const std::vector<BodyFace>& faces : together_) all.insert(all.end(), faces.begin(), faces.end());
    std::stable_sort(all.begin(), all.end(), [](const BodyFace& a, const BodyFace& b) { return a.source < b.source; });
    for (const BodyFace& f : all) {
      closed_.triangles.push_back(f.corners);
      closed_.source.push_back(f.source);
    }
    return std::move(closed_);
  }

 private:
  void join(std::uint32_t b, std::vector<BodyFace> body) {
    std::vector<BodyFace> near;
    for (std::uint32_t a = 0; a < b; ++a) {
      const Box3 box = boxes_[b].grown((1 + kBend) * misfits_.reach(a, b));
      if (!boxes_[a].overlaps(box)) continue;
      const auto from = std::stable_partition(together_[a].begin(), together_[a].end(),
                                              [&](const BodyFace& f) { return !box_here(f).overlaps(box); });
      near.insert(near.end(), from, together_[a].end());
      together_[a].erase(from, together_[a].end());
    }
    if (near.empty()) {
      together_[b] = std::move(body);
      return;
    }
    BodyMeeting meeting(closed_.points, std::move(near), std::move(body), misfits_, rims_, lengths_, context_);
    meeting.run();
    for (const std::vector<BodyFace>* divided : {&meeting.divided_earlier, &meeting.divided_later})
      for (const BodyFace& f : *divided) {
        together_[f.body].push_back(f);
        lengths_.add(f.corners);
        boxes_[f.body].add(box_here(f));
      }
    closed_.moved += meeting.moved;
    closed_.largest_move = std::max(closed_.largest_move, meeting.largest_move);
  }

  Box3 box_here(const BodyFace& f) const {
    return box_of({closed_.points[f.corners[0]], closed_.points[f.corners[1]], closed_.points[f.corners[2]]});
  }

  const BodySoup& soup_;
  const Misfits& misfits_;
  Rims rims_;
  const RunContext& context_;
  ClosedGaps closed_;
  Lengths lengths_;
  std::vector<std::vector<BodyFace>> together_;  ///< per body
  std::vector<Box3> boxes_;
};

}  // namespace

ClosedGaps close_gaps(const BodySoup& soup, const Misfits& misfits, Rims rims, const RunContext& context) {
  if (misfits.floor() > 0) return Closing(soup, misfits, rims, context).result();
  ClosedGaps same{soup.points, soup.triangles, {}, 0, 0};
  same.source.resize(soup.triangles.size());
  std::iota(same.source.begin(), same.source.end(), 0);
  return same;
}

}  // namespace octafront::cells
