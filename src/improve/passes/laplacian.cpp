#include "improve/passes/passes.h"
#include "improve/passes/star_edit.h"
#include "improve/passes/vertex_stars.h"

#include <algorithm>

namespace octafront::improve {
namespace {

/// Mean of the neighbours of a vertex, each counted once, weighted by the length of the edge to it.
class NeighbourMean {
 public:
  explicit NeighbourMean(const EditMesh& mesh) : mesh_(mesh), seen_(mesh.vertices(), kNone) {}

  Vec3 operator()(VertexIndex v, std::span<const HalfFace> star) {
    const Vec3 p = mesh_.point(v);
    Vec3 sum;
    double weights = 0;
    for (const HalfFace h : star)
      for (const int corner : kTetFaces[h % 4]) {
        const VertexIndex u = mesh_.tet(h / 4)[corner];
        if (seen_[u] == v) continue;
        seen_[u] = v;
        const Vec3 edge = mesh_.point(u) - p;
        const double weight = length(edge);
        sum += weight * edge;
        weights += weight;
      }
    return weights > 0 ? p + sum / weights : p;
  }

 private:
  const EditMesh& mesh_;
  std::vector<VertexIndex> seen_;  ///< the last vertex whose neighbour this one was
};

bool is_good_enough(const EditMesh& mesh, std::span<const HalfFace> star) {
  return std::all_of(star.begin(), star.end(), [&](HalfFace h) { return mesh.shape(h / 4).beta > kGoodEnough; });
}

bool allowed(const EditMesh& mesh, const StarEdit& star, MoveRule rule) {
  float old_worst = 2, new_worst = 2;
  double gain = 0;
  const ShapeBatch& batch = star.batch();
  for (int i = 0; i < batch.size; ++i) {
    const Shape before = mesh.shape(star.faces()[i] / 4), after = batch.shape(i);
    const bool paper = rule == MoveRule::kWorstRises;
    old_worst = std::min(old_worst, paper ? before.beta : before.score);
    new_worst = std::min(new_worst, paper ? after.beta : after.score);
    gain += double{after.beta} - double{before.beta};
  }
  if (rule == MoveRule::kWorstRises) return new_worst > old_worst;
  return gain > 0 && (new_worst > old_worst || new_worst > kMeanRisesGuard);
}

}  // namespace

PassResult laplacian_sweeps(EditMesh& mesh, int sweeps, double relaxation, MoveRule rule, const RunContext& context) {
  PassResult result;
  const bool all = rule == MoveRule::kWorstRises;
  const VertexStars stars(mesh, nullptr, [all](const Shape& s) { return all || s.beta <= kGoodEnough; });
  const Floor floor = mesh.floor();
  StarEdit edit(mesh);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    NeighbourMean mean(mesh);  // anew each time: it knows the last vertex that asked, not the sweep
    result += stars.run(context, [&](VertexIndex v, std::span<const HalfFace> star) -> PassResult {
      if (!all && is_good_enough(mesh, star)) return {};
      if (!edit.load(v, star)) return {};
      const Vec3 p = mesh.point(v);
      edit.evaluate(p + relaxation * (mean(v, star) - p));
      if (!allowed(mesh, edit, rule) || !edit.acceptable(floor)) return {1, 0};
      edit.commit();
      return {1, 1};
    });
  }
  return result;
}

}  // namespace octafront::improve
