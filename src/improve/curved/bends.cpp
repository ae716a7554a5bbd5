#include "improve/curved/bends.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/face_table.h"
#include "improve/curved/node_places.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

namespace octafront::curved {

namespace {

// A vertex on a curve of the input is there but for rounding; in parts of the model's diagonal.
constexpr double kBendOnCurve = 1e-7;
// An edge that wants to bend by more than this part of its length is not resolved by the mesh: half of a quarter turn.
constexpr double kMostBend = 0.2;
// Corners lie on the input's triangles, and go as far as those are from the smooth surface: where they are large, that
// is a good part of an edge of the mesh. The boundary of a stuffed lattice lies beside them, and follows as far as
// this.
constexpr double kMostMove = 0.5;
// Less is rounding.
constexpr double kStraightBend = 1e-7;

enum class On : std::uint8_t { kNothing, kSurface, kCurve, kCorner };

struct Target {
  On on = On::kNothing;
  Foot foot;
};

class Search {
 public:
  Search(const TetMesh& mesh, const std::vector<Edge>& sharp, SmoothSurface& surface, int order)
      : mesh_(mesh), surface_(surface), order_(order), faces_(mesh.boundary) {
    faces_.insert(faces_.end(), mesh.interfaces.begin(), mesh.interfaces.end());
    table_ = make_edge_table(mesh.points.size(), faces_);
    tolerance_ = kBendOnCurve * bounding_box(mesh.points).diagonal();
    mark_curves(sharp);
    gather_vertices();
  }

  Bends run() {
    targets_.resize(vertices_.size());
    parallel_for(vertices_.size(), [&](std::size_t i) { targets_[i] = target_of_vertex(vertices_[i]); });
    bulge_.assign(table_.size(), {});
    if (order_ > 2) find_bulges();
    locate_nodes();
    prepare();
    find_moves();
    return displacements();
  }

 private:
  Vec3 point(VertexIndex v) const { return mesh_.points[v]; }
  double edge_length(std::size_t e) const { return distance(point(table_.edges[e][0]), point(table_.edges[e][1])); }
  Vec3 middle(std::size_t e) const { return 0.5 * (point(table_.edges[e][0]) + point(table_.edges[e][1])); }
  double longest_edge(const Triangle& t) const {
    return std::max(
        {distance(point(t[0]), point(t[1])), distance(point(t[1]), point(t[2])), distance(point(t[2]), point(t[0]))});
  }
  Vec3 face_normal(std::size_t f) const {
    const auto& [a, b, c] = faces_[f];
    return double_area_normal(point(a), point(b), point(c));
  }

  /// Edges that are features of the mesh and lie along a sharp curve of the input. Others between patches are smooth.
  void mark_curves(const std::vector<Edge>& sharp) {
    on_curve_.assign(table_.size(), 0);
    parallel_for(table_.size(), [&](std::size_t e) {
      const Edge edge = table_.edges[e];
      if (!std::binary_search(sharp.begin(), sharp.end(), edge)) return;
      on_curve_[e] = surface_.curve_foot(point(edge[0]), tolerance_) &&
                     surface_.curve_foot(point(edge[1]), tolerance_) &&
                     surface_.curve_foot(middle(e), kMostBend * edge_length(e));
    });
  }

  void gather_vertices() {
    normal_.assign(mesh_.points.size(), {});
    shortest_.assign(mesh_.points.size(), TriangleTree::kFar);
    vertex_on_curve_.assign(mesh_.points.size(), 0);
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (const VertexIndex v : faces_[f]) normal_[v] += face_normal(f);
    for (std::size_t e = 0; e < table_.size(); ++e)
      for (const VertexIndex v : table_.edges[e]) {
        shortest_[v] = std::min(shortest_[v], edge_length(e));
        vertex_on_curve_[v] |= on_curve_[e];
      }
    for (VertexIndex v = 0; v < mesh_.points.size(); ++v)
      if (shortest_[v] < TriangleTree::kFar) vertices_.push_back(v);
  }

  Target target(bool on_curve, Vec3 p, Vec3 normal, double reach) const {
    const auto foot = on_curve ? surface_.curve_foot(p, reach) : surface_.surface_foot(p, normalized(normal), reach);
    if (!foot) return {};
    return {on_curve ? On::kCurve : On::kSurface, *foot};
  }

