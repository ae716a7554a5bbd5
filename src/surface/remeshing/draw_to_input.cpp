#include "base/geometry/live_triangles.h"
#include "base/geometry/measures.h"
#include "surface/lines/seams.h"
#include "surface/remeshing/mend_folds.h"

#include <algorithm>
#include <array>

namespace octafront::surface {

namespace {

/// A point nearer to an edge than this part of the height over it goes onto the edge.
constexpr double kOnEdge = 0.2;
/// Where a corner weighs more than this it goes there itself.
constexpr double kAtCorner = 0.8;
/// In a complex no edge is halved nearer to itself than this part of its length: crossings stay as they are, and what
/// lies in one plane leaves flat elements where regions touch themselves.
constexpr double kInOwnPlane = 0.02;

/// Weights of the corners that make up the point nearest to p in the plane of a triangle.
std::array<double, 3> weights_at(const TriangleCorners& t, Vec3 p) {
  const Vec3 n = double_area_normal(t[0], t[1], t[2]);
  std::array<double, 3> w;
  for (int i = 0; i < 3; ++i) w[i] = dot(double_area_normal(p, t[(i + 1) % 3], t[(i + 2) % 3]), n) / squared_length(n);
  return w;
}

class Approacher {
 public:
  Approacher(WorkingMesh& mesh, const InputSurface& input, const TriangleTree& tree,
             const std::vector<std::uint8_t>& is_fixed, double least_shape)
      : mesh_(mesh),
        input_(input),
        tree_(tree),
        is_fixed_(is_fixed),
        least_shape_(least_shape),
        sewn_(mesh),
        live_(sewn_) {}

  std::uint64_t run(std::span<const FarPlace> places) {
    std::vector<std::uint8_t> is_touched(mesh_.triangle_count(), 0);
    std::uint64_t count = 0;
    for (const FarPlace* place : by_distance(places)) {
      if (is_touched[place->triangle] || !put_in(*place)) continue;
      ++count;
      is_touched.resize(mesh_.triangle_count(), 1);
      for (const std::uint32_t t : old_) is_touched[t] = 1;
    }
    return count;
  }

 private:
  std::vector<const FarPlace*> by_distance(std::span<const FarPlace> places) const {
    std::vector<std::pair<double, const FarPlace*>> order;
    for (const FarPlace& place : places) {
      const TriangleCorners t = live_.corners(place.triangle);
      const Vec3 p = place.on_input.p;
      order.push_back({-squared_distance(p, closest_point_on_triangle(p, t[0], t[1], t[2])), &place});
    }
    std::sort(order.begin(), order.end());
    std::vector<const FarPlace*> sorted;
    for (const auto& [key, place] : order) sorted.push_back(place);
    return sorted;
  }

  /// The first way that is sound: the nearest corner goes there, the nearest edge is divided, the triangle, an edge.
  bool put_in(const FarPlace& place) {
    const std::uint32_t t = place.triangle;
    const Vec3 p = place.on_input.p, normal = input_.normal_at(place.on_input.face, p);
    if (!(dot(mesh_.area_vector(t), normal) > 0) || !is_of_patch(place.on_input, t)) return halve(t);
    const std::array<double, 3> weight = weights_at(live_.corners(t), p);
    std::array<std::uint32_t, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) { return weight[i] < weight[j]; });
    const VertexIndex corner = mesh_.start[3 * t + order[2]];
    if (weight[order[2]] > kAtCorner && may_move(corner) && move(corner, place.on_input, normal)) return true;
    const auto edge = [&](int i) { return next_of(3 * t + order[i]); };
    if (weight[order[0]] < kOnEdge && divide(t, edge(0), place.on_input, normal)) return true;
    return divide(t, kNone, place.on_input, normal) || divide(t, edge(0), place.on_input, normal) ||
           divide(t, edge(1), place.on_input, normal) || divide(t, edge(2), place.on_input, normal) || halve(t);
  }

  /// Points of a complex go onto their own patch.
  bool is_of_patch(SurfacePoint p, std::uint32_t t) const {
    return mesh_.first_back == kNone || mesh_.patch[t] == input_.patch[p.face];
  }

