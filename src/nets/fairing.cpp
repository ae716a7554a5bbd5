#include "nets/fairing.h"

#include "core/parallel.h"

#include <cmath>
#include <utility>

namespace octafront::nets {

namespace {

// First differences even out long waves soonest, but shrink; second ones put that right. Terraces twenty voxels long
// want this many of both.
constexpr int kFirstSweeps = 60, kSecondSweeps = 160;
constexpr double kFirstStep = 0.6;
// The second differences' operator squared has a norm of 4 on even nets and somewhat more at curves.
constexpr double kSecondStep = 1 / 6.0;

}  // namespace

void fair(const Stencils& stencils, const VertexCells& cells, std::vector<Vec3>& x, const RunContext& context) {
  const std::size_t n = x.size();
  std::vector<Vec3> next(n), r(n);
  const auto index = [](std::size_t v) { return static_cast<VertexIndex>(v); };
  for (int sweep = 0; sweep < kFirstSweeps; ++sweep) {
    context.check();
    parallel_for(n, [&](std::size_t v) {
      next[v] = cells.clamped(index(v), x[v] + stencils.difference(x, index(v)) * kFirstStep);
    });
    std::swap(x, next);
  }
  std::vector<Vec3> ahead = x;
  double t = 1;
  for (int sweep = 0; sweep < kSecondSweeps; ++sweep) {
    context.check();
    const double t_next = (1 + std::sqrt(1 + 4 * t * t)) / 2, momentum = (t - 1) / t_next;
    t = t_next;
    parallel_for(n, [&](std::size_t v) { r[v] = stencils.difference(ahead, index(v)); });
    parallel_for(n, [&](std::size_t v) {
      next[v] = cells.clamped(index(v), ahead[v] - stencils.transposed(r, index(v)) * kSecondStep);
    });
    parallel_for(n, [&](std::size_t v) { ahead[v] = next[v] + (next[v] - x[v]) * momentum; });
    std::swap(x, next);
  }
}

}  // namespace octafront::nets
