#include "layers/growth/soundness.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"

#include <algorithm>
#include <cmath>

namespace octafront::layers {

namespace {

constexpr double kSineOf60 = 0.86602540378443865;
/// A prism may be so much more distorted than its triangle of the wall.
constexpr double kLeastJacobian = 0.1;
/// The top of a triangle's layers faces at most 84 degrees away from the triangle.
constexpr double kLeastFacing = 0.1;
/// Triangles beside layers keep this part of their area.
constexpr double kLeastBareArea = 0.1;

double scaled(Vec3 u, Vec3 v, Vec3 w) {
  const double lengths = length(u) * length(v) * length(w);
  return lengths > 0 ? dot(cross(u, v), w) / lengths : 0;
}

/// Of the corner of a triangle, 1 at 60 degrees.
double sine_over_60(Vec3 u, Vec3 v) {
  const double lengths = length(u) * length(v);
  return lengths > 0 ? length(cross(u, v)) / (kSineOf60 * lengths) : 0;
}

double least_sine(const SurfaceMesh& wall, const Triangle& t) {
  double least = 2;
  for (int i = 0; i < 3; ++i) {
    const Vec3 p = wall.points[t[i]];
    least = std::min(least, sine_over_60(wall.points[t[(i + 1) % 3]] - p, wall.points[t[(i + 2) % 3]] - p));
  }
  return least;
}

class Soundness {
 public:
  Soundness(const Walls& walls, const Columns& columns) : walls_(walls), wall_(walls.surface), columns_(columns) {}

  bool is_sound(std::uint32_t f) const {
    const Triangle& t = wall_.triangles[f];
    if (columns_.count[t[0]] + columns_.count[t[1]] + columns_.count[t[2]] == 0) return true;
    return walls_.is_wall[f] ? faces_alike(f, kLeastFacing, 0) && has_sound_layers(t)
                             : faces_alike(f, kLeastFacing, kLeastBareArea);
  }

 private:
  Vec3 place(Node node) const { return columns_.place(wall_, node); }

  bool faces_alike(std::uint32_t f, double least_cosine, double least_area) const {
    const auto [a, b, c] = wall_.triangles[f];
    const Vec3 before = double_area_normal(wall_.points[a], wall_.points[b], wall_.points[c]);
    const Vec3 after = double_area_normal(columns_.top(wall_, a), columns_.top(wall_, b), columns_.top(wall_, c));
    return dot(before, after) >
           std::max(least_cosine * length(before) * length(after), least_area * squared_length(before));
  }

  bool has_sound_layers(const Triangle& t) const {
    const double least = kLeastJacobian * least_sine(wall_, t);
    for (std::uint32_t k = 0; k < columns_.asked; ++k) {
      const TetsOfLayer made = tets_of_layer(columns_, t, k);
      for (int i = 0; i < made.count; ++i) {
        const auto& [a, b, c, d] = made.tets[i];
        if (orient3d(place(a), place(b), place(c), place(d)) <= 0) return false;
      }
      if (made.count == 3 && !(least_scaled_jacobian(wall_, columns_, t, k) >= least)) return false;
    }
    return true;
  }

  const Walls& walls_;
  const SurfaceMesh& wall_;
  const Columns& columns_;
};

}  // namespace

double least_scaled_jacobian(const SurfaceMesh& wall, const Columns& columns, const Triangle& triangle,
                             std::uint32_t layer) {
  std::array<Vec3, 3> low, high;
  for (int i = 0; i < 3; ++i)
    low[i] = columns.place(wall, {triangle[i], layer}), high[i] = columns.place(wall, {triangle[i], layer + 1});
  double least = 1 / kSineOf60;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    // Seen from inside the triangle turns clockwise.
    least = std::min({least, scaled(low[k] - low[i], low[j] - low[i], high[i] - low[i]) / kSineOf60,
                      scaled(high[k] - high[i], high[j] - high[i], high[i] - low[i]) / kSineOf60});
  }
  return least;
}

std::vector<std::uint32_t> unsound_triangles(const Walls& walls, const Columns& columns,
                                             const std::vector<std::uint32_t>& asked) {
  const Soundness soundness(walls, columns);
  constexpr std::size_t kRange = 512;
  return parallel_collect<std::uint32_t>(asked.size(), kRange,
                                         [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
                                           for (std::size_t i = begin; i < end; ++i)
                                             if (!soundness.is_sound(asked[i])) found.push_back(asked[i]);
                                         });
}

std::vector<std::uint32_t> crossing_triangles(const Walls& walls, const Columns& columns, double ahead,
                                              const RunContext& context) {
  const SurfaceMesh& wall = walls.surface;
  const auto n = static_cast<VertexIndex>(wall.points.size());
  std::vector<Vec3> points = wall.points;
  points.resize(2 * std::size_t{n});
  for (VertexIndex v = 0; v < n; ++v) points[n + v] = wall.points[v] + (columns.top(wall, v) - wall.points[v]) * ahead;
  const auto is_moved = [&](VertexIndex v) { return columns.count[v] > 0; };
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> of;
  for (std::uint32_t f = 0; f < wall.triangles.size(); ++f) {
    Triangle t = wall.triangles[f];
    const bool moves = std::ranges::any_of(t, is_moved);
    if (moves && walls.is_wall[f]) triangles.push_back(t), of.push_back(f);
    for (VertexIndex& v : t) v = is_moved(v) ? n + v : v;
    triangles.push_back(t), of.push_back(f);
  }
  std::vector<std::uint32_t> found;
  for (const auto& pair : self_intersections(points, triangles, std::numeric_limits<std::size_t>::max(), context))
    for (const std::uint32_t i : pair) found.push_back(of[i]);
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace octafront::layers
