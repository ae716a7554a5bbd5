#include "improve/shape/shape.h"

#include "base/core/vector_units.h"
#include "base/geometry/predicates.h"

#include <array>

namespace octafront::improve {
namespace {

using Objective = ImproveOptions::Objective;

constexpr double kTiny = 1e-300;  // keeps flat elements from dividing zero by zero

/// Twice the areas of the four faces of an element, with their inward normals, and what beta is made of.
struct Faces {
  Vec3 na, nb, nc, nd;
  double la, lb, lc, ld;
};

OCTAFRONT_KERNEL Faces faces_of_edges(Vec3 u, Vec3 v, Vec3 w) {
  Faces f;
  f.nb = cross(v, w), f.nc = cross(w, u), f.nd = cross(u, v);
  f.na = -(f.nb + f.nc + f.nd);  // area normals of a closed surface sum to zero
  f.la = std::sqrt(squared_length(f.na) + kTiny), f.lb = std::sqrt(squared_length(f.nb) + kTiny);
  f.lc = std::sqrt(squared_length(f.nc) + kTiny), f.ld = std::sqrt(squared_length(f.nd) + kTiny);
  return f;
}

/// Of the longest edge at a corner, half of which is the least circumradius: below by more than rounding of one that is
/// a diameter.
constexpr double kLeastDiameter = 0.9;

/// Six times the volume; the circumradius times twice that.
struct Volume {
  double det;
  double center;
};

OCTAFRONT_KERNEL Volume volume_of(const Faces& f, Vec3 u, Vec3 v, Vec3 w) {
  const double uu = squared_length(u), vv = squared_length(v), ww = squared_length(w), det = dot(f.nd, w);
  const Vec3 center = uu * f.nb + vv * f.nc + ww * f.nd;
  // Of four points on one circle the centre cancels to nothing: a flat element must not come out as a good one.
  const double least = kLeastDiameter * kLeastDiameter * det * det * greater(uu, greater(vv, ww));
  return {det, std::sqrt(greater(squared_length(center), least) + kTiny)};
}

OCTAFRONT_KERNEL double beta_of(const Faces& f, const Volume& v) {
  const double beta = 6 * v.det * std::abs(v.det) / ((f.la + f.lb + f.lc + f.ld) * v.center);
  return greater(lesser(1, beta), -1);
}

/// The mean ratio to the power 3/2: no root of third order, and a sliver is worth about what its beta is.
OCTAFRONT_KERNEL double mean_ratio_score(const Volume& volume, Vec3 u, Vec3 v, Vec3 w) {
  constexpr double kRegular = 20.784609690826528;  // 12^(3/2) / 2
  const double edges = squared_length(u) + squared_length(v) + squared_length(w) + squared_length(v - u) +
                       squared_length(w - v) + squared_length(u - w) + kTiny;
  return kRegular * volume.det / (edges * std::sqrt(edges));
}

/// Worst cosines of the angles of a triangle, from its squared edges.
struct Cosines {
  double most = -1, least = 1;