  /// The longest edge that may be, at its middle: the place itself comes next where triangles are smaller.
  bool halve(std::uint32_t t) {
    std::array<HalfEdge, 3> edges{3 * t, 3 * t + 1, 3 * t + 2};
    const auto length_of = [&](HalfEdge h) {
      return squared_distance(mesh_.points[mesh_.start[h]], mesh_.points[mesh_.end(h)]);
    };
    std::sort(edges.begin(), edges.end(), [&](HalfEdge g, HalfEdge h) { return length_of(g) > length_of(h); });
    return std::ranges::any_of(edges, [&](HalfEdge h) {
      const TriangleTree::Nearest at = tree_.nearest((mesh_.points[mesh_.start[h]] + mesh_.points[mesh_.end(h)]) * 0.5);
      if (mesh_.first_back != kNone && at.squared_distance < kInOwnPlane * kInOwnPlane * length_of(h)) return false;
      const Vec3 normal = input_.normal_at(at.triangle, at.point);
      return dot(mesh_.area_vector(t), normal) > 0 && is_of_patch({at.point, at.triangle}, t) &&
             divide(t, h, {at.point, at.triangle}, normal);
    });
  }

  /// The edge, or for kNone the triangle.
  bool divide(std::uint32_t triangle, HalfEdge edge, SurfacePoint at, Vec3 normal) {
    if (edge != kNone && mesh_.is_feature[edge]) return false;
    plan_split(triangle, edge, at.p);
    if (!is_sound()) return false;
    const Triangle t = mesh_.triangle(triangle);
    const double size = (mesh_.size[t[0]] + mesh_.size[t[1]] + mesh_.size[t[2]]) / 3;
    const VertexIndex x = mesh_.add_vertex(at.p, VertexKind::kFree, normal, size, at.face);
    if (edge == kNone) {
      mesh_.split_triangle(triangle, x);
    } else {
      mesh_.split_edge(edge, x);
    }
    note_changed(x);
    return true;
  }

  bool may_move(VertexIndex v) const { return mesh_.is_free(v) && !(v < is_fixed_.size() && is_fixed_[v]); }

  bool move(VertexIndex v, SurfacePoint to, Vec3 normal) {
    plan_move(v, to.p);
    if (!is_sound()) return false;
    mesh_.points[v] = to.p;
    mesh_.face[v] = to.face;
    mesh_.normal[v] = normal;
    note_changed(v);
    return true;
  }

  void note_changed(VertexIndex v) {
    mesh_.mark_star_changed(v);
    std::vector<std::uint32_t> touched = old_;
    mesh_.for_each_outgoing(v, [&](HalfEdge h) { touched.push_back(h / 3); });
    live_.note_changed(touched);
  }

  void plan_move(VertexIndex v, Vec3 p) {
    old_.clear();
    new_.clear();
    mesh_.for_each_outgoing(v, [&](HalfEdge h) {
      const VertexIndex a = mesh_.end(h), b = mesh_.apex(h);
      old_.push_back(h / 3);
      new_.push_back({{sewn_.vertex(v), sewn_.vertex(a), sewn_.vertex(b)}, {p, mesh_.points[a], mesh_.points[b]}});
    });
  }

  /// What would go, and what would come.
  void plan_split(std::uint32_t triangle, HalfEdge edge, Vec3 p) {
    old_.assign(1, triangle);
    if (edge != kNone) old_.push_back(mesh_.twin[edge] / 3);
    new_.clear();
    const auto x = static_cast<VertexIndex>(mesh_.points.size());
    for (const std::uint32_t t : old_) {
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        if (edge != kNone && (h == edge || h == mesh_.twin[edge])) continue;
        const VertexIndex a = mesh_.start[h], b = mesh_.end(h);
        new_.push_back({{sewn_.vertex(a), sewn_.vertex(b), x}, {mesh_.points[a], mesh_.points[b], p}});
      }
    }
  }

  bool is_sound() {
    double before = 1;
    for (const std::uint32_t t : old_) {
      const auto [a, b, c] = live_.corners(t);
      before = std::min(before, triangle_radius_ratio(a, b, c));
    }
    for (const IdTriangle& made : new_) {
      const auto& [a, b, c] = made.corners;
      if (LiveTriangles<SewnMesh>::is_degenerate(made.corners)) return false;
      if (triangle_radius_ratio(a, b, c) < std::min(least_shape_, before)) return false;
    }
    const int allowed = live_.crossings_among(old_);
    return live_.crossings_among(new_, old_, allowed + 1) <= allowed;
  }

  WorkingMesh& mesh_;
  const InputSurface& input_;
  const TriangleTree& tree_;
  const std::vector<std::uint8_t>& is_fixed_;
  double least_shape_;
  const SewnMesh sewn_;
  LiveTriangles<SewnMesh> live_;
  std::vector<std::uint32_t> old_;
  std::vector<IdTriangle> new_;
};

}  // namespace

std::uint64_t draw_to_input(WorkingMesh& mesh, const InputSurface& input, const TriangleTree& tree,
                            const std::vector<std::uint8_t>& is_fixed, std::span<const FarPlace> places,
                            double least_shape) {
  return Approacher(mesh, input, tree, is_fixed, least_shape).run(places);
}

}  // namespace octafront::surface
