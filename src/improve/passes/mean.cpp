// Smoothing for the mean: each vertex goes to where the sum of (1 - beta)^2 around it is least. The square works on the
// poorer elements first, which raises the share of good ones more than the sum of beta itself does (measured). One
// Newton step with the diagonal of the second derivatives, from central differences of whole stars: with vector units
// an evaluation costs less than finding the star in memory.

#include "improve/passes/passes.h"
#include "improve/passes/star_edit.h"
#include "improve/passes/vertex_stars.h"

#include <algorithm>
#include <array>
#include <optional>

namespace octafront::improve {
namespace {

constexpr double kMeanDifference =
    0.04;  ///< step of the differences, in mean edge lengths: wide enough to see the bend
constexpr double kFarthestForMean = 0.2;  ///< longest step along an axis, in mean edge lengths
constexpr double kUphill = 0.1;           ///< step where the second derivative gives none, in mean edge lengths
constexpr double kShorten = 0.4;
constexpr int kTries = 2;
constexpr double kLeastSlide = 0.03;  ///< steps on the surface below this, in mean edge lengths, are not worth a search

constexpr std::array<Vec3, 3> kAxes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

class MeanSmoother {
 public:
  MeanSmoother(EditMesh& mesh, const Floor& floor, const BoundaryGuide* guide)
      : mesh_(mesh), floor_(floor), star_(mesh) {
    if (guide) sliding_.emplace(mesh, *guide);
  }

  /// True if the vertex moved.
  bool run(VertexIndex v, std::span<const HalfFace> faces) {
    float worst_beta = 1;
    for (const HalfFace h : faces) worst_beta = std::min(worst_beta, mesh_.shape(h / 4).beta);
    if (worst_beta > kGoodEnough) return false;
    const bool slides = mesh_.on_boundary(v);
    if (!star_.load(v, faces) || (slides && !sliding_->load(v, faces))) return false;
    const Vec3 at = mesh_.point(v);
    float old_worst = 1;
    double old_deficit = 0;
    for (const HalfFace h : faces) {
      const Shape& s = mesh_.shape(h / 4);
      old_worst = std::min(old_worst, s.score);
      old_deficit += (1 - double{s.beta}) * (1 - double{s.beta});
    }
    const std::span<const Vec3> axes = slides ? sliding_->axes() : kAxes;
    const double edge = star_.batch().mean_edge(at);
    sketch_.take(star_.batch(), at, edge);
    Vec3 step = edge * (slides ? newton_step(axes, old_deficit) : free_step(old_deficit));
    if (slides && squared_length(step) < kLeastSlide * kLeastSlide * edge * edge) return false;
    for (int k = 0; k < kTries; ++k, step *= kShorten) {
      Vec3 to = at + step;
      if (slides && !sliding_->snap(to)) continue;
      star_.evaluate(to);
      if (!(star_.batch().deficit() < old_deficit)) continue;
      const float worst = star_.worst_score();
      if (!(worst > old_worst || worst > kMeanRisesGuard) || !star_.acceptable(floor_)) continue;
      if (slides && !sliding_->keeps_truth(to)) continue;
      star_.commit();
      return true;
    }
    return false;
  }

 private:
  // Steps, in mean edge lengths; `here`: the sum as it is.
  Vec3 free_step(double here) {
    constexpr double h = kMeanDifference, r = 0.57735026918962576;
    constexpr std::array<Vec3, 4> kCorners{{{r, r, r}, {r, -r, -r}, {-r, r, -r}, {-r, -r, r}}};
    Vec3 sum;
    double mean = 0;
    for (const Vec3 d : kCorners) {
      const double f = sketch_.deficit_at(h * d);
      sum += (f - here) * d;
      mean += 0.25 * (f - here);
    }
    const Vec3 slope = (0.75 / h) * sum;
    const double bend = 2 * mean / (h * h), steep = length(slope);
    if (!(steep > 0)) return {};
    const double far = bend > 0 ? std::min(steep / bend, kFarthestForMean) : kUphill;
    return (-far / steep) * slope;
  }

  Vec3 newton_step(std::span<const Vec3> axes, double here) {
    constexpr double h = kMeanDifference;
    Vec3 step;
    for (const Vec3 axis : axes) {
      const double ahead = sketch_.deficit_at(h * axis), behind = sketch_.deficit_at(-h * axis);
      const double slope = (ahead - behind) / (2 * h), bend = (ahead + behind - 2 * here) / (h * h);
      const double wanted = bend > 0 ? -slope / bend : slope > 0 ? -kUphill : kUphill;
      step += std::clamp(wanted, -kFarthestForMean, kFarthestForMean) * axis;
    }
    return step;
  }

  EditMesh& mesh_;
  Floor floor_;
  StarEdit star_;
  StarSketch sketch_;
  std::optional<SlidingVertex> sliding_;
};

}  // namespace

PassResult smooth_mean(EditMesh& mesh, int sweeps, const RunContext& context, const BoundaryGuide* guide) {
  PassResult result;
  const VertexStars stars(mesh, guide, [](const Shape& s) { return s.beta <= kGoodEnough; });
  MeanSmoother smoother(mesh, mesh.floor(), guide);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    result += stars.run(context, [&](VertexIndex v, std::span<const HalfFace> star) {
      return PassResult{1, smoother.run(v, star)};
    });
  return result;
}

}  // namespace octafront::improve
