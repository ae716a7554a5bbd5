#include <octafront/error.h>
#include <octafront/metric.h>

#include "adapt/metric/metric.h"
#include "adapt/metric/neighbours.h"
#include "base/core/parallel.h"
#include "base/core/thread_limit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

namespace octafront::metrics {
namespace {

/// Gradient and second derivatives.
constexpr std::size_t kUnknowns = 9;
/// Neighbours of a patch, and rings that it may take to have them: a quadratic needs nine.
constexpr std::size_t kEnough = 24;
constexpr int kLeastRings = 2, kMostRings = 4;
/// What keeps a fit from asking more of a patch than its points say, against the mean of its squares.
constexpr double kRidge = 1e-11;

using Row = std::array<double, kUnknowns>;

/// A symmetric system of kUnknowns equations, to which rows of a fit are added.
class NormalEquations {
 public:
  void add(const Row& row, double value, double weight) {
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      right_[i] += weight * row[i] * value;
      for (std::size_t j = 0; j <= i; ++j) left_[i][j] += weight * row[i] * row[j];
    }
  }

  /// By Cholesky's decomposition.
  Row solved() {
    double trace = 0;
    for (std::size_t i = 0; i < kUnknowns; ++i) trace += left_[i][i];
    for (std::size_t i = 0; i < kUnknowns; ++i) left_[i][i] += kRidge * trace + 1e-300;
    for (std::size_t i = 0; i < kUnknowns; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = left_[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= left_[i][k] * left_[j][k];
        left_[i][j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / left_[j][j];
      }
    Row x = right_;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= left_[i][k] * x[k];
      x[i] /= left_[i][i];
    }
    for (std::size_t i = kUnknowns; i-- > 0;) {
      for (std::size_t k = i + 1; k < kUnknowns; ++k) x[i] -= left_[k][i] * x[k];
      x[i] /= left_[i][i];
    }
    return x;
  }

 private:
  std::array<Row, kUnknowns> left_{};
  Row right_{};
};

/// The vertices around one, ring by ring.
class Patch {
 public:
  explicit Patch(const Groups<>& neighbours) : neighbours_(neighbours), seen_(neighbours.size(), 0) {}

  const std::vector<VertexIndex>& around(VertexIndex v) {
    vertices_.assign(1, v);
    seen_[v] = 1;
    std::size_t begin = 0;
    for (int ring = 0; ring < kMostRings && (ring < kLeastRings || vertices_.size() <= kEnough); ++ring) {
      const std::size_t end = vertices_.size();
      for (; begin < end; ++begin)
        for (const VertexIndex w : neighbours_[vertices_[begin]])
          if (!seen_[w]) seen_[w] = 1, vertices_.push_back(w);
    }
    for (const VertexIndex w : vertices_) seen_[w] = 0;
    return vertices_;
  }

 private:
  const Groups<>& neighbours_;
  std::vector<std::uint8_t> seen_;
  std::vector<VertexIndex> vertices_;
};

Metric hessian_at(const TetMesh& mesh, std::span<const double> values, std::span<const VertexIndex> patch,
                  const Metric& implied) {
  const VertexIndex v = patch.front();
  // In whose coordinates the elements around are regular.
  const Metric root = adapt::root_of(implied);
  NormalEquations equations;
  for (const VertexIndex w : patch.subspan(1)) {
    const Vec3 d = root.times(mesh.points[w] - mesh.points[v]);
    const Row row{d.x, d.y, d.z, d.x * d.x / 2, d.x * d.y, d.x * d.z, d.y * d.y / 2, d.y * d.z, d.z * d.z / 2};
    equations.add(row, values[w] - values[v], 1 / std::max(squared_length(d), 1e-12));
  }
  const Row x = equations.solved();
  return adapt::between(root, {x[3], x[4], x[5], x[6], x[7], x[8]});
}

}  // namespace

std::vector<Metric> hessians(const TetMesh& mesh, std::span<const double> values, const RunContext& context) {
  if (values.size() != mesh.points.size())
    throw InputError(
        fmt::format("the field has {} values, but the mesh has {} points", values.size(), mesh.points.size()));
  for (std::size_t v = 0; v < values.size(); ++v)
    if (!std::isfinite(values[v])) {
      const Vec3 p = mesh.points[v];
      throw InputError(
          fmt::format("the field is {} at point {} ({:.6g}, {:.6g}, {:.6g})", values[v], v, p.x, p.y, p.z));
    }
  const ThreadLimit limit(context.threads);
  const std::vector<Metric> scales = implied(mesh);
  const Groups<> neighbours = adapt::neighbours_of(mesh);
  std::vector<Metric> out(values.size());
  parallel_ranges(out.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
    Patch patch(neighbours);
    for (std::size_t v = begin; v < end; ++v) {
      if (v % 1024 == 0) context.check();
      out[v] = hessian_at(mesh, values, patch.around(static_cast<VertexIndex>(v)), scales[v]);
    }
  });
  return out;
}

}  // namespace octafront::metrics
