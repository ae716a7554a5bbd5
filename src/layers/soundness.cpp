#include "layers/soundness.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"

#include <algorithm>

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
    if (walls_.is_wall[f]) return faces_alike(f, kLeastFacing, 0) && has_sound_layers(t);
    return walls_.is_outside || faces_alike(f, kLeastFacing, kLeastBareArea);
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
      if (made.count == 2 && !is_sound_pyramid(t, k)) return false;
      if (made.count == 3 && !(least_scaled_jacobian(wall_, columns_, t, k) >= least)) return false;
    }
    return true;
  }

  /// Where one column has ended: each corner of the base must see the apex, whatever way that is divided.
  bool is_sound_pyramid(const Triangle& t, std::uint32_t layer) const {
    int end = 0;
    while (columns_.count[t[end]] > layer) ++end;
    const VertexIndex p = t[(end + 1) % 3], q = t[(end + 2) % 3];
    const std::array base{place({q, layer}), place({q, layer + 1}), place({p, layer + 1}), place({p, layer})};
    const Vec3 apex = place({t[end], columns_.count[t[end]]});
    for (int i = 0; i < 4; ++i)
      if (orient3d(base[i], base[(i + 1) % 4], base[(i + 3) % 4], apex) <= 0) return false;
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

namespace {

/// Walls with layers, their tops, what has none, and outside the sides of layers, which nothing else lies along.
class Skins {
 public:
  Skins(const Walls& walls, const Columns& columns, double ahead)
      : walls_(walls), columns_(columns), n_(static_cast<VertexIndex>(walls.surface.points.size())) {
    points_ = walls.surface.points;
    for (VertexIndex v = 0; v < n_; ++v)
      points_.push_back(points_[v] + (columns.top(walls.surface, v) - points_[v]) * ahead);
    for (std::uint32_t f = 0; f < walls.surface.triangles.size(); ++f) add(f);
    if (walls.is_outside)
      for (const Rim& rim : walls.rims) add_side(rim);
  }

  /// Triangles that have part in a conflict; ascending, each once.
  std::vector<std::uint32_t> conflicts(const RunContext& context) const {
    std::vector<std::uint32_t> found;
    for (const auto& pair : self_intersections(points_, triangles_, std::numeric_limits<std::size_t>::max(), context))
      for (const std::uint32_t i : pair) found.push_back(of_[i]);
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  bool is_moved(VertexIndex v) const { return columns_.count[v] > 0; }
  VertexIndex top(VertexIndex v) const { return is_moved(v) ? n_ + v : v; }
  void put(const Triangle& t, std::uint32_t of) { triangles_.push_back(t), of_.push_back(of); }

  void add(std::uint32_t f) {
    const Triangle& t = walls_.surface.triangles[f];
    const bool moves = is_moved(t[0]) || is_moved(t[1]) || is_moved(t[2]),
               stays = walls_.is_outside && !walls_.is_wall[f];
    if (stays || (moves && walls_.is_wall[f])) put(t, f);
    if (!stays) put({top(t[0]), top(t[1]), top(t[2])}, f);
  }

  void add_side(const Rim& rim) {
    if (is_moved(rim.b)) put({rim.a, rim.b, top(rim.b)}, rim.wall);
    if (is_moved(rim.a)) put({rim.a, top(rim.b), top(rim.a)}, rim.wall);
  }

  const Walls& walls_;
  const Columns& columns_;
  VertexIndex n_;
  std::vector<Vec3> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> of_;
};

}  // namespace

std::vector<std::uint32_t> crossing_triangles(const Walls& walls, const Columns& columns, double ahead,
                                              const RunContext& context) {
  return Skins(walls, columns, ahead).conflicts(context);
}

}  // namespace octafront::layers
