#include "mesh/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>

namespace octafront {
namespace {

/// A face lower than this part of the model's diagonal has no direction of its own: a file with six digits, or in
/// single precision, turns it by tens of degrees. It takes the direction of the neighbour that it agrees with best, so
/// a sharp edge beside it is found once, not on both of its sides.
constexpr double kNoise = 1e-5;

double lowest_height(Vec3 a, Vec3 b, Vec3 c) {
  const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
  return longest > 0 ? length(cross(b - a, c - a)) / longest : 0;
}

/// Calls visit(face, neighbour) for each edge of `face` that has just two faces.
template <typename Visit>
void for_neighbours(const EdgeTable& table, const std::vector<std::uint32_t>& edge_of, std::uint32_t face,
                    Visit visit) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto uses = table.uses(edge_of[3 * face + i]);
    if (uses.size() == 2) visit(uses[0] / 3 == face ? uses[1] / 3 : uses[0] / 3);
  }
}

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

  const std::vector<std::uint32_t> edge_of = table.edge_of_half_edge();
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
  const double cos_angle = std::cos(angle_degrees * std::numbers::pi / 180);
  const std::vector<Vec3> direction = face_directions(surface, table);
  Features features;
  for (std::size_t e = 0; e < table.size(); ++e)
    if (is_feature(surface, direction, table.uses(e), cos_angle)) features.edges.push_back(table.edges[e]);
  features.corners = find_corners(surface, features.edges, cos_angle);
  return features;
}

}  // namespace octafront
