#include "mend/cap.h"

#include "geometry/measures.h"

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
  PolygonCap(std::span<const Vec3> points, const IsTaken& is_taken) : points_(points), is_taken_(is_taken) {
    double around = 0;
    for (std::size_t i = 0; i < points.size(); ++i) around += distance(points[i], points[(i + 1) % points.size()]);
    penalty_ = around * around;
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

  /// Best costs of all sub-polygons i..j, by their size.
  void fill(const Numbers& polygon) {
    const std::size_t n = polygon.size();
    cost_.assign(n * n, 0);
    middle_.assign(n * n, kNoCorner);
    for (std::size_t size = 2; size < n; ++size)
      for (std::size_t i = 0; i + size < n; ++i) {
        const std::size_t j = i + size;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < j; ++k) {
          const double cost = cost_[i * n + k] + cost_[k * n + j] +
                              triangle_area(at(polygon[i]), at(polygon[k]), at(polygon[j]));
          if (cost < least) {
            least = cost;
            middle_[i * n + j] = static_cast<std::uint32_t>(k);
          }
        }
        const bool is_chord = size < n - 1;
        cost_[i * n + j] = least + (is_chord && is_taken_(polygon[i], polygon[j]) ? penalty_ : 0);
      }
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

  static constexpr std::uint32_t kNoCorner = 0xffffffffu;

  std::span<const Vec3> points_;
  const IsTaken& is_taken_;
  double penalty_ = 0;
  std::vector<double> cost_;
  std::vector<std::uint32_t> middle_;
  Cap cap_;
};

}  // namespace

Cap triangulate_polygon(std::span<const Vec3> polygon, const IsTaken& is_taken) {
  return PolygonCap(polygon, is_taken).result();
}

}  // namespace octafront::mend
