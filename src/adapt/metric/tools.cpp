#include <octafront/error.h>
#include <octafront/metric.h>
#include <octafront/surface_mesh.h>

#include "adapt/metric/background.h"
#include "adapt/metric/metric.h"
#include "adapt/metric/neighbours.h"
#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

void adapt::require_linear(const TetMesh& mesh) {
  if (mesh.is_second_order()) throw InputError("metrics belong to linear meshes: make_linear() makes this one so");
}

namespace metrics {
namespace {

using adapt::Eigen;

/// What grows with distance in space alone: the exponent of the mixed space.
constexpr double kShareOfSpace = 1.0 / 8;
/// A metric that is finer than what the other end allows by less than this part of a squared length stays.
constexpr double kSlackOfGrading = 2e-3;
/// Halvings of the scale in search of a complexity, and how near to it is near enough.
constexpr int kMostHalvings = 60;
constexpr double kNearEnough = 1e-9;
/// What gradation adds to a complexity is taken off in so many rounds at most.
constexpr int kRoundsOfTarget = 4;
constexpr double kNearTarget = 0.01;
/// Eigenvalues of hessians below this part of the largest at the place, and of the largest of all, count as that.
constexpr double kFlatHere = 1e-4, kFlatAnywhere = 1e-10;

void require_points(const TetMesh& mesh, std::span<const Metric> metrics) {
  adapt::require_linear(mesh);
  adapt::require_metrics(metrics, mesh.points.size(), mesh.points, "the metric");
}

void require_bounds(const Bounds& b) {
  if (!(b.min_size >= 0) || !(b.max_size > 0) || b.min_size > b.max_size)
    throw OptionError(
        fmt::format("sizes from {} to {}: the bounds of a metric must be lengths, the first one not "
                    "above the last",
                    b.min_size, b.max_size));
}

Metric cut(const Metric& m, double most, double least) {
  Eigen e = adapt::eigen(m);
  bool is_within = true;
  for (double& value : e.value) {
    const double inside = std::clamp(value, least, most);
    is_within &= inside == value;
    value = inside;
  }
  return is_within ? m : e.tensor();
}

double complexity_of(const TetMesh& mesh, std::span<const Metric> metrics) {
  return parallel_sum(mesh.tets.size(), [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      const double six = six_volumes(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
      double densities = 0;
      for (const VertexIndex v : mesh.tets[t]) densities += adapt::density_of(metrics[v]);
      sum += six / 24 * densities;
    }
    return sum;
  });
}

/// The bounds as eigenvalues: largest, least.
std::array<double, 2> values_of(const Bounds& b) {
  return {b.min_size > 0 ? 1 / (b.min_size * b.min_size) : HUGE_VAL, 1 / (b.max_size * b.max_size)};
}

std::vector<Metric> scaled_and_cut(std::span<const Metric> metrics, double factor, const Bounds& bounds) {
  std::vector<Metric> out(metrics.size());
  const std::array<double, 2> values = values_of(bounds);
  parallel_for(out.size(), [&](std::size_t v) { out[v] = cut(factor * metrics[v], values[0], values[1]); });
  return out;
}

/// Metrics with their eigenvectors, which one end of an edge is asked for again and again.
class Grading {
 public:
  Grading(const TetMesh& mesh, std::vector<Metric>& metrics, double gradation)
      : points_(mesh.points), metrics_(metrics), growth_(gradation), at_(metrics.size()) {
    parallel_for(at_.size(), [&](std::size_t v) { at_[v] = adapt::eigen(metrics_[v]); });
  }

  /// Makes q finer where it must be for p's sake; whether it was.
  bool reach(VertexIndex p, VertexIndex q) {
    const Metric allowed = grown(p, points_[q] - points_[p]);
    const Metric room = (1 + kSlackOfGrading) * metrics_[q] + -1.0 * allowed;
    if (adapt::is_metric(room)) return false;
    const Metric made = adapt::intersection(metrics_[q], allowed);
    if (made == metrics_[q]) return false;
    metrics_[q] = made;
    at_[q] = adapt::eigen(made);
    return true;
  }

 private:
  /// What the metric of p allows at the end of e.
  Metric grown(VertexIndex p, Vec3 e) const {
    Eigen m = at_[p];
    const double in_metric = 1 + growth_ * std::sqrt(std::max(metrics_[p].squared(e), 0.0)), long_e = length(e);
    for (double& value : m.value) {
      const double in_space = 1 + growth_ * std::sqrt(value) * long_e;
      // in_space^(1/8) in_metric^(7/8), by square roots.
      const double eighth = std::sqrt(std::sqrt(std::sqrt(in_space / in_metric)));
      const double factor = in_metric * eighth;
      value /= factor * factor;
    }
    return m.tensor();
  }