  OCTAFRONT_KERNEL void add(double a, double b, double c) {
    const double ia = 1 / std::sqrt(a + kTiny), ib = 1 / std::sqrt(b + kTiny), ic = 1 / std::sqrt(c + kTiny);
    const double at_a = 0.5 * (b + c - a) * ib * ic, at_b = 0.5 * (a + c - b) * ia * ic,
                 at_c = 0.5 * (a + b - c) * ia * ib;
    most = greater(most, greater(at_a, greater(at_b, at_c)));
    least = lesser(least, lesser(at_a, lesser(at_b, at_c)));
  }
};

/// What the element checks of structural solvers look at; see shape.h.
OCTAFRONT_KERNEL double solver_score(const Volume& volume, Vec3 u, Vec3 v, Vec3 w) {
  constexpr double kRegular = 2.5980762113533160;  // 3^(3/2) / 2
  const double uu = squared_length(u), vv = squared_length(v), ww = squared_length(w), uv = squared_length(v - u),
               vw = squared_length(w - v), wu = squared_length(u - w);
  Cosines face;
  face.add(uu, vv, uv);
  face.add(vv, ww, vw);
  face.add(ww, uu, wu);
  face.add(uv, vw, wu);
  const double longest = greater(greater(greater(uu, vv), greater(ww, uv)), greater(vw, wu)),
               shortest = lesser(lesser(lesser(uu, vv), lesser(ww, uv)), lesser(vw, wu));
  const double det = volume.det,
               in_sphere = kRegular * det * det * det * std::abs(det) / (volume.center * volume.center * volume.center);
  // sin^2(x / 2) = (1 - cos x) / 2, over sin^2 30 degrees; cos^2(x / 2) = (1 + cos x) / 2, over cos^2 30 degrees.
  const double small = std::sqrt(greater(2 * (1 - face.most), 0)),
               large = std::sqrt(greater((1 + face.least) * (2.0 / 3), 0)),
               edges = std::sqrt(std::sqrt(shortest / (longest + kTiny)));
  return lesser(lesser(in_sphere, small), lesser(large, edges));
}

template <Objective kObjective>
OCTAFRONT_KERNEL void shape_of_edges(Vec3 u, Vec3 v, Vec3 w, double& beta, double& small, double& large,
                                     double& quality) {
  const Faces f = faces_of_edges(u, v, w);
  const Volume volume = volume_of(f, u, v, w);
  beta = beta_of(f, volume);
  const double ia = 1 / f.la, ib = 1 / f.lb, ic = 1 / f.lc, id = 1 / f.ld;
  const double ab = dot(f.na, f.nb) * (ia * ib), ac = dot(f.na, f.nc) * (ia * ic), ad = dot(f.na, f.nd) * (ia * id),
               bc = dot(f.nb, f.nc) * (ib * ic), bd = dot(f.nb, f.nd) * (ib * id), cd = dot(f.nc, f.nd) * (ic * id);
  // The cosine of a dihedral angle is minus the product of the unit normals.
  // Rounding may take them below zero, and a NaN from their root would pass every comparison.
  small = greater(1 + lesser(lesser(lesser(ab, ac), lesser(ad, bc)), lesser(bd, cd)), 0);
  large = greater(1 - greater(greater(greater(ab, ac), greater(ad, bc)), greater(bd, cd)), 0);
  double positive = 0;
  if constexpr (kObjective == Objective::kBalanced)
    positive = std::sqrt(lesser(beta * beta, lesser(kSmallWeight * small, kLargeWeight * large)));
  if constexpr (kObjective == Objective::kBeta) positive = beta;
  if constexpr (kObjective == Objective::kMinDihedral) positive = std::sqrt(lesser(1, kSmallWeight * small));
  if constexpr (kObjective == Objective::kMaxDihedral) positive = std::sqrt(lesser(1, kLargeWeight * large));
  if constexpr (kObjective == Objective::kMeanRatio) positive = lesser(1, mean_ratio_score(volume, u, v, w));
  if constexpr (kObjective == Objective::kSolver) positive = lesser(1, solver_score(volume, u, v, w));
  quality = beta > 0 ? positive : lesser(beta, 0);
}

template <Objective kObjective>
OCTAFRONT_KERNEL void star_kernel(ShapeBatch& s, Vec3 apex, int n) {
  for (int i = 0; i < n; ++i) {
    const Vec3 b{s.corner[1][0][i], s.corner[1][1][i], s.corner[1][2][i]};
    const Vec3 c{s.corner[2][0][i], s.corner[2][1][i], s.corner[2][2][i]};
    const Vec3 d{s.corner[3][0][i], s.corner[3][1][i], s.corner[3][2][i]};
    shape_of_edges<kObjective>(b - apex, c - apex, d - apex, s.beta[i], s.small[i], s.large[i], s.quality[i]);
  }
}

template <Objective kObjective>
OCTAFRONT_KERNEL void element_kernel(ShapeBatch& s, int n) {
  for (int i = 0; i < n; ++i) {
    const Vec3 a{s.corner[0][0][i], s.corner[0][1][i], s.corner[0][2][i]};
    const Vec3 b{s.corner[1][0][i], s.corner[1][1][i], s.corner[1][2][i]};
    const Vec3 c{s.corner[2][0][i], s.corner[2][1][i], s.corner[2][2][i]};
    const Vec3 d{s.corner[3][0][i], s.corner[3][1][i], s.corner[3][2][i]};
    shape_of_edges<kObjective>(b - a, c - a, d - a, s.beta[i], s.small[i], s.large[i], s.quality[i]);
  }
}

/// The same as beta_of(), in single precision; lengths are about one.
struct Float3 {
  float x, y, z;
};

OCTAFRONT_KERNEL Float3 cross(Float3 a, Float3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
OCTAFRONT_KERNEL float dot(Float3 a, Float3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

constexpr float kTinyFloat = 1e-30f;

OCTAFRONT_KERNEL float lack_of_edges(Float3 u, Float3 v, Float3 w) {
  const Float3 b = cross(v, w), c = cross(w, u), d = cross(u, v), a{b.x + c.x + d.x, b.y + c.y + d.y, b.z + c.z + d.z};
  const float uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
  const Float3 center{uu * b.x + vv * c.x + ww * d.x, uu * b.y + vv * c.y + ww * d.y, uu * b.z + vv * c.z + ww * d.z};
  const float area = std::sqrt(dot(a, a) + kTinyFloat) + std::sqrt(dot(b, b) + kTinyFloat) +
                     std::sqrt(dot(c, c) + kTinyFloat) + std::sqrt(dot(d, d) + kTinyFloat);
  const float det = dot(d, w), beta = 6 * det * std::abs(det) / (area * std::sqrt(dot(center, center) + kTinyFloat));
  const float lack = 1 - (beta < -1 ? -1 : beta > 1 ? 1 : beta);
  return lack * lack;
}

}  // namespace

struct SketchKernel {
  static OCTAFRONT_KERNEL void run(StarSketch& s, Float3 apex) {
    const auto edge = [&](int k, int i) {
      return Float3{s.corner_[k][0][i] - apex.x, s.corner_[k][1][i] - apex.y, s.corner_[k][2][i] - apex.z};
    };
    for (int i = 0; i < s.size_; ++i) s.lack_[i] = lack_of_edges(edge(0, i), edge(1, i), edge(2, i));
  }
};

namespace {

struct Kernels {
  void (*star)(ShapeBatch&, Vec3, int);
  void (*elements)(ShapeBatch&, int);
};

template <Objective kObjective>
void star_plain(ShapeBatch& s, Vec3 apex, int n) {
  star_kernel<kObjective>(s, apex, n);
}
template <Objective kObjective>
void elements_plain(ShapeBatch& s, int n) {
  element_kernel<kObjective>(s, n);
}
void sketch_plain(StarSketch& s, Float3 apex) {
  SketchKernel::run(s, apex);
}

#ifdef OCTAFRONT_HAS_AVX2_KERNELS
template <Objective kObjective>
__attribute__((target("avx2"))) void star_avx2(ShapeBatch& s, Vec3 apex, int n) {
  star_kernel<kObjective>(s, apex, n);
}
template <Objective kObjective>
__attribute__((target("avx2"))) void elements_avx2(ShapeBatch& s, int n) {
  element_kernel<kObjective>(s, n);
}
__attribute__((target("avx2"))) void sketch_avx2(StarSketch& s, Float3 apex) {
  SketchKernel::run(s, apex);
}

template <Objective kObjective>
Kernels best_kernels() {
  if (has_avx2()) return {star_avx2<kObjective>, elements_avx2<kObjective>};
  return {star_plain<kObjective>, elements_plain<kObjective>};
}

const auto sketch_kernel = has_avx2() ? sketch_avx2 : sketch_plain;
#else
template <Objective kObjective>
Kernels best_kernels() {
  return {star_plain<kObjective>, elements_plain<kObjective>};
}

const auto sketch_kernel = sketch_plain;
#endif

/// In the order of the enumeration.
const Kernels kKernels[] = {best_kernels<Objective::kBalanced>(),    best_kernels<Objective::kBeta>(),
                            best_kernels<Objective::kMinDihedral>(), best_kernels<Objective::kMaxDihedral>(),
                            best_kernels<Objective::kMeanRatio>(),   best_kernels<Objective::kSolver>()};

const Kernels& kernels(Objective objective) {
  return kKernels[static_cast<int>(objective)];
}

}  // namespace

/// How many elements to evaluate: the last one again and again until vectors are full, for what is left over by them
/// costs as much one by one.
int ShapeBatch::fill_up(int first_corner) {
  constexpr int kVector = 4;
  if (size == 0) return 0;
  const int n = (size + kVector - 1) / kVector * kVector;
  for (int k = first_corner; k < 4; ++k)
    for (auto& axis : corner[k])
      for (int i = size; i < n; ++i) axis[i] = axis[size - 1];
  return n;
}

void ShapeBatch::evaluate_star(Vec3 apex) {
  kernels(objective).star(*this, apex, fill_up(1));
}

void ShapeBatch::evaluate() {
  kernels(objective).elements(*this, fill_up(0));
}

double ShapeBatch::worst() const {
  double least = 1;
  for (int i = 0; i < size; ++i) least = lesser(quality[i], least);
  return least;
}

bool ShapeBatch::star_acceptable(Vec3 apex, const Floor& floor) const {
  for (int i = 0; i < size; ++i) {
    const Shape s = shape(i);
    if (!floor.below(s)) return false;
    if (s.beta >= kCertainBeta) continue;
    const Vec3 b{corner[1][0][i], corner[1][1][i], corner[1][2][i]};
    const Vec3 c{corner[2][0][i], corner[2][1][i], corner[2][2][i]};
    const Vec3 d{corner[3][0][i], corner[3][1][i], corner[3][2][i]};
    if (orient3d(apex, b, c, d) <= 0) return false;
  }
  return true;
}

double ShapeBatch::deficit() const {
  double sum[4] = {0, 0, 0, 0};
  int i = 0;
  for (; i + 4 <= size; i += 4)
    for (int k = 0; k < 4; ++k) sum[k] += (1 - beta[i + k]) * (1 - beta[i + k]);
  for (int k = 0; i < size; ++i, ++k) sum[k] += (1 - beta[i]) * (1 - beta[i]);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

double ShapeBatch::mean_edge(Vec3 apex) const {
  double sum = 0;
  for (int i = 0; i < size; ++i) sum += distance(apex, {corner[1][0][i], corner[1][1][i], corner[1][2][i]});
  return sum / size;
}

void StarSketch::take(const ShapeBatch& star, Vec3 origin, double unit) {
  constexpr int kVector = 8;
  const double per_unit = 1 / unit;
  const std::array<double, 3> o{origin.x, origin.y, origin.z};
  size_ = (star.size + kVector - 1) / kVector * kVector;
  for (int k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* from = star.corner[k + 1][axis];
      float* to = corner_[k][axis];
      for (int i = 0; i < star.size; ++i) to[i] = static_cast<float>((from[i] - o[axis]) * per_unit);
      for (int i = star.size; i < size_; ++i) to[i] = to[star.size - 1];
    }
  used_ = star.size;
}

double StarSketch::deficit_at(Vec3 apex) {
  sketch_kernel(*this, {static_cast<float>(apex.x), static_cast<float>(apex.y), static_cast<float>(apex.z)});
  for (int i = used_; i < size_; ++i) lack_[i] = 0;
  float sum[8] = {};
  for (int i = 0; i < size_; i += 8)
    for (int k = 0; k < 8; ++k) sum[k] += lack_[i + k];
  return double{(sum[0] + sum[1]) + (sum[2] + sum[3])} + double{(sum[4] + sum[5]) + (sum[6] + sum[7])};
}

Shape shape_of(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Objective objective) {
  ShapeBatch batch(objective);
  batch.add(a, b, c, d);
  batch.evaluate();
  return batch.shape(0);
}

}  // namespace octafront::improve
