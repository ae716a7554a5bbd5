#pragma once

// Rigid maps that lead from one face of a body to the one that is its copy: translations, rotations about an axis.

#include <octafront/vec.h>

#include <array>
#include <string>

namespace octafront {

/// x' = R x + t. Both ways are computed in one fixed order, so that they give the same bits everywhere.
class PeriodicMap {
 public:
  /// By `shift`, which must be finite and not 0.
  static PeriodicMap translation(Vec3 shift);
  /// By an angle in degrees about the axis through a point along a direction, which must not be 0. Multiples of 90
  /// degrees about axes of space are exact.
  static PeriodicMap rotation(double degrees, Vec3 point, Vec3 direction);

  bool turns() const { return turns_; }
  /// Row by row; that of a translation is 1 0 0, 0 1 0, 0 0 1.
  const std::array<Vec3, 3>& matrix() const { return rows_; }
  Vec3 shift() const { return shift_; }

  /// What lies on the axis stays, bit for bit.
  Vec3 apply(Vec3 p) const;
  /// The inverse up to rounding.
  Vec3 undo(Vec3 p) const;
  /// Of directions.
  Vec3 turn(Vec3 v) const { return {dot(rows_[0], v), dot(rows_[1], v), dot(rows_[2], v)}; }
  Vec3 turn_back(Vec3 v) const { return rows_[0] * v.x + rows_[1] * v.y + rows_[2] * v.z; }

  /// Moves a point that lies this near to the axis of a rotation onto it.
  Vec3 onto_axis(Vec3 p, double tolerance) const;

  /// "by (1, 0, 0)", "by 30 degrees about the axis through (0, 0, 0) along (0, 0, 1)".
  std::string in_words() const;

 private:
  bool is_on_axis(Vec3 p) const;

  bool turns_ = false;
  std::array<Vec3, 3> rows_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 shift_;
  double degrees_ = 0;
  Vec3 point_, direction_;
};

}  // namespace octafront
