// Non-smooth optimisation of a vertex: the least of the scores around it is maximised. Each step takes the scores as
// linear (gradients by differences, a whole star at once) and maximises
//   min_i (q_i + g_i . d) - |d|^2 / (2 reach),
// whose dual is a quadratic form over the simplex, solved by a few Frank-Wolfe steps. No set of "active" elements has
// to be guessed, unlike in Freitag & Ollivier-Gooch, "Tetrahedral mesh improvement using swapping and smoothing"
// (1997), whose aim this shares.

#include "improve/passes.h"
#include "improve/star_edit.h"

#include <array>
#include <cmath>

namespace octafront::improve {
namespace {

constexpr int kSteps = 8;             ///< gradients per vertex at most
constexpr int kShorter = 3;           ///< shorter tries per gradient
constexpr double kFirstReach = 0.15;  ///< in squared edge lengths
constexpr double kDifference = 1e-6;  ///< step of the differences, in edge lengths
constexpr double kLeastGain = 2e-3;   ///< predicted gains below this are not worth a try

class VertexOptimizer {
 public:
  VertexOptimizer(EditMesh& mesh, const Floor& floor) : mesh_(mesh), floor_(floor), star_(mesh) {}

  /// True if the vertex moved.
  bool run(VertexIndex v, float threshold) {
    if (!star_.load(v)) return false;
    float worst = star_.current_worst();
    if (worst >= threshold) return false;
    const float start = worst;
    Vec3 at = mesh_.point(v);
    const double edge = star_.batch().mean_edge(at);
    double reach = kFirstReach * edge * edge;
    bool moved = false;
    for (int step = 0; step < kSteps; ++step) {
      linearize(at, edge * kDifference);
      bool better = false;
      for (int shorter = 0; shorter <= kShorter && !better; ++shorter) {
        const Vec3 d = best_step(reach);
        const double predicted = predicted_worst(d) - quality_[worst_];
        if (predicted < kLeastGain) break;
        star_.evaluate(at + d);
        const float reached = star_.worst_score();
        better = reached > worst && star_.acceptable(floor_);
        if (!better) {
          reach *= 0.25;
          continue;
        }
        if (reached - worst > 0.5 * predicted) reach *= 2;
        worst = reached;
        at = at + d;
        star_.commit();
        moved = true;
      }
      if (!better) break;
    }
    return moved && worst > start;
  }

 private:
  /// Scores and their gradients at `at`.
  void linearize(Vec3 at, double step) {
    star_.evaluate(at);
    const ShapeBatch& b = star_.batch();
    size_ = b.size;
    worst_ = 0;
    for (int i = 0; i < size_; ++i) {
      quality_[i] = b.quality[i];
      if (quality_[i] < quality_[worst_]) worst_ = i;
    }
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 moved = at;
      moved[axis] += step;
      const double by = moved[axis] - at[axis];
      star_.evaluate(moved);
      for (int i = 0; i < size_; ++i) gradient_[axis][i] = by != 0 ? (b.quality[i] - quality_[i]) / by : 0;
    }
  }

  Vec3 gradient(int i) const { return {gradient_[0][i], gradient_[1][i], gradient_[2][i]}; }

  double predicted_worst(Vec3 d) const {
    double least = 1;
    for (int i = 0; i < size_; ++i) least = std::min(least, quality_[i] + dot(gradient(i), d));
    return least;
  }

  Vec3 best_step(double reach) const {
    constexpr int kDualSteps = 24;
    constexpr double kDualGap = 1e-3;
    Vec3 g = gradient(worst_);
    double q = quality_[worst_];
    for (int k = 0; k < kDualSteps; ++k) {
      int least = 0;
      double least_value = 2;
      const Vec3 d = reach * g;
      for (int i = 0; i < size_; ++i) {
        const double value = quality_[i] + (gradient_[0][i] * d.x + gradient_[1][i] * d.y + gradient_[2][i] * d.z);
        if (value < least_value) least_value = value, least = i;
      }
      const double gap = q + dot(g, d) - least_value;
      if (!(gap > kDualGap)) break;
      const Vec3 towards = gradient(least) - g;
      const double curvature = reach * squared_length(towards);
      const double s = gap < curvature ? gap / curvature : 1;
      g += s * towards;
      q += s * (quality_[least] - q);
    }
    return reach * g;
  }

  EditMesh& mesh_;
  Floor floor_;
  StarEdit star_;
  int size_ = 0, worst_ = 0;
  std::array<double, ShapeBatch::kBatch> quality_;
  std::array<std::array<double, ShapeBatch::kBatch>, 3> gradient_;
};

}  // namespace

PassResult optimize_vertices(EditMesh& mesh, float threshold, const RunContext& context) {
  PassResult result;
  VertexOptimizer optimizer(mesh, mesh.floor());
  std::vector<std::uint8_t> seen(mesh.vertices(), 0);
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (t % 4096 == 0) context.check();
    if (!mesh.alive(t) || mesh.shape(t).score >= threshold) continue;
    for (const VertexIndex v : mesh.tet(t)) {
      if (mesh.on_boundary(v) || seen[v]) continue;
      seen[v] = 1;
      ++result.tried;
      result.done += optimizer.run(v, threshold);
    }
  }
  return result;
}

}  // namespace octafront::improve
