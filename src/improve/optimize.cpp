#include "improve/maximize_worst.h"
#include "improve/passes.h"
#include "improve/star_edit.h"

namespace octafront::improve {
namespace {

constexpr int kSteps = 8;  ///< steps per vertex at most

/// What the worst must gain for each unit that the sum of (1 - beta)^2 around the vertex rises. Where the boundary
/// forces a bad element, good ones around it would otherwise pay for next to nothing.
constexpr double kPrice = 0.1;

}  // namespace

PassResult optimize_vertices(EditMesh& mesh, float threshold, const RunContext& context) {
  PassResult result;
  const Floor floor = mesh.floor();
  StarEdit star(mesh);
  WorstMaximizer maximizer;
  std::vector<std::uint8_t> seen(mesh.vertices(), 0);
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (t % 4096 == 0) context.check();
    if (!mesh.alive(t) || mesh.shape(t).score >= threshold) continue;
    for (const VertexIndex v : mesh.tet(t)) {
      if (mesh.on_boundary(v) || seen[v]) continue;
      seen[v] = 1;
      if (!star.load(v) || star.current_worst() >= threshold) continue;
      ++result.tried;
      maximizer.climb(star.batch(), mesh.point(v), kSteps, [&](Vec3 at) { return star.acceptable(at, floor); });
      if (!maximizer.moved()) continue;
      star.evaluate(maximizer.place());
      const double cost = star.batch().deficit() - star.current_deficit();
      if (star.worst_score() - star.current_worst() < kPrice * cost) continue;
      star.commit();
      ++result.done;
    }
  }
  return result;
}

}  // namespace octafront::improve
