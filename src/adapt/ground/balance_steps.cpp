#include "adapt/ground/balance_steps.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>

namespace octafront::adapt {
namespace {

/// Triangles that are nearer to the ground than this part of the tolerance have nothing to balance.
constexpr double kFlatEnough = 0.02;
/// Each side of a triangle is divided into so many for the places where heights are taken.
constexpr int kDivisionsOfBalance = 3;
/// How far the ground is looked for, in parts of the longest edge.
constexpr double kReachOfBalance = 0.5;
/// No step is longer than this part of the tolerance; those shorter than this part are none.
constexpr double kLongestOfBalance = 0.5, kLeastOfBalance = 1e-3;
/// Around points where walls fold, the sum of normals less than this part of the areas, there is no side to go to.
constexpr double kLeastNormal = 0.3;

/// visit(weights) for the middles of equal parts of a triangle.
template <class Visit>
void for_each_place(const Visit& visit) {
  constexpr int n = kDivisionsOfBalance;
  const auto place = [&](double i, double j) { visit(Vec3{(n - i - j) / n, i / n, j / n}); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      place(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j + 1 < n) place(i + 2.0 / 3, j + 2.0 / 3);
    }
}
constexpr double kPlaces = kDivisionsOfBalance * kDivisionsOfBalance;

class Balance {
 public:
  Balance(const Walls& walls, std::span<const std::uint8_t> may_move, std::span<const std::uint8_t> waits,
          std::span<const std::uint32_t> near, const Ground& ground, std::span<const double> tolerance)
      : walls_(walls),
        may_move_(may_move),
        waits_(waits),
        near_(near),
        ground_(ground),
        tolerance_(tolerance),
        tree_(walls.surface),
        smooth_(walls.surface, walls.edges, tree_, walls.lines) {}

  std::vector<Vec3> steps() {
    const std::size_t count = walls_.surface.triangles.size();
    std::vector<std::uint8_t> strays(count, 0);
    parallel_for(count, [&](std::size_t t) {
      const Triangle& c = walls_.surface.triangles[t];
      const bool any_waits = std::any_of(c.begin(), c.end(), [&](VertexIndex v) { return waits_[v] != 0; });
      strays[t] = any_waits && is_stray(static_cast<std::uint32_t>(t));
    });
    std::vector<curved::Foot> feet;
    for (std::uint32_t t = 0; t < count; ++t)
      if (strays[t]) feet.push_back({tree_.corners(t)[0], t});
    smooth_.prepare(feet, {});
    std::vector<Vec3> volumes(feet.size());
    parallel_for(feet.size(), [&](std::size_t k) { volumes[k] = volumes_at(feet[k].on); });
    return steps_by(feet, volumes);
  }

 private:
  std::uint32_t near_of(std::uint32_t t) const { return near_[walls_.surface.triangles[t][0]]; }
  bool is_stray(std::uint32_t t) const {
    const TriangleCorners& c = tree_.corners(t);
    const double reach = kReachOfBalance * std::sqrt(longest_squared_edge(c[0], c[1], c[2]));
    const double far = ground_.truth_of(c, walls_.surface.patch[t], walls_.outer[t] != 0, reach, near_of(t)).distance;
    return std::isfinite(far) && far > kFlatEnough * tolerance_[walls_.surface.patch[t]];
  }

  /// What lies between the smooth surface over a triangle and the ground, each corner's share.
  Vec3 volumes_at(std::uint32_t t) const {
    const TriangleCorners& c = tree_.corners(t);
    const Vec3 normal = double_area_normal(c[0], c[1], c[2]);
    const double twice = length(normal), reach = kReachOfBalance * std::sqrt(longest_squared_edge(c[0], c[1], c[2]));
    Vec3 volumes{};
    if (!(twice > 0)) return volumes;
    std::uint32_t near = near_of(t);
    for_each_place([&](Vec3 w) {
      const Vec3 from = smooth_.surface_point({w.x * c[0] + w.y * c[1] + w.z * c[2], t});
      const auto to = ground_.on_surface(from, walls_.surface.patch[t], walls_.outer[t] != 0, normal, reach, near);
      if (to) volumes += dot(*to - from, normal) / (2 * kPlaces) * w;
    });
    return volumes;
  }

  void share_out(std::uint32_t t, Vec3 shares, std::vector<double>& volume) const {
    const Triangle& corners = walls_.surface.triangles[t];
    double left = 0;
    int takers = 0;
    for (int i = 0; i < 3; ++i) may_move_[corners[i]] ? void(++takers) : void(left += shares[i]);
    for (int i = 0; i < 3; ++i)
      if (may_move_[corners[i]]) volume[corners[i]] += shares[i] + left / takers;
  }

  std::vector<Vec3> steps_by(const std::vector<curved::Foot>& feet, const std::vector<Vec3>& volumes) const {
    const SurfaceMesh& surface = walls_.surface;
    std::vector<Vec3> normal(surface.points.size()), step(surface.points.size());
    std::vector<double> area(surface.points.size(), 0), volume(surface.points.size(), 0);
    std::vector<double> tolerance(surface.points.size(), HUGE_VAL);
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
      const TriangleCorners& c = tree_.corners(t);
      const Vec3 n = 0.5 * double_area_normal(c[0], c[1], c[2]);
      for (const VertexIndex v : surface.triangles[t]) {
        normal[v] += n, area[v] += length(n);
        tolerance[v] = std::min(tolerance[v], tolerance_[surface.patch[t]]);
      }
    }
    for (std::size_t k = 0; k < feet.size(); ++k) share_out(feet[k].on, volumes[k], volume);
    for (std::size_t v = 0; v < step.size(); ++v) {
      const double size = length(normal[v]);
      if (!waits_[v] || !(size > kLeastNormal * area[v])) continue;
      // A point that moves takes a third of its normal's volume along.
      const double most = kLongestOfBalance * tolerance[v], way = std::clamp(3 * volume[v] / size, -most, most);
      if (std::abs(way) > kLeastOfBalance * tolerance[v]) step[v] = way / size * normal[v];
    }
    return step;
  }

  const Walls& walls_;
  std::span<const std::uint8_t> may_move_, waits_;
  std::span<const std::uint32_t> near_;
  const Ground& ground_;
  std::span<const double> tolerance_;
  TriangleTree tree_;
  curved::SmoothSurface smooth_;
};

}  // namespace

std::vector<Vec3> steps_to_balance(const Walls& walls, std::span<const std::uint8_t> may_move,
                                   std::span<const std::uint8_t> waits, std::span<const std::uint32_t> near,
                                   const Ground& ground, std::span<const double> tolerance) {
  return Balance(walls, may_move, waits, near, ground, tolerance).steps();
}

}  // namespace octafront::adapt