  static_assert(kShareOfSpace == 0.125);
  const std::vector<Vec3>& points_;
  std::vector<Metric>& metrics_;
  double growth_;
  std::vector<Eigen> at_;
};

double scale_for(const TetMesh& mesh, std::span<const Metric> metrics, double target, const Bounds& bounds) {
  // What is asked about many factors needs the eigenvalues alone, and the share of each point in the volume.
  std::vector<std::array<double, 3>> values(metrics.size());
  parallel_for(values.size(), [&](std::size_t v) { values[v] = adapt::eigen(metrics[v]).value; });
  std::vector<double> volume(metrics.size(), 0);
  for (const Tet& t : mesh.tets) {
    const double six = six_volumes(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
    for (const VertexIndex v : t) volume[v] += six / 24;
  }
  const std::array<double, 2> ends = values_of(bounds);
  const auto reached = [&](double factor) {
    return parallel_sum(volume.size(), [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t v = begin; v < end; ++v) {
        double determinant = 1;
        for (const double value : values[v]) determinant *= std::clamp(factor * value, ends[1], ends[0]);
        sum += volume[v] * std::sqrt(determinant);
      }
      return sum;
    });
  };
  const double start = complexity_of(mesh, metrics);
  const double power = target / start;
  double factor = elementary::cbrt(power * power);
  if (bounds.min_size == 0 && !std::isfinite(bounds.max_size)) return factor;
  double low = factor, high = factor;
  for (int i = 0; i < kMostHalvings && reached(low) > target; ++i) low /= 4;
  for (int i = 0; i < kMostHalvings && reached(high) < target; ++i) high *= 4;
  for (int i = 0; i < kMostHalvings && high > low * (1 + kNearEnough); ++i) {
    factor = std::sqrt(low) * std::sqrt(high);
    (reached(factor) < target ? low : high) = factor;
  }
  return high;
}

/// |H| det^(-1 / (2 p + 3)), where nothing is quite flat.
std::vector<Metric> scaled_hessians(std::vector<Metric> hessians, double norm) {
  double largest = 0;
  for (const Metric& h : hessians)
    for (const double value : adapt::eigen(h).value) largest = std::max(largest, std::abs(value));
  if (!(largest > 0) || !std::isfinite(largest))
    throw InputError("the field is linear: its hessian vanishes, and no place wants smaller elements than another");
  const double power = -1 / (2 * norm + 3);
  parallel_for(hessians.size(), [&](std::size_t v) {
    Eigen e = adapt::eigen(hessians[v]);
    double most = kFlatAnywhere * largest, determinant = 1;
    for (double& value : e.value) value = std::abs(value) / largest, most = std::max(most, value);
    for (double& value : e.value) value = std::max({value, kFlatHere * most, kFlatAnywhere}), determinant *= value;
    const double factor = elementary::pow(determinant, power);
    for (double& value : e.value) value *= factor;
    hessians[v] = e.tensor();
  });
  return hessians;
}

}  // namespace

std::vector<Metric> of_edges(const TetMesh& mesh) {
  adapt::require_linear(mesh);
  std::vector<double> sum(mesh.points.size(), 0);
  std::vector<std::uint32_t> count(mesh.points.size(), 0);
  // Inner edges count once for each element around them, as many for both of their ends.
  for (const Tet& t : mesh.tets)
    for (const auto& e : kTetEdges) {
      const VertexIndex a = t[static_cast<std::size_t>(e[0])], b = t[static_cast<std::size_t>(e[1])];
      const double length = distance(mesh.points[a], mesh.points[b]);
      for (const VertexIndex v : {a, b}) sum[v] += length, ++count[v];
    }
  std::vector<Metric> metrics(mesh.points.size());
  for (std::size_t v = 0; v < metrics.size(); ++v)
    if (count[v] > 0) metrics[v] = Metric::of_size(sum[v] / count[v]);
  return metrics;
}

std::vector<Metric> implied(const TetMesh& mesh) {
  adapt::require_linear(mesh);
  std::vector<Metric> sum(mesh.points.size(), Metric{0, 0, 0, 0, 0, 0});
  std::vector<double> weight(mesh.points.size(), 0);
  for (const Tet& t : mesh.tets) {
    const Vec3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]], d = mesh.points[t[3]];
    const double six = six_volumes(a, b, c, d);
    if (!(six > 0)) continue;
    const Metric log = adapt::log_of(adapt::implied_metric(a, b, c, d));
    for (const VertexIndex v : t) sum[v] = sum[v] + six * log, weight[v] += six;
  }
  parallel_for(sum.size(),
               [&](std::size_t v) { sum[v] = weight[v] > 0 ? adapt::exp_of((1 / weight[v]) * sum[v]) : Metric{}; });
  return sum;
}

