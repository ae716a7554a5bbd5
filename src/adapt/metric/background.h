#pragma once

#include <octafront/metric.h>
#include <octafront/options.h>

#include "adapt/metric/metric.h"
#include "sizing/field/mesh_sizes.h"

#include <memory>
#include <vector>

namespace octafront::adapt {

/// What a MetricMesh asks for, everywhere.
class BackgroundMetric : public MetricField {
 public:
  /// Throws InputError for numbers that do not match, indices out of range, points that are not finite, a mesh without
  /// elements, and metrics that are not positive definite.
  explicit BackgroundMetric(const MetricMesh& mesh);
  Metric at(Vec3 p, std::uint32_t& hint) const override;
  bool is_isotropic() const override { return is_isotropic_; }

 private:
  std::shared_ptr<const SizeMesh> mesh_;
  MeshSizes places_;
  std::vector<Metric> logarithms_;
  bool is_isotropic_;
};

/// Throws InputError unless there are `count` metrics, all of them positive definite; `points` may be fewer, and tell
/// where. `what` they are: "the metric".
void require_metrics(std::span<const Metric> metrics, std::size_t count, std::span<const Vec3> points,
                     const std::string& what);

}  // namespace octafront::adapt
