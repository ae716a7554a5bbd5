// Removal of a vertex by the collapse of an edge: the vertex goes to a neighbour, the elements around that edge vanish.
// Mends what stands too close: meshes of other tools have more of it than ours.

#include "improve/passes/fewest_poor.h"
#include "improve/passes/passes.h"
#include "improve/passes/poor_tets.h"
#include "improve/passes/star_edit.h"

#include <algorithm>

namespace octafront::improve {
namespace {

/// New edges are at most this many times as long as the mean edge of the star that they replace: sizes stay honest.
constexpr double kLongestOfCollapse = 2;
/// What the sum of (1 - beta)^2 must fall to, as a part of what it was; or by how much the worst score must rise. The
/// sum and not the mean: elements go as well, and meshes of others often have too many (Netgen's start meshes a third).
constexpr double kFall = 0.9;
constexpr float kRise = 0.05f;
/// What the sum that elements lack must fall by.
constexpr double kLeastFallByCollapse = 0.1;
constexpr double kNever = 1e9;

class Collapser {
 public:
  Collapser(EditMesh& mesh, Goal goal) : editor_(mesh), mesh_(mesh), floor_(mesh.floor()), goal_(goal), star_(mesh) {}

  /// Each vertex of the elements once.
  PassResult run(float threshold, const RunContext& context) {
    PassResult result;
    std::vector<std::uint8_t> seen(mesh_.vertices(), 0);
    std::vector<HalfFace> star;
    for (const TetIndex t : tets_below(mesh_, threshold)) {
      context.check();
      for (int i = 0; i < 4; ++i) {
        if (!mesh_.alive(t) || mesh_.shape(t).score >= threshold) break;
        const VertexIndex v = mesh_.tet(t)[i];
        if (mesh_.on_boundary(v) || seen[v]) continue;
        seen[v] = 1;
        ++result.tried;
        editor_.star(v, star);
        result.done += improve(v, star);
      }
    }
    return result;
  }

 private:
  /// True if vertex v is gone.
  bool improve(VertexIndex v, std::span<const HalfFace> faces) {
    if (!star_.load(v, faces)) return false;
    old_worst_ = star_.current_worst();
    old_lack_ = goal_ == Goal::kFewestPoor ? star_.current_lack() : star_.current_deficit();
    find_neighbours(v);
    VertexIndex best = kNone;
    double least = goal_ == Goal::kFewestPoor ? old_lack_ - kLeastFallByCollapse : kFall * old_lack_;
    for (const VertexIndex u : neighbours_) {
      const double lack = lack_at(u);
      if (lack < least) least = lack, best = u;
    }
    if (best == kNone) return false;
    return collapse_to(best);
  }

  void find_neighbours(VertexIndex v) {
    neighbours_.clear();
    for (const HalfFace h : star_.faces())
      for (const VertexIndex u : mesh_.tet(h / 4))
        if (u != v) neighbours_.push_back(u);
    std::sort(neighbours_.begin(), neighbours_.end());
    neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
    double sum = 0;
    for (const VertexIndex u : neighbours_) sum += distance(mesh_.point(v), mesh_.point(u));
    const double mean = sum / static_cast<double>(neighbours_.size());
    squared_limit_ = kLongestOfCollapse * kLongestOfCollapse * mean * mean;
  }

  /// What is to fall, with the vertex at its neighbour u: sum of (1 - beta)^2, or for kFewestPoor the sum of what the
  /// elements lack; kNever if that is not allowed.
  double lack_at(VertexIndex u) {
    const Vec3 p = mesh_.point(u);
    for (const VertexIndex w : neighbours_)
      if (squared_length(mesh_.point(w) - p) > squared_limit_) return kNever;
    star_.evaluate(p);
    const ShapeBatch& batch = star_.batch();
    double sum = 0, poor = 0;
    float worst = 1;
    for (int k = 0; k < batch.size; ++k) {
      if (mesh_.has(star_.faces()[k] / 4, u)) continue;
      const Shape s = batch.shape(k);
      if (s.beta < kCertainBeta || !floor_.below(s)) return kNever;
      worst = std::min(worst, s.score);
      sum += (1 - double{s.beta}) * (1 - double{s.beta});
      poor += lack_of(s.score);
    }
    if (goal_ == Goal::kFewestPoor) return poor;
    if (worst <= old_worst_ && worst <= kMeanRisesGuard) return kNever;
    return worst > old_worst_ + kRise ? kFall * sum : sum;
  }

  bool collapse_to(VertexIndex u) {
    star_.evaluate(mesh_.point(u));
    refill_.clear();
    for (std::size_t k = 0; k < star_.faces().size(); ++k) {
      const HalfFace h = star_.faces()[k];
      refill_.old_tets.push_back(h / 4);
      if (mesh_.has(h / 4, u)) continue;
      Tet t = mesh_.tet(h / 4);
      t[h % 4] = u;
      refill_.add(t, star_.batch().shape(static_cast<int>(k)));
    }
    return editor_.replace(refill_);
  }

  MeshEditor editor_;
  EditMesh& mesh_;
  Floor floor_;
  Goal goal_;
  StarEdit star_;
  float old_worst_ = 0;
  double old_lack_ = 0, squared_limit_ = 0;
  std::vector<VertexIndex> neighbours_;
  MeshEditor::Refill refill_;
};

}  // namespace

PassResult collapse_vertices(EditMesh& mesh, float threshold, Goal goal, const RunContext& context) {
  return Collapser(mesh, goal).run(threshold, context);
}

}  // namespace octafront::improve
