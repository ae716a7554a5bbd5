#pragma once

// The star of a vertex in metrics of size, in which the shape of an element alone counts: what its elements are worth
// with the vertex elsewhere, and which way it is better, by vector units. The same bits as one by one.

#include <octafront/vec.h>

#include "adapt/passes/slope.h"

#include <array>

namespace octafront::adapt {

class SizeStar {
 public:
  /// Larger stars are rare: they are for others.
  static constexpr std::size_t kMost = 120;

  void clear() { size_ = 0; }
  /// An element by its corners, in its order, of which `at` is the vertex. Requires room.
  void add(const std::array<Vec3, 4>& corners, int at);
  /// With the vertex at this place.
  void evaluate(Vec3 at);
  /// The score of the k-th element as evaluated: see score_of_corners().
  float score(std::size_t k) const;
  /// The sum of slope_of() for the vertex at this place.
  Slope slope_at(Vec3 at, double wanted, double pull);

 private:
  friend struct SizeStarKernels;
  static constexpr std::size_t kVector = 4, kRow = 128, kSums = 9;

  Vec3 corner(int i, std::size_t k) const { return {corner_[i][0][k], corner_[i][1][k], corner_[i][2][k]}; }
  std::size_t fill_up();

  std::size_t size_ = 0;
  std::array<int, kRow> at_;
  alignas(64) double corner_[4][3][kRow];  ///< [corner][axis][element]
  alignas(64) double face_[3][3][kRow];    ///< of the face opposite the vertex, counter-clockwise seen from outside
  alignas(64) double worth_[kRow];
  alignas(64) double slope_[kSums][kRow];  ///< the gradient, the entries of the Hessian
};

}  // namespace octafront::adapt
