#include "base/geometry/measures.h"
#include "soup/mend/caps.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace octafront::mend {
namespace {

/// Up to here the best triangulation is found; longer polygons are cut in two.
constexpr std::size_t kExact = 256;
/// A cut leaves at least this part of the length on either side, and looks at so many corners.
constexpr double kLeastPart = 0.15;
constexpr std::size_t kCandidates = 800;

using Numbers = std::vector<std::uint32_t>;

class PolygonCap {
 public:
  PolygonCap(std::span<const Vec3> points, std::span<const Vec3> beyond, const IsTaken& is_taken, Least least)
      : points_(points), beyond_(beyond), is_taken_(is_taken), least_(least) {
    double around = 0;
    for (std::size_t i = 0; i < points.size(); ++i) around += distance(points[i], points[(i + 1) % points.size()]);
    penalty_ = around * static_cast<double>(points.size());
    per_area_ = around > 0 ? 1 / around : 0;
  }

  Cap result() {
    Numbers all(points_.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<Numbers> waiting{all};
    while (!waiting.empty()) {
      const Numbers polygon = std::move(waiting.back());
      waiting.pop_back();
      if (polygon.size() <= kExact) {
        fill(polygon);
        continue;
      }
      const auto [i, j] = chord(polygon);
      const auto at = [&](std::size_t k) { return polygon.begin() + static_cast<std::ptrdiff_t>(k); };
      Numbers inner(at(i), at(j + 1)), outer(at(j), polygon.end());
      outer.insert(outer.end(), polygon.begin(), at(i + 1));
      waiting.push_back(std::move(inner));
      waiting.push_back(std::move(outer));
    }
    return std::move(cap_);
  }

 private:
  Vec3 at(std::uint32_t i) const { return points_[i]; }

  /// The chord that is shortest against what it cuts off.
  std::array<std::size_t, 2> chord(const Numbers& polygon) const {
    const std::size_t n = polygon.size(), step = 1 + n / kCandidates;
    std::vector<double> along(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) along[i + 1] = along[i] + distance(at(polygon[i]), at(polygon[(i + 1) % n]));
    std::array<std::size_t, 2> best{0, n / 2};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; i += step)
      for (std::size_t j = i + step; j < n; j += step) {
        const double part = std::min(along[j] - along[i], along[n] - along[j] + along[i]);
        if (part < kLeastPart * along[n] || j - i < 2 || n - j + i < 2) continue;
        const double value = distance(at(polygon[i]), at(polygon[j])) / part;
        if (value < least) {
          least = value;
          best = {i, j};
        }
      }
    return best;
  }

  /// What lies on the other side of the edge from corner i of the polygon to corner j > i, as seen from a triangle
  /// beyond it; zero: unknown.
  Vec3 normal_below(const Numbers& polygon, std::size_t i, std::size_t j) const {
    if (j - i > 1) return normal_[i * polygon.size() + j];
    return is_rim(polygon[i], polygon[j]) ? beyond_[polygon[i]] : Vec3{};
  }
  bool is_rim(std::uint32_t a, std::uint32_t b) const { return (a + 1) % points_.size() == b; }

  double bend(const Numbers& polygon, std::size_t i, std::size_t j, Vec3 n, Vec3 other) const {
    return least_ == Least::kArea || other == Vec3{} ? 0
                                                     : distance(at(polygon[i]), at(polygon[j])) * distance(n, other);
  }

  /// Best costs of all sub-polygons i..j, by their size; what bends at their chord is added by the next larger one.
  void fill(const Numbers& polygon) {
    const std::size_t n = polygon.size();
    cost_.assign(n * n, 0);
    middle_.assign(n * n, kNoCorner);
    normal_.assign(n * n, {});
    for (std::size_t size = 2; size < n; ++size)
      for (std::size_t i = 0; i + size < n; ++i) find_best(polygon, i, i + size);
    std::vector<std::array<std::size_t, 2>> open{{0, n - 1}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (j - i < 2) continue;
      const std::size_t k = middle_[i * n + j];
      cap_.push_back({polygon[i], polygon[k], polygon[j]});
      open.push_back({i, k});
      open.push_back({k, j});
    }
  }

  void find_best(const Numbers& polygon, std::size_t i, std::size_t j) {
    const std::size_t n = polygon.size();
    const bool is_last = j - i == n - 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = i + 1; k < j; ++k) {
      const Vec3 twice = double_area_normal(at(polygon[i]), at(polygon[k]), at(polygon[j]));
      const double area = 0.5 * length(twice);
      const Vec3 normal = normalized(twice);
      double cost = cost_[i * n + k] + cost_[k * n + j] + per_area_ * area;
      if (cost >= least) continue;
      cost += bend(polygon, i, k, normal, normal_below(polygon, i, k)) +
              bend(polygon, k, j, normal, normal_below(polygon, k, j));
      if (is_last && is_rim(polygon[j], polygon[i])) cost += bend(polygon, i, j, normal, beyond_[polygon[j]]);
      if (cost >= least) continue;
      least = cost;
      middle_[i * n + j] = static_cast<std::uint32_t>(k);
      normal_[i * n + j] = normal;
    }
    cost_[i * n + j] = least + (!is_last && is_taken_(polygon[i], polygon[j]) ? penalty_ : 0);
  }

  static constexpr std::uint32_t kNoCorner = 0xffffffffu;

  std::span<const Vec3> points_;
  std::span<const Vec3> beyond_;
  const IsTaken& is_taken_;
  Least least_;
  double penalty_ = 0, per_area_ = 0;
  std::vector<double> cost_;
  std::vector<std::uint32_t> middle_;
  std::vector<Vec3> normal_;  ///< of the triangle at the chord
  Cap cap_;
};

}  // namespace

Cap triangulate_polygon(std::span<const Vec3> polygon, std::span<const Vec3> beyond, const IsTaken& is_taken,
                        Least least) {
  return PolygonCap(polygon, beyond, is_taken, least).result();
}

}  // namespace octafront::mend