  Target target_of_vertex(VertexIndex v) const {
    const Target found = target(vertex_on_curve_[v], point(v), normal_[v], kMostMove * shortest_[v]);
    return found.on == On::kCurve && surface_.is_corner(found.foot, tolerance_) ? Target{On::kCorner, {}} : found;
  }
  Target target_near_edge(std::size_t e, Vec3 p) const {
    Vec3 normal;
    for (const std::uint32_t h : table_.uses(e)) normal += normalized(face_normal(h / 3));
    return target(on_curve_[e], p, normal, kMostBend * edge_length(e));
  }
  /// Where a node of an edge or face is looked for.
  template <std::size_t kCorners>
  Vec3 raised(const NodePlace<kCorners>& place, const std::array<VertexIndex, kCorners>& corners,
              std::span<const Vec3> bulges) const {
    return place.mean(mesh_.points, corners) + part_of_parabola(order_) * place.on_parabolas(bulges);
  }
  Target target_in_edge(std::size_t e, std::size_t node) const {
    return target_near_edge(e, raised(in_edge(order_, node), table_.edges[e], {&bulge_[e], 1}));
  }
  Target target_in_face(std::size_t f, std::size_t node) const {
    const Triangle corners = face_key(faces_[f]);
    return target(false, raised(in_face(order_, node), corners, bulges_of_face(table_, bulge_, corners)),
                  face_normal(f), kMostBend * longest_edge(corners));
  }
  std::size_t first_of_edge(std::size_t e) const { return vertices_.size() + e * nodes_in_edge(order_); }
  std::size_t first_of_face(std::size_t f) const { return first_of_edge(table_.size()) + f * nodes_in_face(order_); }

  /// How far the middles of edges lie off the straight ones, once their ends are where they want to be.
  void find_bulges() {
    targets_.resize(first_of_edge(0) + table_.size());
    const auto target_of = [&](std::size_t e) -> Target& { return targets_[first_of_edge(0) + e]; };
    parallel_for(table_.size(), [&](std::size_t e) { target_of(e) = target_near_edge(e, middle(e)); });
    prepare();
    find_moves();
    parallel_for(table_.size(), [&](std::size_t e) {
      NodeMoves by{};
      const auto in_middle = [](std::size_t) { return in_edge(2, 0); };
      const double most = most_bend(table_.edges[e], edge_length(e), first_of_edge(0) + e, 1, in_middle, by);
      if (most >= 0 && most <= kMostBend) bulge_[e] = by[0];
    });
  }

  void locate_nodes() {
    targets_.resize(first_of_face(faces_.size()));
    parallel_for(table_.size(), [&](std::size_t e) {
      for (std::size_t k = 0; k < nodes_in_edge(order_); ++k) targets_[first_of_edge(e) + k] = target_in_edge(e, k);
    });
    parallel_for(faces_.size(), [&](std::size_t f) {
      for (std::size_t k = 0; k < nodes_in_face(order_); ++k) targets_[first_of_face(f) + k] = target_in_face(f, k);
    });
  }

  void prepare() {
    std::vector<Foot> on_surface, on_curves;
    for (const Target& t : targets_) {
      if (t.on == On::kSurface) on_surface.push_back(t.foot);
      if (t.on == On::kCurve) on_curves.push_back(t.foot);
    }
    surface_.prepare(on_surface, on_curves);
  }

  /// From p to the smooth surface; nothing if there is none, or too far.
  std::optional<Vec3> displacement(const Target& t, Vec3 p, double most) const {
    if (t.on == On::kNothing) return std::nullopt;
    if (t.on == On::kCorner) return Vec3{};
    const Vec3 by = (t.on == On::kCurve ? surface_.curve_point(t.foot) : surface_.surface_point(t.foot)) - p;
    if (squared_length(by) > most * most) return std::nullopt;
    return by;
  }

  void find_moves() {
    moved_.assign(mesh_.points.size(), std::nullopt);
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      moved_[vertices_[i]] = displacement(targets_[i], point(vertices_[i]), kMostMove * shortest_[vertices_[i]]);
  }

