#include "images/nets/fairing.h"

#include "base/core/parallel.h"

#include <cmath>

namespace octafront::nets {

namespace {

// What bends over this many voxels takes about as many sweeps times 15: terraces of twenty become slopes.
constexpr int kSweeps = 300;
// One over the norm of the second differences' operator squared: 4 on even nets, somewhat more at curves.
constexpr double kStep = 1 / 4.5;

}  // namespace

void fair(const Stencils& stencils, const VertexCells& cells, std::vector<Vec3>& x, const RunContext& context) {
  const std::size_t n = x.size();
  std::vector<Vec3> ahead = x, weighted(n);
  double t = 1;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    context.check();
    const double t_next = (1 + std::sqrt(1 + 4 * t * t)) / 2, momentum = (t - 1) / t_next;
    t = t_next;
    parallel_for(n, [&](std::size_t i) {
      const auto v = static_cast<VertexIndex>(i);
      weighted[v] = stencils.difference(ahead, v) * stencils.weight(v);
    });
    parallel_for(n, [&](std::size_t i) {
      const auto v = static_cast<VertexIndex>(i);
      const Vec3 next = cells.clamped(v, ahead[v] - stencils.transposed(weighted, v) * kStep);
      ahead[v] = next + (next - x[v]) * momentum;
      x[v] = next;
    });
  }
}

}  // namespace octafront::nets