std::vector<Metric> intersected(std::span<const Metric> a, std::span<const Metric> b) {
  adapt::require_metrics(a, a.size(), {}, "the first metric");
  adapt::require_metrics(b, a.size(), {}, "the second metric");
  std::vector<Metric> out(a.size());
  parallel_for(out.size(), [&](std::size_t v) { out[v] = adapt::intersection(a[v], b[v]); });
  return out;
}

std::vector<Metric> bounded(std::span<const Metric> metrics, const Bounds& bounds) {
  require_bounds(bounds);
  adapt::require_metrics(metrics, metrics.size(), {}, "the metric");
  return scaled_and_cut(metrics, 1, bounds);
}

std::vector<Metric> graded(const TetMesh& mesh, std::span<const Metric> metrics, double gradation,
                           const RunContext& context) {
  if (!(gradation > 0) || gradation > 10)
    throw OptionError(fmt::format("a gradation of {}: metrics grow by more than 0 and at most 10", gradation));
  require_points(mesh, metrics);
  const ThreadLimit limit(context.threads);
  std::vector<Metric> out(metrics.begin(), metrics.end());
  const Groups<> neighbours = adapt::neighbours_of(mesh);
  Grading grading(mesh, out, gradation);
  // In the order of the points and back, each sweep from where the last ones changed something.
  const std::size_t n = out.size();
  std::vector<std::uint8_t> active(n, 1);
  bool is_left = true;
  for (int sweep = 0; sweep < kMostSweeps && is_left; ++sweep) {
    is_left = false;
    for (std::size_t i = 0; i < n; ++i) {
      const auto p = static_cast<VertexIndex>(sweep % 2 == 0 ? i : n - 1 - i);
      if (i % 1024 == 0) context.check();
      if (!active[p]) continue;
      active[p] = 0;
      for (const VertexIndex q : neighbours[p])
        if (grading.reach(p, q)) active[q] = 1, is_left = true;
    }
  }
  return out;
}

double complexity(const TetMesh& mesh, std::span<const Metric> metrics) {
  require_points(mesh, metrics);
  return complexity_of(mesh, metrics);
}

std::vector<Metric> with_complexity(const TetMesh& mesh, std::span<const Metric> metrics, double complexity,
                                    const Bounds& bounds) {
  require_points(mesh, metrics);
  require_bounds(bounds);
  if (!(complexity > 0) || !std::isfinite(complexity))
    throw OptionError(fmt::format("a complexity of {}: it must be above 0", complexity));
  return scaled_and_cut(metrics, scale_for(mesh, metrics, complexity, bounds), bounds);
}

std::vector<Metric> of_field(const TetMesh& mesh, std::span<const double> values, const FromField& options,
                             const RunContext& context) {
  if (!(options.elements > 0) || !std::isfinite(options.elements))
    throw OptionError(fmt::format("{} elements: a metric from a field needs a number above 0", options.elements));
  if (!(options.norm >= 1)) throw OptionError(fmt::format("a norm of L^{}: p must be at least 1", options.norm));
  if (!(options.gradation >= 0)) throw OptionError(fmt::format("a gradation of {}: below 0", options.gradation));
  require_bounds(options.bounds);
  const ThreadLimit limit(context.threads);
  const double target = options.elements / kElementsPerComplexity;
  Bounds bounds = options.bounds;
  // Nothing can be longer than the body.
  bounds.max_size = std::min(bounds.max_size, bounding_box(mesh.points).diagonal());
  bounds.min_size = std::min(bounds.min_size, bounds.max_size);
  const std::vector<Metric> wanted = scaled_hessians(hessians(mesh, values, context), options.norm);
  double asked = target;
  std::vector<Metric> made;
  for (int round = 0; round < kRoundsOfTarget; ++round) {
    made = with_complexity(mesh, wanted, asked, bounds);
    if (options.gradation == 0) break;
    made = graded(mesh, made, options.gradation, context);
    const double reached = complexity_of(mesh, made);
    if (std::abs(reached - target) < kNearTarget * target) break;
    asked *= target / reached;
  }
  return options.gradation == 0 ? made : with_complexity(mesh, made, target, bounds);
}

}  // namespace metrics
}  // namespace octafront
