#pragma once

// Between what stays and what changes lengths must grow: next to a face that cannot be divided no element can be much
// smaller than it is.

#include <octafront/tet_mesh.h>

#include "adapt/metric/metric.h"
#include "base/geometry/triangle_tree.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::adapt {

/// A metric that next to faces that stay is what the mesh is like there, and changes from there by half a length for
/// each length of way: lengths of less than those come within two elements. Const and safe on any number of threads.
class RimMetric : public MetricField {
 public:
  /// The faces whose vertices are all frozen, of tets that have one that is not. `wanted` must outlive this.
  RimMetric(const TetMesh& mesh, std::span<const std::uint8_t> frozen, const MetricField& wanted);
  /// These faces. In metrics of size their own edges say what the mesh is like, for they stay whatever is behind them.
  RimMetric(const TetMesh& mesh, const std::vector<Triangle>& faces, const MetricField& wanted);

  Metric at(Vec3 p, std::uint32_t& hint) const override;
  bool is_isotropic() const override { return wanted_.is_isotropic(); }

 private:
  RimMetric(const TetMesh& mesh, const std::vector<Triangle>& faces, const std::vector<Metric>& logs,
            const MetricField& wanted);

  const MetricField& wanted_;
  std::vector<std::array<Metric, 3>> faces_;  ///< logarithms of the metrics at their corners
  TriangleTree tree_;
};

/// Per vertex 1 if it lies on the boundary or an interface.
std::vector<std::uint8_t> on_walls(const TetMesh& mesh);

}  // namespace octafront::adapt
