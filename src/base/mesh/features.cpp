#include "base/mesh/features.h"

#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <queue>
#include <tuple>

namespace octafront {
namespace {

/// A face lower than this part of the model's diagonal has no direction of its own: a file with six digits, or in
/// single precision, turns it by tens of degrees. It takes the direction of the neighbour that it agrees with best, so
/// a sharp edge beside it is found once, not on both of its sides.
constexpr double kNoise = 1e-5;
/// But what lies between faces that look away from each other, by this cosine or less, is the rim of a thin plate.
constexpr double kLookAway = -0.9;
/// Rows of slivers that a rim has at most.
constexpr int kRimRows = 16;

double lowest_height(Vec3 a, Vec3 b, Vec3 c) {
  const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
  return longest > 0 ? length(cross(b - a, c - a)) / longest : 0;
}

/// Calls visit(face, neighbour) for each edge of `face` that has just two faces.
template <typename Visit>
void for_neighbours(const EdgeTable& table, std::span<const std::uint32_t> edge_of, std::uint32_t face, Visit visit) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto uses = table.uses(edge_of[3 * face + i]);
    if (uses.size() == 2) visit(uses[0] / 3 == face ? uses[1] / 3 : uses[0] / 3);
  }
}

/// Whether across the two longest edges of a sliver, and of the slivers that lie there, faces look away from each
/// other.
class RimFinder {
 public:
  RimFinder(const SurfaceMesh& surface, const EdgeTable& table, std::span<const std::uint32_t> edge_of,
            const std::vector<Vec3>& normal, const std::vector<char>& is_face)
      : surface_(surface), table_(table), edge_of_(edge_of), normal_(normal), is_face_(is_face) {}

  bool is_rim(std::uint32_t sliver) const {
    const HalfEdge s = shortest(sliver);
    const std::uint32_t up = face_across(next_of(s)), down = face_across(next_of(next_of(s)));
    return up != kNone && down != kNone && dot(normal_[up], normal_[down]) <= kLookAway;
  }

 private:
  HalfEdge shortest(std::uint32_t face) const {
    HalfEdge least = 3 * face;
    for (const HalfEdge h : {3 * face + 1, 3 * face + 2})
      if (length_of(h) < length_of(least)) least = h;
    return least;
  }
  double length_of(HalfEdge h) const {
    return distance(surface_.points[start_of(surface_.triangles, h)],
                    surface_.points[start_of(surface_.triangles, next_of(h))]);
  }
  HalfEdge twin(HalfEdge h) const {
    const auto uses = table_.uses(edge_of_[h]);
    if (uses.size() != 2) return kNone;
    return uses[0] == h ? uses[1] : uses[0];
  }
  /// The first face that is no sliver, straight on; kNone: none within kRimRows.
  std::uint32_t face_across(HalfEdge h) const {
    for (int row = 0; row < kRimRows; ++row) {
      const HalfEdge there = twin(h);
      if (there == kNone || is_face_[there / 3]) return there == kNone ? kNone : there / 3;
      const HalfEdge s = shortest(there / 3);
      h = next_of(s) == there ? next_of(there) : next_of(s);
    }
    return kNone;
  }

  const SurfaceMesh& surface_;
  const EdgeTable& table_;
  std::span<const std::uint32_t> edge_of_;
  const std::vector<Vec3>& normal_;
  const std::vector<char>& is_face_;
};

/// Unit normals; slivers get the direction of a neighbour, the best agreement first.
std::vector<Vec3> face_directions(const SurfaceMesh& surface, const EdgeTable& table) {
  const double noise = kNoise * bounding_box(surface.points).diagonal();
  const auto faces = static_cast<std::uint32_t>(surface.triangles.size());
  std::vector<Vec3> normal(faces);
  std::vector<std::uint32_t> slivers;
  std::vector<char> settled(faces, 1);
  for (std::uint32_t f = 0; f < faces; ++f) {
    const auto [i, j, k] = surface.triangles[f];
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[k];
    normal[f] = normalized(cross(b - a, c - a));
    if (lowest_height(a, b, c) < noise) {
      slivers.push_back(f);
      settled[f] = 0;
    }
  }
  if (slivers.empty() || slivers.size() == faces) return normal;

  const RawVector<std::uint32_t> edge_of = table.edge_of_half_edge();
  const std::vector<char> is_face = settled;
  const RimFinder rims(surface, table, edge_of, normal, is_face);
  for (const std::uint32_t f : slivers) settled[f] = rims.is_rim(f);
  using Offer = std::tuple<double, std::uint32_t, std::uint32_t>;  // disagreement, sliver, who offers its direction
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers;
  const auto offer = [&](std::uint32_t from, std::uint32_t to) {
    if (settled[from] && !settled[to]) offers.push({-dot(normal[from], normal[to]), to, from});
  };
  for (const std::uint32_t f : slivers) for_neighbours(table, edge_of, f, [&](std::uint32_t g) { offer(g, f); });
  while (!offers.empty()) {
    const auto [disagreement, sliver, from] = offers.top();
    offers.pop();
    if (settled[sliver]) continue;
    settled[sliver] = 1;
    normal[sliver] = normal[from];
    for_neighbours(table, edge_of, sliver, [&, s = sliver](std::uint32_t g) { offer(s, g); });
  }
  return normal;
}

bool is_feature(const SurfaceMesh& surface, const std::vector<Vec3>& direction, std::span<const std::uint32_t> uses,
                double cos_angle) {
  if (uses.size() != 2) return true;
  const std::uint32_t f = uses[0] / 3, g = uses[1] / 3;
  return surface.patch_of(f) != surface.patch_of(g) || dot(direction[f], direction[g]) <= cos_angle;
}

std::vector<VertexIndex> find_corners(const SurfaceMesh& surface, const std::vector<Edge>& edges, double cos_angle) {
  struct Star {
    std::uint32_t valence = 0;
    std::array<VertexIndex, 2> neighbour{kNone, kNone};
  };
  std::vector<Star> stars(surface.points.size());
  for (const auto& [a, b] : edges) {
    for (const auto& [v, other] : {std::pair{a, b}, std::pair{b, a}}) {
      if (stars[v].valence < 2) stars[v].neighbour[stars[v].valence] = other;
      ++stars[v].valence;
    }
  }
  std::vector<VertexIndex> corners;
  for (VertexIndex v = 0; v < stars.size(); ++v) {
    if (stars[v].valence == 0) continue;
    bool corner = stars[v].valence != 2;
    if (!corner) {
      const auto& [before, after] = stars[v].neighbour;
      corner = dot(normalized(surface.points[v] - surface.points[before]),
                   normalized(surface.points[after] - surface.points[v])) <= cos_angle;
    }
    if (corner) corners.push_back(v);
  }
  return corners;
}

}  // namespace

Features detect_features(const SurfaceMesh& surface, double angle_degrees) {
  return detect_features(surface, make_edge_table(surface.points.size(), surface.triangles), angle_degrees);
}

Features detect_features(const SurfaceMesh& surface, const EdgeTable& table, double angle_degrees) {
  const double cos_angle = elementary::cos(angle_degrees * std::numbers::pi / 180);
  const std::vector<Vec3> direction = face_directions(surface, table);
  Features features;
  for (std::size_t e = 0; e < table.size(); ++e)
    if (is_feature(surface, direction, table.uses(e), cos_angle)) features.edges.push_back(table.edges[e]);
  features.corners = find_corners(surface, features.edges, cos_angle);
  return features;
}

}  // namespace octafront
