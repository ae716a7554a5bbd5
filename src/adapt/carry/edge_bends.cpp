#include "adapt/carry/carry.h"

#include <limits>

namespace octafront::adapt {

EdgeBends::EdgeBends(const TetMesh& mesh, const OldValues& old, const RunContext& context)
    : mesh_(mesh),
      old_(old),
      least_(old.components, std::numeric_limits<double>::infinity()),
      greatest_(old.components, -std::numeric_limits<double>::infinity()) {
  for (std::size_t i = 0; i < old.values.size(); ++i) {
    const std::size_t k = i % old.components;
    least_[k] = std::min(least_[k], old.values[i]), greatest_[k] = std::max(greatest_[k], old.values[i]);
  }
  if (mesh.is_second_order()) return;
  for (std::size_t k = 0; k < old.components; ++k) {
    std::vector<double> values;
    for (std::size_t i = k; i < old.values.size(); i += old.components) values.push_back(old.values[i]);
    hessians_.push_back(metrics::hessians(mesh, values, context));
  }
}

double EdgeBends::bend(const Mixture& mixture, std::size_t k) const {
  double sum = 0;
  for (std::size_t e = 0; e < 6; ++e) {
    const double weight = 4 * mixture.parts[kTetEdges[e][0]] * mixture.parts[kTetEdges[e][1]];
    if (weight != 0) sum += weight * of_edge(mixture, e, k);
  }
  return sum;
}

double EdgeBends::of_edge(const Mixture& mixture, std::size_t edge, std::size_t k) const {
  const VertexIndex a = mixture.nodes[kTetEdges[edge][0]], b = mixture.nodes[kTetEdges[edge][1]];
  const auto value = [&](VertexIndex v) { return old_.values[v * old_.components + k]; };
  if (hessians_.empty())
    return mixture.mids[edge] == kNone ? 0 : value(mixture.mids[edge]) - 0.5 * (value(a) + value(b));
  const Vec3 along = mesh_.points[b] - mesh_.points[a];
  return -0.0625 * (hessians_[k][a].squared(along) + hessians_[k][b].squared(along));
}

}  // namespace octafront::adapt
