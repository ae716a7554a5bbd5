#pragma once

// How good a tetrahedron is, for the improvement passes: three measures at once, many elements at a time.

#include <octafront/vec.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace octafront::improve {

/// The measures that no pass may lower at the worst element of the mesh. All rise as the element gets better.
struct Shape {
  float beta;   ///< 3 r / R, as radius_ratio() of quality.h; <= 0 if flat or inverted
  float small;  ///< 1 - cos(smallest dihedral angle), in [0, 2/3]
  float large;  ///< 1 + cos(largest dihedral angle), in [0, 4/3]
};

/// Angles that count as bad as beta = kReferenceBeta. An element of beta .45 has typically such angles.
inline constexpr double kReferenceBeta = 0.45, kReferenceSmallAngle = 23, kReferenceLargeAngle = 141;  // degrees

namespace detail {
// kReferenceBeta^2 / (1 - cos 23 deg) and kReferenceBeta^2 / (1 + cos 141 deg).
inline constexpr float kSmallWeight = 2.5473f, kLargeWeight = 0.90867f;
}  // namespace detail

/// One number for all three: beta, or what the angles are worth, whichever is less. In (0, 1] for valid elements; not
/// positive for others.
inline float score(const Shape& s) {
  if (!(s.beta > 0)) return std::min(s.beta, 0.0f);
  return std::sqrt(std::min({s.beta * s.beta, detail::kSmallWeight * s.small, detail::kLargeWeight * s.large}));
}

/// At this computed beta or above an element is certainly positive: V >= 4/3 pi r^3 with r >= beta R / 3 makes the
/// determinant at least 7e-10 R^3, and its rounding error is below 4e-14 R^3 (see orient3d). Below it, exact signs
/// decide.
inline constexpr float kCertainBeta = 1e-3f;

/// Lower bounds of the three measures, each by itself.
struct Floor {
  float beta = 2, small = 2, large = 2;

  void add(const Shape& s) {
    beta = std::min(beta, s.beta);
    small = std::min(small, s.small);
    large = std::min(large, s.large);
  }
  /// Strictly above in all three: rounding to float is monotone, so the exact values are above too.
  bool below(const Shape& s) const { return s.beta > beta && s.small > small && s.large > large; }
  /// The worst possible score of an element that meets these bounds.
  float worst_score() const { return score({beta, small, large}); }
};

/// Shapes of up to kBatch elements at once, in structure-of-arrays form for the vector units.
/// Corner 0 of all elements may be one point (a star about it) or its own for each.
struct ShapeBatch {
  static constexpr int kBatch = 256;

  int size = 0;
  alignas(64) double corner[4][3][kBatch];  ///< [corner][axis][element]
  alignas(64) double beta[kBatch], small[kBatch], large[kBatch];
  alignas(64) double quality[kBatch];  ///< score() in double precision, for derivatives

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
    return {static_cast<float>(beta[i]), static_cast<float>(small[i]), static_cast<float>(large[i])};
  }
  Floor floor() const;

 private:
  void set(int k, Vec3 p) {
    corner[k][0][size] = p.x;
    corner[k][1][size] = p.y;
    corner[k][2][size] = p.z;
  }
};

/// One element by itself; the same values as a batch gives, bit for bit.
Shape shape_of(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

}  // namespace octafront::improve
