#include "improve/passes/fewest_poor.h"

#include "improve/passes/passes.h"
#include "improve/passes/star_edit.h"
#include "improve/passes/vertex_stars.h"

#include <algorithm>

namespace octafront::improve {
namespace {

constexpr double kPoorDifference = 1e-6;  ///< step of the differences, in edge lengths
constexpr double kFirstDamping = 0.01;    ///< of the mean second derivative
constexpr double kFarthestForPoor = 0.5;  ///< longest step, in mean edge lengths

constexpr int kStepsForPoor = 8;  ///< per vertex at most

class Reliever {
 public:
  Reliever(EditMesh& mesh, const Floor& floor) : mesh_(mesh), floor_(floor), star_(mesh) {}

  /// True if the vertex moved.
  bool run(VertexIndex v, std::span<const HalfFace> faces) {
    if (!star_.load(v, faces)) return false;
    descent_.descend(star_.batch(), mesh_.point(v), kStepsForPoor,
                     [&](Vec3 at) { return star_.acceptable(at, floor_); });
    if (!descent_.moved()) return false;
    star_.evaluate(descent_.place());
    star_.commit();
    return true;
  }

 private:
  EditMesh& mesh_;
  Floor floor_;
  StarEdit star_;
  LackDescent descent_;
};

}  // namespace

void LackDescent::begin(ShapeBatch& batch, Vec3 start) {
  at_ = start;
  moved_ = false;
  damping_ = kFirstDamping;
  const double edge = batch.mean_edge(start);
  difference_ = kPoorDifference * edge;
  farthest_ = kFarthestForPoor * edge;
  batch.evaluate_star(start);
  lack_ = lack_of(batch);
}

void LackDescent::linearize(ShapeBatch& batch) {
  batch.evaluate_star(at_);
  for (int i = 0; i < batch.size; ++i) residual_[i] = root_of_lack(batch.quality[i]);
  const Vec3 axes[3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 3; ++k) {
    const Vec3 beside = at_ + difference_ * axes[k];
    const double by = dot(beside - at_, axes[k]);
    batch.evaluate_star(beside);
    for (int i = 0; i < batch.size; ++i)
      gradient_[k][i] = by != 0 ? (root_of_lack(batch.quality[i]) - residual_[i]) / by : 0;
  }
  double slope[3] = {0, 0, 0};
  for (auto& row : bend_) std::fill_n(row, 3, 0.0);
  for (int i = 0; i < batch.size; ++i) {
    if (residual_[i] <= 0) continue;
    for (int k = 0; k < 3; ++k) {
      slope[k] -= residual_[i] * gradient_[k][i];
      for (int l = 0; l < 3; ++l) bend_[k][l] += gradient_[k][i] * gradient_[l][i];
    }
  }
  slope_ = {slope[0], slope[1], slope[2]};
}

// (bend + damping) step = slope, by the inverse of a symmetric positive matrix.
Vec3 LackDescent::damped_step() const {
  const double extra = damping_ * (bend_[0][0] + bend_[1][1] + bend_[2][2]) / 3;
  if (!(extra > 0)) return {};
  const Vec3 x{bend_[0][0] + extra, bend_[0][1], bend_[0][2]}, y{bend_[1][0], bend_[1][1] + extra, bend_[1][2]},
      z{bend_[2][0], bend_[2][1], bend_[2][2] + extra};
  const double determinant = dot(x, cross(y, z));
  if (!(determinant > 0)) return {};
  const Vec3 step = (slope_.x * cross(y, z) + slope_.y * cross(z, x) + slope_.z * cross(x, y)) / determinant;
  const double far = length(step);
  return far > farthest_ ? step * (farthest_ / far) : step;
}

PassResult relieve_vertices(EditMesh& mesh, float threshold, const RunContext& context) {
  const VertexStars stars(mesh, nullptr, [&](const Shape& s) { return s.score < threshold; });
  Reliever reliever(mesh, mesh.floor());
  return stars.run(context, [&](VertexIndex v, std::span<const HalfFace> star) {
    const auto is_poor = [&](HalfFace h) { return mesh.shape(h / 4).score < threshold; };
    if (!std::ranges::any_of(star, is_poor)) return PassResult{};
    return PassResult{1, reliever.run(v, star)};
  });
}

}  // namespace octafront::improve