  Bends displacements() const {
    Bends bends;
    for (const VertexIndex v : vertices_)
      if (moved_[v] && length(*moved_[v]) > kStraightBend * shortest_[v]) bends.corners.push_back({v, *moved_[v]});
    for (std::size_t e = 0; e < table_.size(); ++e) {
      NodeMoves by{};
      const double most = most_bend(
          table_.edges[e], edge_length(e), first_of_edge(e), nodes_in_edge(order_),
          [&](std::size_t k) { return in_edge(order_, k); }, by);
      if (most > kStraightBend && most <= kMostBend) bends.edges.push_back({table_.edges[e], by});
    }
    for (std::size_t f = 0; f < faces_.size() && nodes_in_face(order_) > 0; ++f) {
      const Triangle corners = face_key(faces_[f]);
      NodeMoves by{};
      const double most = most_bend(
          corners, longest_edge(corners), first_of_face(f), nodes_in_face(order_),
          [&](std::size_t k) { return in_face(order_, k); }, by);
      if (most >= 0 && most <= kMostBend) bends.faces.push_back({corners, by});
    }
    std::ranges::sort(bends.faces, {}, &FaceBend::face);
    return bends;
  }
  /// How far the nodes between these corners are to go, and the most of it in parts of `size`; negative if a place is
  /// not known: what bends to the surface with a corner that stays away from it would be a bump.
  template <class Corners, class InPart>
  double most_bend(const Corners& corners, double size, std::size_t first, std::size_t nodes, const InPart& in_part,
                   NodeMoves& by) const {
    std::vector<Vec3> moves;
    for (const VertexIndex v : corners) {
      if (!moved_[v]) return -1;
      moves.push_back(*moved_[v]);
    }
    double most = 0;
    for (std::size_t k = 0; k < nodes; ++k) {
      const auto at = in_part(k);
      const auto to = displacement(targets_[first + k], at.mean(mesh_.points, corners), kMostMove * size);
      if (!to) return -1;
      by[k] = *to - at.mean_of(moves);
      most = std::max(most, length(by[k]) / size);
    }
    return most;
  }

  const TetMesh& mesh_;
  SmoothSurface& surface_;
  int order_;
  std::vector<Triangle> faces_;  // the boundary, and interfaces
  EdgeTable table_;              // their edges
  double tolerance_ = 0;
  std::vector<char> on_curve_;         // per edge
  std::vector<char> vertex_on_curve_;  // per vertex of the mesh, as the next two
  std::vector<Vec3> normal_;
  std::vector<double> shortest_;  // edge at a vertex; infinite inside
  std::vector<VertexIndex> vertices_;
  std::vector<Target> targets_;
  std::vector<std::optional<Vec3>> moved_;
  std::vector<Vec3> bulge_;  // per edge; of orders above 2
};

}  // namespace

Bends find_bends(const TetMesh& mesh, const std::vector<Edge>& sharp, SmoothSurface& surface, int order) {
  return Search(mesh, sharp, surface, order).run();
}

void add_corners_above(std::span<const VertexIndex> below, Bends& bends) {
  if (below.empty()) return;
  std::vector<Vec3> by(below.size());
  for (const CornerMove& move : bends.corners) by[move.vertex] = move.by;
  bends.corners.clear();
  for (VertexIndex v = 0; v < below.size(); ++v)
    if (by[below[v]] != Vec3{}) bends.corners.push_back({v, by[below[v]]});
}

void add_edges_above(std::span<const VertexIndex> below, const TetEdges& edges, int order, Bends& bends) {
  if (below.empty()) return;
  const auto is_before = [](const EdgeBend& bend, const Edge& edge) { return bend.edge < edge; };
  std::vector<EdgeBend> all;
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    const Edge edge{edges.low[e], edges.high[e]};
    const VertexIndex a = below[edge[0]], b = below[edge[1]];
    const Edge under{std::min(a, b), std::max(a, b)};
    const auto found = std::lower_bound(bends.edges.begin(), bends.edges.end(), under, is_before);
    if (found == bends.edges.end() || found->edge != under) continue;
    all.push_back({edge, found->by});
    if (a > b) std::reverse(all.back().by.begin(), all.back().by.begin() + (order - 1));
  }
  // Those of the boundary that lie above others bend on their own.
  const auto above = static_cast<std::ptrdiff_t>(all.size());
  for (const EdgeBend& bend : bends.edges) {
    const auto end = all.begin() + above, found = std::lower_bound(all.begin(), end, bend.edge, is_before);
    if (found == end || found->edge != bend.edge) all.push_back(bend);
  }
  std::ranges::sort(all, {}, &EdgeBend::edge);
  bends.edges = std::move(all);
}

