#include "surface/remeshing/deviation.h"

#include "core/parallel.h"
#include "geometry/doubtful_parts.h"
#include "geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace octafront::remeshing {

namespace {

/// A point of a triangle.
struct Sample {
  Vec3 p;
  std::uint32_t triangle;
  bool within = false;  ///< not at its corners or the middles of its edges
};

/// The samples of `all` that are farther than `limit` from the surface, in their order.
std::vector<Sample> beyond(double limit, const std::vector<Sample>& all, const TriangleTree& surface) {
  std::vector<std::uint8_t> is_far(all.size());
  parallel_for(all.size(), [&](std::size_t i) { is_far[i] = !surface.is_within(all[i].p, limit); });
  std::vector<Sample> far;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (is_far[i]) far.push_back(all[i]);
  return far;
}

/// Each vertex with one of its triangles; vertices of none have kNone.
std::vector<Sample> vertices_of(const SurfaceMesh& surface) {
  std::vector<Sample> vertices(surface.points.size(), {{}, kNone});
  for (std::uint32_t t = static_cast<std::uint32_t>(surface.triangles.size()); t-- > 0;)
    for (const VertexIndex v : surface.triangles[t]) vertices[v] = {surface.points[v], t};
  return vertices;
}

/// Middles of the edges that `is_asked(v, w)`.
template <typename Asked>
void add_edge_middles(const SurfaceMesh& surface, Asked&& is_asked, std::vector<Sample>& samples) {
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const VertexIndex v = surface.triangles[t][i], w = surface.triangles[t][(i + 1) % 3];
      if (v < w && is_asked(v, w)) samples.push_back({(surface.points[v] + surface.points[w]) * 0.5, t});
    }
  }
}

/// Per vertex how far from the nearest corner a point of its triangles may lie: a part of the longest edge, the whole
/// of that part in an equilateral triangle.
std::vector<double> reach_of_vertices(const SurfaceMesh& surface) {
  constexpr double kReach = 0.57736;  // 1 / sqrt(3), a little more
  std::vector<double> reach(surface.points.size(), 0);
  for (const Triangle& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      const double l = kReach * distance(surface.points[t[i]], surface.points[t[(i + 1) % 3]]);
      for (const VertexIndex v : t) reach[v] = std::max(reach[v], l);
    }
  }
  return reach;
}

/// How far parts of the input reach that are divided no further: as far as the limit, but in edges of the triangle
/// beside no farther than the one, over which the distance changes evenly, and no less far than the other.
constexpr double kWidest = 0.3, kFinest = 0.1;

/// Looks at parts of the input for what may be farther than the limit from a surface that was made. A triangle is
/// convex: what has its corners within the limit of one lies within the limit of it.
class PartsOfInput {
 public:
  PartsOfInput(double limit, double far, const TriangleTree& made) : limit_(limit), far_(far), made_(made) {}

  Part operator()(const TriangleCorners& part, Vec3 middle, double reach) const {
    nearest_ = made_.nearest(middle, bound(middle)).triangle;
    const TriangleCorners& t = made_.corners(nearest_);
    const double d = distance_to(t, middle);
    if (d + reach < limit_) return Part::kWithin;
    if (d < limit_ && std::ranges::all_of(part, [&](Vec3 p) { return distance_to(t, p) < limit_; }))
      return Part::kWithin;
    return reach <= finest(t) || !(d < far_) ? Part::kVisit : Part::kDivide;
  }

 private:
  static double distance_to(const TriangleCorners& t, Vec3 p) {
    return distance(p, closest_point_on_triangle(p, t[0], t[1], t[2]));
  }

  /// The nearest triangle to p is no farther than that of the last part, and a little more.
  double bound(Vec3 p) const {
    if (nearest_ == kNone) return TriangleTree::kFar;
    const double last = distance_to(made_.corners(nearest_), p);
    return 1.001 * last * last + std::numeric_limits<double>::min();
  }

  double finest(const TriangleCorners& t) const {
    const double squared_edge =
        std::max({squared_distance(t[0], t[1]), squared_distance(t[1], t[2]), squared_distance(t[2], t[0])});
    const double edge = std::sqrt(squared_edge);
    return std::clamp(limit_, kFinest * edge, kWidest * edge);
  }

  double limit_, far_;
  const TriangleTree& made_;
  mutable std::uint32_t nearest_ = kNone;  ///< to the last part
};

