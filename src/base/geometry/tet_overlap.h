#pragma once

#include <octafront/vec.h>

#include <array>
#include <cstddef>

namespace octafront {

using TetCorners = std::array<Vec3, 4>;

inline Vec3 middle_of(const TetCorners& x) {
  return 0.25 * (x[0] + x[1] + x[2] + x[3]);
}

/// A positive tetrahedron (tet_mesh.h) with the planes of its faces.
class TetPlanes {
 public:
  explicit TetPlanes(const TetCorners& corners);

  const TetCorners& corners() const { return corners_; }
  double volume() const { return volume_; }
  Vec3 centre() const { return middle_of(corners_); }

  /// How far p lies outside face i, times twice the area of the face; negative inside. The sign is exact, 0 on the
  /// plane.
  double height(std::size_t face, Vec3 p) const;
  /// Whether p lies in it or on its boundary, exactly.
  bool holds(Vec3 p) const;

 private:
  double doubtful_height(std::size_t face, Vec3 p, double height) const;

  TetCorners corners_;
  std::array<Vec3, 4> at_, normal_, permanent_;  ///< of the faces
  double volume_;
};

/// The tetrahedron that two share nothing but a boundary with has the share 0.
struct TetOverlap {
  double share = 0;  ///< of the volume of the first, in [0, 1]
  Vec3 moment;       ///< the integral of x over what is shared, over that volume, x from the first corner of the first
};

/// What two positive tetrahedra share: the first is cut by each plane of the second that divides it, into tetrahedra
/// whose shares are products of ratios in [0, 1]. So shares are never negative, those of pieces that fill a tetrahedron
/// add up to 1 up to rounding, however flat it is, and who lies on the other side of a plane by exact sign shares
/// nothing.
double shared_volume(const TetPlanes& a, const TetCorners& b);
/// The same with the first moments, at some more cost.
TetOverlap shared_moments(const TetPlanes& a, const TetCorners& b);

}  // namespace octafront
