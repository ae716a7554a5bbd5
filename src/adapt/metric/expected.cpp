#include "adapt/metric/expected.h"

#include "base/core/index_range.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace octafront::adapt {
namespace {

/// Triangles for each unit of area in a metric: regular ones of edge 1 have an area of sqrt(3) / 4.
constexpr double kTrianglesPerArea = 2.3;
/// Places looked at in all, at least: coarse meshes have metrics that change within their elements.
constexpr double kPlacesOfMetric = 16384;
/// Within a part of an element densities differ by no more, or it makes no more elements than this.
constexpr double kEvenDensity = 3, kLittle = 1;
constexpr int kMostHalvingsOfCount = 64;
/// What comes to so many elements is not known better: no mesh will be made of it.
constexpr double kSurelyTooMany = 1e6 * static_cast<double>(kMostElements);

/// The integral of a density over a simplex of N corners, times `scale`; `Density` tells that at a place.
template <std::size_t N, class Density>
class ElementsIn {
 public:
  struct Sample {
    Vec3 at;
    double density;
  };
  using Corners = std::array<Sample, N>;

  ElementsIn(const Density& density, int least_depth) : density_(density), least_depth_(least_depth) {}

  /// `measure`: the volume or area, times elements for each unit of it.
  double of(const Corners& corners, double measure, int depth = 0) const {
    double sum = 0, least = HUGE_VAL, most = 0;
    for (const Sample& s : corners)
      sum += s.density, least = std::min(least, s.density), most = std::max(most, s.density);
    const double count = measure * sum / N;
    const bool is_even = most <= kEvenDensity * least || count <= kLittle;
    if ((depth >= least_depth_ && is_even) || depth >= kMostHalvingsOfCount || !(count < kSurelyTooMany)) return count;
    const auto [i, j] = longest_edge(corners);
    const Vec3 middle = 0.5 * (corners[i].at + corners[j].at);
    const Sample made{middle, density_(middle)};
    Corners one = corners, other = corners;
    one[i] = made, other[j] = made;
    return of(one, measure / 2, depth + 1) + of(other, measure / 2, depth + 1);
  }

 private:
  static std::array<std::size_t, 2> longest_edge(const Corners& corners) {
    std::array<std::size_t, 2> best{0, 1};
    double longest = -1;
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = i + 1; j < N; ++j) {
        const double d = squared_distance(corners[i].at, corners[j].at);
        if (d > longest) longest = d, best = {i, j};
      }
    return best;
  }

  const Density& density_;
  int least_depth_;
};

int least_depth_for(std::size_t elements) {
  return elements == 0 ? 0 : std::max(0, std::ilogb(kPlacesOfMetric / static_cast<double>(elements)));
}

std::vector<double> at_points(std::span<const Vec3> points, const auto& density) {
  std::vector<double> all(points.size());
  parallel_for(all.size(), [&](std::size_t v) { all[v] = density(points[v]); });
  return all;
}

}  // namespace

double expected_tets(const TetMesh& mesh, const MetricField& metric) {
  const auto density = [&](Vec3 p) {
    std::uint32_t hint = 0;
    return density_of(metric.at(p, hint));
  };
  const std::vector<double> at = at_points(mesh.points, density);
  const ElementsIn<4, decltype(density)> elements(density, least_depth_for(mesh.tets.size()));
  return parallel_sum(mesh.tets.size(), [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      const auto& p = mesh.points;
      sum += elements.of({{{p[a], at[a]}, {p[b], at[b]}, {p[c], at[c]}, {p[d], at[d]}}},
                         metrics::kElementsPerComplexity * six_volumes(p[a], p[b], p[c], p[d]) / 6);
    }
    return sum;
  });
}

double expected_triangles(const SurfaceMesh& surface, const MetricField& metric) {
  return parallel_sum(surface.triangles.size(), [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = surface.triangles[t];
      const auto& p = surface.points;
      const Vec3 u = p[b] - p[a], w = p[c] - p[a];
      // The area of this very triangle in the metric of a place.
      const auto area = [&](Vec3 at) {
        std::uint32_t hint = 0;
        return metric_area(metric.at(at, hint), u, w);
      };
      const ElementsIn<3, decltype(area)> elements(area, least_depth_for(surface.triangles.size()));
      sum += elements.of({{{p[a], area(p[a])}, {p[b], area(p[b])}, {p[c], area(p[c])}}}, kTrianglesPerArea);
    }
    return sum;
  });
}

}  // namespace octafront::adapt