/// Samples of a triangle of the input that may be far.
void add_suspects(const TriangleCorners& corners, std::uint32_t t, const PartsOfInput& look,
                  std::vector<Sample>& found) {
  const std::size_t before = found.size();
  for_each_doubtful_part(corners, look, [&](Vec3 p) {
    found.push_back({p, t, true});
    return true;
  });
  if (found.size() == before) return;
  for (int i = 0; i < 3; ++i) {
    found.push_back({corners[i], t});
    found.push_back({(corners[i] + corners[(i + 1) % 3]) * 0.5, t});
  }
}

/// Samples of the input that may be far: of triangles whose corners are not all well within the limit.
std::vector<Sample> suspects(double limit, double far, const SurfaceMesh& input, const TriangleTree& made) {
  const std::vector<double> reach = reach_of_vertices(input);
  std::vector<std::uint8_t> is_safe(reach.size());
  parallel_for(reach.size(), [&](std::size_t v) {
    is_safe[v] = reach[v] < limit && made.is_within(input.points[v], limit - reach[v]);
  });
  constexpr std::size_t kRange = 256;
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<Sample>& found) {
    const PartsOfInput look(limit, far, made);
    for (auto t = static_cast<std::uint32_t>(begin); t < end; ++t) {
      const auto& [a, b, c] = input.triangles[t];
      if (!is_safe[a] || !is_safe[b] || !is_safe[c])
        add_suspects({input.points[a], input.points[b], input.points[c]}, t, look, found);
    }
  };
  return parallel_collect<Sample>(input.triangles.size(), kRange, collect);
}

std::vector<Sample> samples_of(const SurfaceMesh& made) {
  std::vector<Sample> samples = vertices_of(made);
  std::erase_if(samples, [](const Sample& s) { return s.triangle == kNone; });
  for (std::uint32_t t = 0; t < made.triangles.size(); ++t) {
    const auto [a, b, c] = made.triangles[t];
    samples.push_back({centroid(made.points[a], made.points[b], made.points[c]), t});
  }
  add_edge_middles(
      made, [](VertexIndex, VertexIndex) { return true; }, samples);
  return samples;
}

Vec3 normal_of(const SurfaceMesh& surface, std::uint32_t t) {
  const auto [a, b, c] = surface.triangles[t];
  return double_area_normal(surface.points[a], surface.points[b], surface.points[c]);
}

/// The nearest point to p of the triangles that face along `normal`, if it is within kOtherSide times the distance of
/// the nearest point of all: of a thin wall the right side. Otherwise that one, which is at `distance`.
TriangleTree::Nearest nearest_facing(const TriangleTree& tree, Vec3 p, Vec3 normal, double& distance) {
  constexpr double kOtherSide = 3;
  const TriangleTree::Nearest any = tree.nearest(p);
  distance = std::sqrt(any.squared_distance);
  const double reach = kOtherSide * distance;
  TriangleTree::Nearest best{any.point, any.triangle, reach * reach};
  tree.for_each_box_near({p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}},
                         [&](std::uint32_t triangle, const TriangleCorners& t) {
                           if (!(dot(double_area_normal(t[0], t[1], t[2]), normal) > 0)) return true;
                           const Vec3 q = closest_point_on_triangle(p, t[0], t[1], t[2]);
                           const double d = squared_distance(p, q);
                           if (d < best.squared_distance) best = {q, triangle, d};
                           return true;
                         });
  return best;
}

}  // namespace

std::vector<FarPlace> places_beyond(double limit, double far, const SurfaceMesh& made, const SurfaceMesh& input,
                                    const TriangleTree& input_tree) {
  std::vector<FarPlace> places;
  double distance = 0;
  for (const auto& [p, t, within] : beyond(limit, samples_of(made), input_tree)) {
    const TriangleTree::Nearest nearest = nearest_facing(input_tree, p, normal_of(made, t), distance);
    places.push_back({p, {nearest.point, nearest.triangle}, distance, t, within});
  }
  const TriangleTree made_tree(made);
  for (const auto& [p, t, within] : beyond(limit, suspects(limit, far, input, made_tree), made_tree)) {
    const std::uint32_t triangle = nearest_facing(made_tree, p, normal_of(input, t), distance).triangle;
    places.push_back({p, {p, t}, distance, triangle, within});
  }
  return places;
}

}  // namespace octafront::remeshing
