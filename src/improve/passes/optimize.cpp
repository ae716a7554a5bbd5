#include "improve/passes/passes.h"
#include "improve/passes/poor_tets.h"
#include "improve/passes/star_edit.h"
#include "improve/shape/maximize_worst.h"

#include <optional>

namespace octafront::improve {
namespace {

constexpr int kStepsOfVertex = 8;  ///< steps per vertex at most

/// What the worst must gain for each unit that the sum of (1 - beta)^2 around the vertex rises. Where the boundary
/// forces a bad element, good ones around it would otherwise pay for next to nothing.
constexpr double kPrice = 0.1;

class WorstOptimizer {
 public:
  WorstOptimizer(EditMesh& mesh, const BoundaryGuide* guide, float threshold)
      : editor_(mesh),
        mesh_(mesh),
        guide_(guide),
        threshold_(threshold),
        floor_(mesh.floor()),
        star_(mesh),
        seen_(mesh.vertices(), 0) {
    if (guide) sliding_.emplace(mesh_, *guide);
  }

  /// Each vertex once.
  PassResult around(TetIndex t) {
    PassResult result;
    for (const VertexIndex v : mesh_.tet(t)) {
      const bool slides = mesh_.on_boundary(v);
      if (seen_[v] || (slides && !(guide_ && guide_->may_slide(v)))) continue;
      seen_[v] = 1;
      editor_.star(v, walked_);
      if (!star_.load(v, walked_) || star_.current_worst() >= threshold_) continue;
      ++result.tried;
      result.done += slides ? slide(v) : move(v);
    }
    return result;
  }

 private:
  bool move(VertexIndex v) {
    maximizer_.climb(star_.batch(), mesh_.point(v), kStepsOfVertex,
                     [&](Vec3 at) { return star_.acceptable(at, floor_); });
    return commit();
  }

  bool slide(VertexIndex v) {
    if (!sliding_->load(v, star_.faces())) return false;
    maximizer_.climb_along(
        sliding_->axes(), [&](Vec3& place) { return sliding_->snap(place); }, star_.batch(), mesh_.point(v),
        kStepsOfVertex, [&](Vec3 at) { return star_.acceptable(at, floor_) && sliding_->keeps_truth(at); });
    return commit();
  }

  bool commit() {
    if (!maximizer_.moved()) return false;
    star_.evaluate(maximizer_.place());
    const double cost = star_.batch().deficit() - star_.current_deficit();
    if (star_.worst_score() - star_.current_worst() < kPrice * cost) return false;
    star_.commit();
    return true;
  }

  MeshEditor editor_;
  EditMesh& mesh_;
  const BoundaryGuide* guide_;
  float threshold_;
  Floor floor_;
  StarEdit star_;
  std::optional<SlidingVertex> sliding_;
  WorstMaximizer maximizer_;
  std::vector<HalfFace> walked_;
  std::vector<std::uint8_t> seen_;  ///< vertices that were looked at
};

}  // namespace

PassResult optimize_vertices(EditMesh& mesh, float threshold, const RunContext& context, const BoundaryGuide* guide) {
  PassResult result;
  WorstOptimizer optimizer(mesh, guide, threshold);
  for (const TetIndex t : tets_below(mesh, threshold)) {
    context.check();
    if (mesh.shape(t).score < threshold) result += optimizer.around(t);
  }
  return result;
}

}  // namespace octafront::improve
