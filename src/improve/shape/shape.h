#pragma once

// improve/shape: what an element is worth (shape.h), the mesh that is edited (edit_mesh.h), and searches for the best
// place of a vertex (maximize_worst.h) and the best filling of a polyhedron (polyhedron_search.h).

// How good a tetrahedron is, for the improvement passes: three measures at once, many elements at a time.

#include <octafront/options.h>
#include <octafront/vec.h>

#include <algorithm>

namespace octafront::improve {

/// What an element is worth. The first three are the measures that no pass may lower at the worst element of the mesh;
/// all rise as the element gets better.
struct Shape {
  float beta;   ///< 3 r / R, as radius_ratio() of quality.h; <= 0 if flat or inverted
  float small;  ///< 1 - cos(smallest dihedral angle), in [0, 2/3]
  float large;  ///< 1 + cos(largest dihedral angle), in [0, 4/3]
  float score;  ///< what the objective says, in (0, 1] for positive elements, not positive for others; see below

  friend bool operator==(const Shape&, const Shape&) = default;
};

/// Angles that are worth as much as beta = kReferenceBeta are 23 degrees for the smallest and 141 degrees for the
/// largest: the typical angles of an element of that beta. kSmallWeight and kLargeWeight are a^2 / 2 and b^2 / 2 below.
/// Scores by objective:
///   kBalanced     min(beta, a sin(smallest / 2), b cos(largest / 2))
///   kBeta         beta
///   kMinDihedral  a sin(smallest / 2), at most 1
///   kMaxDihedral  b cos(largest / 2), at most 1
///   kMeanRatio    the mean ratio 12 (3 V)^(2/3) / (sum of squared edges) to the power 3/2
///   kSolver       the least of: volume over that of the regular tetrahedron in the same sphere; the smallest face
///   angle,
///                 sin(angle / 2) / sin 30; the largest one, cos(angle / 2) / cos 30; sqrt(shortest / longest edge)
inline constexpr double kReferenceBeta = 0.45;
inline constexpr double kSmallWeight = kReferenceBeta * kReferenceBeta / (1 - 0.92050485345244037);  // cos 23 deg
inline constexpr double kLargeWeight = kReferenceBeta * kReferenceBeta / (1 - 0.77714596145697090);  // -cos 141 deg

/// Of a slot without an element: better than any, so that sweeps over all shapes need not ask.
inline constexpr Shape kNoShape{2, 2, 2, 2};

/// At this computed beta or above an element is certainly positive: V >= 4/3 pi r^3 with r >= beta R / 3 makes the
/// determinant at least 7e-10 R^3, and its rounding error is below 4e-14 R^3 (see orient3d). Below it, exact signs
/// decide.
inline constexpr float kCertainBeta = 1e-3f;

/// Lower bounds of the three measures, each by itself.
struct Floor {
  float beta = 2, small = 2, large = 2, score = 2;

  void add(const Shape& s) {
    beta = std::min(beta, s.beta);
    small = std::min(small, s.small);
    large = std::min(large, s.large);
    score = std::min(score, s.score);
  }
  /// The worst of both.
  Floor& operator+=(const Floor& other) {
    beta = std::min(beta, other.beta);
    small = std::min(small, other.small);
    large = std::min(large, other.large);
    score = std::min(score, other.score);
    return *this;
  }
  /// Strictly above in the three measures: rounding to float is monotone, so the exact values are above too.
  bool below(const Shape& s) const { return s.beta > beta && s.small > small && s.large > large; }
};

/// Shapes of up to kBatch elements at once, in structure-of-arrays form for the vector units.
/// Corner 0 of all elements may be one point (a star about it) or its own for each.
struct ShapeBatch {
  static constexpr int kBatch = 256;
  /// Rows a power of two apart would all lie in the same few sets of the cache.
  static constexpr int kRow = kBatch + 8;
  using Objective = ImproveOptions::Objective;

  explicit ShapeBatch(Objective o = Objective::kBalanced) : objective(o) {}

  Objective objective;
  int size = 0;
  alignas(64) double corner[4][3][kRow];  ///< [corner][axis][element]
  alignas(64) double beta[kRow], small[kRow], large[kRow];
  alignas(64) double quality[kRow];  ///< the score, in double precision for derivatives

  bool full() const { return size == kBatch; }
  /// Adds an element that shares corner 0 with the others.
  void add(Vec3 b, Vec3 c, Vec3 d) {
    set(1, b), set(2, c), set(3, d);
    ++size;
  }
  void add(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    set(0, a);
    add(b, c, d);
  }
  /// Evaluates with corner 0 of every element at `apex`.
  void evaluate_star(Vec3 apex);
  /// Evaluates elements added with four corners.
  void evaluate();

  Shape shape(int i) const {
    return {static_cast<float>(beta[i]), static_cast<float>(small[i]), static_cast<float>(large[i]),
            static_cast<float>(quality[i])};
  }
  /// The least score, 1 if empty.
  double worst() const;
  /// True if all elements, as evaluated with corner 0 at `apex`, are strictly above the floor, and positive by exact
  /// signs where that is not certain.
  bool star_acceptable(Vec3 apex, const Floor& floor) const;
  /// Sum of (1 - beta)^2, in a fixed order.
  double deficit() const;
  /// Mean distance of `apex` from the corners of the opposite faces.
  double mean_edge(Vec3 apex) const;

 private:
  void set(int k, Vec3 p) {
    corner[k][0][size] = p.x;
    corner[k][1][size] = p.y;
    corner[k][2][size] = p.z;
  }
  int fill_up(int first_corner);
};

/// A star in single precision, about a place and in units of a length: what differences of beta are computed from.
/// Costs a quarter of what the same takes with a ShapeBatch, and is wrong by some 1e-6.
class StarSketch {
 public:
  /// The corners of the opposite faces, as seen from `origin`. `unit`: about the length of the star's edges.
  void take(const ShapeBatch& star, Vec3 origin, double unit);
  /// Sum of (1 - beta)^2 with corner 0 of every element at `apex`, in the units and about the origin of take().
  double deficit_at(Vec3 apex);

 private:
  friend struct SketchKernel;
  static constexpr int kRow = ShapeBatch::kBatch + 16;
  int used_ = 0, size_ = 0;               ///< elements, and with those that fill the last vector up
  alignas(64) float corner_[3][3][kRow];  ///< [corner - 1][axis][element]
  alignas(64) float lack_[kRow];          ///< (1 - beta)^2
};

/// One element by itself; the same values as a batch gives, bit for bit.
Shape shape_of(Vec3 a, Vec3 b, Vec3 c, Vec3 d,
               ImproveOptions::Objective objective = ImproveOptions::Objective::kBalanced);

}  // namespace octafront::improve
