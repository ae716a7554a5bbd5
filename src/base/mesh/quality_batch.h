#pragma once

#include <octafront/vec.h>

#include <cstdint>

namespace octafront {

/// Beta and dihedral angles of many tetrahedra at once, in structure-of-arrays form for the vector units; every width
/// of them gives the same bits.
struct QualityBatch {
  static constexpr int kSize = 64;
  /// Angles from 0 to 180 degrees lie in steps 0 to kSteps; a larger angle is in no lower step, but for rounding, which
  /// may put it one step too far.
  static constexpr int kSteps = 256;

  alignas(64) double corner[4][3][kSize] = {};  ///< [corner][axis][element]
  alignas(64) double beta[kSize];               ///< 3 r / R, but for rounding, which may leave -1 to 1
  /// Of the edges of kTetEdges: the angle as the direction (x, y) of any length, and its step.
  alignas(64) double x[6][kSize], y[6][kSize];
  alignas(64) std::int32_t step[6][kSize];

  void set(int element, int k, Vec3 p) {
    corner[k][0][element] = p.x;
    corner[k][1][element] = p.y;
    corner[k][2][element] = p.z;
  }
  /// All kSize elements.
  void evaluate();
};

}  // namespace octafront