namespace {

/// How places of a wall move that are nodes of its edges and faces.
class WallMoves {
 public:
  WallMoves(const Bends& bends, int order) : bends_(bends), order_(order) {}

  /// By weights of vertices of the wall; nothing where none lies in an edge or face that bends.
  std::optional<Vec3> at(std::vector<std::pair<VertexIndex, int>> weights) const {
    std::ranges::sort(weights);
    if (weights.size() == 2) return on_edge(weights);
    return weights.size() == 3 ? on_face(weights) : std::nullopt;
  }

 private:
  using Weights = std::vector<std::pair<VertexIndex, int>>;

  std::optional<Vec3> on_edge(const Weights& w) const {
    const auto found = std::ranges::lower_bound(bends_.edges, Edge{w[0].first, w[1].first}, {}, &EdgeBend::edge);
    if (found == bends_.edges.end() || found->edge != Edge{w[0].first, w[1].first}) return std::nullopt;
    return found->by[static_cast<std::size_t>(w[1].second - 1)];
  }
  std::optional<Vec3> on_face(const Weights& w) const {
    const Triangle face{w[0].first, w[1].first, w[2].first};
    const auto found = std::ranges::lower_bound(bends_.faces, face, {}, &FaceBend::face);
    if (found == bends_.faces.end() || found->face != face) return std::nullopt;
    for (std::size_t k = 0; k < nodes_in_face(order_); ++k)
      if (const auto place = in_face(order_, k).weights;
          place[0] == w[0].second && place[1] == w[1].second && place[2] == w[2].second)
        return found->by[k];
    return std::nullopt;
  }

  const Bends& bends_;
  int order_;
};

/// A node of an element as one of the wall under it.
template <std::size_t kCorners>
std::vector<std::pair<VertexIndex, int>> weights_below(std::span<const VertexIndex> below,
                                                       const std::array<VertexIndex, kCorners>& corners,
                                                       const std::array<double, kCorners>& weights) {
  std::vector<std::pair<VertexIndex, int>> under;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const auto found = std::ranges::find(under, below[corners[i]], &std::pair<VertexIndex, int>::first);
    if (found == under.end())
      under.push_back({below[corners[i]], static_cast<int>(weights[i])});
    else
      found->second += static_cast<int>(weights[i]);
  }
  return under;
}

}  // namespace

void add_faces_above(std::span<const VertexIndex> below, const TetFaces& faces, const TetMesh& mesh, int order,
                     Bends& bends) {
  if (below.empty() || nodes_in_face(order) == 0) return;
  const WallMoves wall(bends, order);
  std::vector<FaceBend> all;
  for (const Triangle& face : faces.corners) {
    if (std::ranges::all_of(face, [&](VertexIndex v) { return below[v] == v; })) continue;
    FaceBend bend{face, {}};
    bool moves = false;
    for (std::size_t k = 0; k < nodes_in_face(order); ++k)
      if (const auto by = wall.at(weights_below(below, face, in_face(order, k).weights)))
        bend.by[k] = *by, moves = true;
    if (moves) all.push_back(bend);
  }
  for (TetIndex t = 0; t < mesh.tets.size() && nodes_in_tet(order) > 0; ++t)
    if (const auto by = wall.at(weights_below<4>(below, mesh.tets[t], {1, 1, 1, 1})))
      bends.tets.push_back({t, {*by, Vec3{}, Vec3{}}});
  const auto above = static_cast<std::ptrdiff_t>(all.size());
  for (const FaceBend& bend : bends.faces) {
    const auto end = all.begin() + above,
               found = std::ranges::lower_bound(all.begin(), end, bend.face, {}, &FaceBend::face);
    if (found == end || found->face != bend.face) all.push_back(bend);
  }
  std::ranges::sort(all, {}, &FaceBend::face);
  bends.faces = std::move(all);
}

}  // namespace octafront::curved
